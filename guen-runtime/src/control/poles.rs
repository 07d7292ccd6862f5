//! The poles of linear models: where they are, and the feedback of one input that puts them elsewhere.

use core::cmp::Ordering;
use core::error::Error;
use core::fmt;

use super::controllability::{Uncontrollable, controllability};
use crate::linear_algebra::dense::{Basis, apply, dot, length};
use crate::linear_algebra::eigenvalues;
use crate::numbers::real::Ordered;
use crate::system::derivatives::linearization::Linearization;

/// A pole: an eigenvalue `re + i im` of the matrix of a linear model.
///
/// A continuous model is stable if every `re` is negative, a discrete one if every [`magnitude`](Pole::magnitude) is below one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole<R> {
    /// The real part: the growth rate of a continuous model.
    pub re: R,
    /// The imaginary part: the angular frequency of a continuous model.
    pub im: R,
}

impl<R: Ordered> Pole<R> {
    /// A real pole.
    ///
    /// ```
    /// assert_eq!(guen_runtime::control::Pole::real(-2.0).im, 0.0);
    /// ```
    pub fn real(re: R) -> Self {
        Pole { re, im: R::zero() }
    }

    /// The pair of poles of an oscillation with an angular frequency and a damping ratio below one:
    /// `z^2 + 2 damping frequency z + frequency^2 = 0`.
    ///
    /// ```
    /// let [above, below] = guen_runtime::control::Pole::oscillation(5.0, 0.6);
    /// assert_eq!((above.re, above.im, below.im), (-3.0, 4.0, -4.0));
    /// ```
    pub fn oscillation(frequency: R, damping: R) -> [Self; 2] {
        let (re, im) = (-damping * frequency, frequency * (R::one() - damping * damping).sqrt());
        [Pole { re, im }, Pole { re, im: -im }]
    }

    /// The absolute value: what a discrete model multiplies the mode by in one period.
    ///
    /// ```
    /// assert_eq!(guen_runtime::control::Pole { re: 3.0, im: -4.0 }.magnitude(), 5.0);
    /// ```
    pub fn magnitude(&self) -> R {
        length(&[self.re, self.im])
    }
}

/// The poles of `x' = A x` or `x_(k+1) = A x_k`: the eigenvalues of `A`, those with the largest real part first, conjugate pairs beside
/// each other.
///
/// By the QR algorithm on the balanced matrix, about `10 N^3` operations, no allocation. Each is right to a few roundings of the norm
/// times its own condition: a pole that is there `m` times comes as `m` of them some `epsilon^(1/m)` apart. `None` if an entry is
/// infinite or NaN, if a pole is beyond the largest number, or if the algorithm does not converge, which nobody has seen.
///
/// ```
/// use guen_runtime::control::{Pole, poles};
/// // A pendulum upright, and hanging with friction.
/// assert_eq!(poles(&[[0.0, 1.0], [4.0, 0.0]]), Some([Pole::real(2.0), Pole::real(-2.0)]));
/// assert_eq!(poles(&[[0.0, 1.0], [-25.0, -6.0]]), Some(Pole::oscillation(5.0, 0.6)));
/// ```
pub fn poles<R: Ordered, const N: usize>(a: &[[R; N]; N]) -> Option<[Pole<R>; N]> {
    let mut poles = eigenvalues(a)?.map(|[re, im]| Pole { re, im });
    let before = |a: &Pole<R>, b: &Pole<R>| {
        let size = a.im.abs().partial_cmp(&b.im.abs());
        let size = size.map(|order| order.then(b.im.partial_cmp(&a.im).unwrap_or(Ordering::Equal)));
        b.re.partial_cmp(&a.re).unwrap_or(Ordering::Equal).then(size.unwrap_or(Ordering::Equal))
    };
    poles.sort_unstable_by(before);
    Some(poles)
}

/// The reason why [`place`] finds no feedback.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PlaceError {
    /// A complex pole without its conjugate: the feedback would be complex.
    Unpaired {
        /// The place in the list.
        pole: usize,
    },
    /// The input does not reach every mode.
    Uncontrollable(Uncontrollable),
    /// An entry of the model, or a pole, is infinite or NaN.
    NotFinite,
}

impl fmt::Display for PlaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unpaired { pole } => {
                write!(f, "pole {pole} is complex, and its conjugate is not in the list")
            }
            Self::Uncontrollable(error) => error.fmt(f),
            Self::NotFinite => f.write_str("an entry of the linear model or a pole is not finite"),
        }
    }
}

