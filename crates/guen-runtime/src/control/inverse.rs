//! Inverse dynamics: the inputs that produce given accelerations, where they exist.

use core::error::Error;
use core::fmt;

use super::dense::{Basis, apply, dot, largest, length, transpose};
use crate::real::Ordered;

/// The equations of motion as controllers use them:
///
/// ```text
/// M eta' + bias = G u
/// ```
///
/// exact at the inputs that it was computed at; everywhere, where forces are affine in the inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassForm<R, const L: usize, const M: usize> {
    /// The mass matrix, symmetric, `L` by `L`.
    pub mass: [[R; L]; L],
    /// What the forces are without inputs, with its sign turned.
    pub bias: [R; L],
    /// `G`, the derivatives of the generalised forces by the inputs, `L` by `M`.
    pub input: [[R; M]; L],
}

/// Why there are no inputs that produce the accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InverseDynamicsError {
    /// The accelerations are outside of what the inputs reach.
    OutOfReach {
        /// The largest generalised force that is missing.
        missing: f64,
        /// The rank of `G`: how many generalised forces the inputs set independently.
        rank: usize,
    },
    /// A force is infinite or NaN.
    NotFinite,
}

impl fmt::Display for InverseDynamicsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfReach { missing, rank } => write!(
                f,
                "no inputs produce these accelerations: a generalised force of {missing:e} is missing, and the inputs \
                 set {rank} of them"
            ),
            Self::NotFinite => f.write_str("a force or an acceleration is not finite"),
        }
    }
}

impl Error for InverseDynamicsError {}

/// The inputs that produce given accelerations.
///
/// ```text
/// G u = M eta' + bias        u = R^T (R R^T)^-1 Q^T (M eta' + bias),   G = Q R
/// ```
///
/// - `form` gives the equations at trial inputs. Where they are affine in the inputs the second evaluation confirms
///   what the first one found; else it is Newton's method, from zero.
/// - Where the inputs are more than the forces they make, the solution of least length is taken.
/// - A column of `G` counts if more than `1e-10` of the longest one is left of it beside the others.
///
/// ```
/// use guen_runtime::control::{MassForm, inverse_dynamics};
/// // Two motors on one axis share the work.
/// let form = MassForm { mass: [[2.0]], bias: [1.0], input: [[1.0, 1.0]] };
/// let inputs = inverse_dynamics(|_| form, &[3.0]).unwrap();
/// assert!(inputs.iter().all(|u| (u - 3.5_f64).abs() < 1e-14));
/// // A cart cannot accelerate sideways.
/// let form = MassForm { mass: [[1.0, 0.0], [0.0, 1.0]], bias: [0.0; 2], input: [[1.0], [0.0]] };
/// assert!(inverse_dynamics(|_| form, &[1.0, 0.0]).is_ok());
/// assert!(inverse_dynamics(|_| form, &[0.0, 1.0]).is_err());
/// ```
///
/// # Errors
///
/// [`InverseDynamicsError`].
pub fn inverse_dynamics<R: Ordered, const L: usize, const M: usize>(
    form: impl Fn(&[R; M]) -> MassForm<R, L, M>,
    accelerations: &[R; L],
) -> Result<[R; M], InverseDynamicsError> {
    /// Newton's method doubles the digits; forces that it does not solve in so many steps are beyond it.
    const STEPS: usize = 30;
    const INDEPENDENT: f64 = 1e-10;
    /// Roundings that the generalised forces may be off by.
    const ROUNDINGS: f64 = 1e3;

    let mut inputs = [R::zero(); M];
    let (mut missing, mut rank) = (f64::INFINITY, 0);
    for _ in 0..STEPS {
        let MassForm { mass, bias, input } = form(&inputs);
        let inertia = apply(&mass, accelerations);
        let made = apply(&input, &inputs);
        let gap: [R; L] = core::array::from_fn(|s| inertia[s] + bias[s] - made[s]);
        let scale = largest(inertia.iter().chain(&bias).chain(&made).copied());
        let size = largest(gap.iter().copied());
        if !(size.is_finite() && scale.is_finite()) {
            return Err(InverseDynamicsError::NotFinite);
        }
        if size <= ROUNDINGS * R::epsilon().to_f64() * scale {
            return Ok(inputs);
        }
        missing = size;
        let columns = transpose(&input);
        let least = INDEPENDENT * largest(columns.iter().map(length));
        let mut basis = Basis::<R, L>::new();
        basis.add_all(M, |j| columns.get(j).copied(), least);
        rank = basis.count;
        // R_kj = q_k . column j, and S = R R^T with ones behind its rank.
        let r: [[R; M]; L] =
            core::array::from_fn(|k| core::array::from_fn(|j| dot(&basis.vectors[k], &columns[j])));
        let s: [[R; L]; L] = core::array::from_fn(|i| {
            core::array::from_fn(|k| match (i < rank && k < rank, i == k) {
                (true, _) => dot(&r[i], &r[k]),
                (false, true) => R::one(),
                (false, false) => R::zero(),
            })
        });
        let right: [[R; 1]; L] =
            core::array::from_fn(|k| [if k < rank { dot(&basis.vectors[k], &gap) } else { R::zero() }]);
        let Some(y) = super::dense::solve(&s, &right) else { break };
        let mut moved = 0.0_f64;
        for j in 0..M {
            let change = (0..rank).fold(R::zero(), |sum, k| sum + r[k][j] * y[k][0]);
            inputs[j] += change;
            moved = moved.max(change.to_f64().abs());
        }
        if moved <= ROUNDINGS * R::epsilon().to_f64() * largest(inputs.iter().copied()) {
            break;
        }
    }
    Err(InverseDynamicsError::OutOfReach { missing, rank })
}