impl Error for PlaceError {}

/// The feedback `u = -K x` of a single input that gives `A - B K` these poles; of a continuous or a discrete model.
///
/// ```text
/// K = e_N^T [B, A B, .. A^(N-1) B]^-1 (A - p_1) (A - p_2) .. (A - p_N)
/// ```
///
/// Ackermann's formula, in an orthonormal basis of the spaces that `B, A B, ..` span: `A` is a Hessenberg matrix there, and the
/// inverse one product of its subdiagonal (Datta 1987). Complex poles come in conjugate pairs, in any order; a pole may be there
/// several times. About `2 N^3` operations, no allocation. The condition of the problem grows fast with `N`: beyond some ten states, or
/// with several inputs, take [`lqr`](super::lqr).
///
/// ```
/// use guen_runtime::Linearization;
/// use guen_runtime::control::{Pole, place};
/// // A mass under a force, with a frequency of 5 and a damping ratio of 0.6: stiffness 25, damper 6.
/// let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0]] };
/// assert_eq!(place(&mass, &Pole::oscillation(5.0, 0.6))?, [25.0, 6.0]);
/// # Ok::<(), guen_runtime::control::PlaceError>(())
/// ```
///
/// # Errors
///
/// [`PlaceError`].
pub fn place<R: Ordered, const N: usize>(
    linear: &Linearization<R, N, 1>,
    poles: &[Pole<R>; N],
) -> Result<[R; N], PlaceError> {
    let Linearization { a, b } = linear;
    let column: [R; N] = core::array::from_fn(|i| b[i][0]);
    let given = a.iter().flatten().chain(&column).copied().chain(poles.iter().flat_map(|p| [p.re, p.im]));
    if !given.into_iter().all(|x| x.is_finite()) {
        return Err(PlaceError::NotFinite);
    }
    // Without its units: they would decide what is out of reach.
    let mut balanced = *a;
    let units = eigenvalues::balance(&mut balanced);
    let column: [R; N] = core::array::from_fn(|i| column[i] / units[i]);
    let a = &balanced;
    let tolerance = R::epsilon().to_f64() * N as f64;
    let model = Linearization { a: balanced, b: column.map(|x| [x]) };
    controllability(&model, tolerance).require().map_err(PlaceError::Uncontrollable)?;
    // The same basis as that of `controllability`, all of whose directions are new.
    let mut basis = Basis::new();
    let mut below = [length(&column); N];
    basis.add(&column, 0.0);
    for (k, size) in below.iter_mut().enumerate().skip(1) {
        let image = apply(a, &basis.vectors[k - 1]);
        *size = length(&basis.remainder(&image));
        basis.add(&image, 0.0);
    }
    let images = basis.vectors.map(|q| apply(a, &q));
    let hessenberg: [[R; N]; N] =
        core::array::from_fn(|i| core::array::from_fn(|j| dot(&basis.vectors[i], &images[j])));
    // e_N^T times a factor for each pole, or for each pair, over the subdiagonal.
    let mut row = [R::zero(); N];
    row.last_mut().into_iter().for_each(|last| *last = R::one());
    let through = |row: &[R; N]| -> [R; N] {
        core::array::from_fn(|j| (0..N).fold(R::zero(), |sum, i| sum + row[i] * hessenberg[i][j]))
    };
    let mut used = [false; N];
    let mut divisors = below.iter();
    let mut divided = |row: [R; N]| match divisors.next() {
        Some(size) => row.map(|x| x / *size),
        None => row,
    };
    for i in 0..N {
        if used[i] {
            continue;
        }
        used[i] = true;
        let Pole { re, im } = poles[i];
        let once = through(&row);
        if im == R::zero() {
            row = divided(core::array::from_fn(|j| once[j] - re * row[j]));
            continue;
        }
        let conjugate = (i + 1..N).find(|j| !used[*j] && poles[*j] == Pole { re, im: -im });
        used[conjugate.ok_or(PlaceError::Unpaired { pole: i })?] = true;
        let twice = through(&once);
        row = core::array::from_fn(|j| twice[j] - (re + re) * once[j] + (re * re + im * im) * row[j]);
        row = divided(row);
        row = divided(row);
    }
    let gain: [R; N] = core::array::from_fn(|j| {
        (0..N).fold(R::zero(), |sum, k| sum + row[k] * basis.vectors[k][j]) / units[j]
    });
    if gain.iter().all(|x| x.is_finite()) { Ok(gain) } else { Err(PlaceError::NotFinite) }
}
