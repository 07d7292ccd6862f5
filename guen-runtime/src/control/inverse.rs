//! Inverse dynamics: the inputs that produce given accelerations, where they exist.

use core::error::Error;
use core::fmt;

use crate::linear_algebra::dense::{Basis, apply, dot, largest, length, transpose};
use crate::numbers::real::{Ordered, Real};

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
    /// The generalised forces without inputs, with their sign turned.
    pub bias: [R; L],
    /// `G`, the derivatives of the generalised forces by the inputs, `L` by `M`.
    pub input: [[R; M]; L],
}

impl<R: Real, const L: usize, const M: usize> MassForm<R, L, M> {
    /// Reads the lower triangle of the mass matrix row by row, the bias, and the matrix of the inputs row by row.
    ///
    /// ```
    /// use guen_runtime::control::MassForm;
    /// let form = MassForm::<f64, 2, 1>::unpacked(&[2.0, 0.5, 3.0, 0.0, 9.81, 1.0, 0.0]);
    /// assert_eq!(form.mass, [[2.0, 0.5], [0.5, 3.0]]);
    /// assert_eq!((form.bias, form.input), ([0.0, 9.81], [[1.0], [0.0]]));
    /// ```
    ///
    /// Zeros stand where the list ends before.
    pub fn unpacked(entries: &[R]) -> Self {
        let (bias, input) = (L * (L + 1) / 2, L * (L + 1) / 2 + L);
        let at = |i: usize| entries.get(i).copied().unwrap_or_else(R::zero);
        let entry =
            |s: usize, k: usize| if s < k { at(k * (k + 1) / 2 + s) } else { at(s * (s + 1) / 2 + k) };
        Self {
            mass: core::array::from_fn(|s| core::array::from_fn(|k| entry(s, k))),
            bias: core::array::from_fn(|s| at(bias + s)),
            input: core::array::from_fn(|s| core::array::from_fn(|j| at(input + s * M + j))),
        }
    }
}

/// The reason why there are no inputs that produce the accelerations, or none were found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InverseDynamicsError {
    /// The accelerations are outside of what the inputs reach: forces are affine in the inputs, and what is missing is none
    /// of those that they make, nor is a direction left out because little of it is left beside the others.
    OutOfReach {
        /// The largest generalised force that is missing.
        missing: f64,
        /// The rank of `G`: how many generalised forces the inputs set independently.
        rank: usize,
    },
    /// Newton's method came to no inputs that produce the accelerations. That there are none is not said.
    NotFound {
        /// The largest generalised force that is missing where it came closest.
        residual: f64,
        /// The rank of `G` there.
        rank: usize,
        /// The number of starts that were tried: the given one alone, or zero and those that [`inverse_dynamics`]
        /// lists.
        starts: usize,
        /// The one that came closest, counted from zero.
        closest: usize,
    },
    /// A force or an acceleration is infinite or NaN: of several starts, at all of them.
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
            Self::NotFound { residual, rank, starts, closest } => write!(
                f,
                "no inputs were found that produce these accelerations: of {starts} starts, start {closest} came closest, where \
                 a generalised force of {residual:e} is missing and the inputs set {rank} of them; another start may do"
            ),
            Self::NotFinite => f.write_str("a force or an acceleration is not finite"),
        }
    }
}

impl Error for InverseDynamicsError {}

/// The number of starts that [`inverse_dynamics`] tries.
const STARTS: usize = 17;

/// The inputs that produce given accelerations.
///
/// ```text
/// G u = M eta' + bias        u = R^T (R R^T)^-1 Q^T (M eta' + bias),   G = Q R
/// ```
///
/// - `form` gives the equations at trial inputs. It is Newton's method, whose steps are halved until what is missing becomes
///   less; where the forces are affine in the inputs the second evaluation confirms what the first one found.
/// - It starts from zero, and where that leads nowhere, as from a place where `G` vanishes, from 16 others in turn: of the sizes
///   1, 10, 0.1, 100, 0.01, 1000, 0.001, 1e4, each with both signs, input `j` of size `s` is `s (1 - (0.618 j mod 1))`. Better
///   starts are given to [`inverse_dynamics_from`].
/// - Where the inputs are more than the forces they make, the solution of least length is taken; where forces are not affine, the
///   one that Newton's steps of least length lead to.
/// - A column of `G` counts if more than `1e-10` of the longest one is left of it beside the others.
/// - That there are no such inputs is not shown by this: [`affine_inverse_dynamics`] says so.
///
/// ```
/// use guen_runtime::control::{MassForm, inverse_dynamics};
/// // Two motors on one axis share the work.
/// let form = MassForm { mass: [[2.0]], bias: [1.0], input: [[1.0, 1.0]] };
/// let inputs = inverse_dynamics(|_| form, &[3.0]).unwrap();
/// assert!(inputs.iter().all(|u| (u - 3.5_f64).abs() < 1e-14));
/// // The force sqrt(1 + u^2) does not change with the input at zero; one of 1.2 has inputs all the same.
/// let root = |[u]: &[f64; 1]| {
///     let (force, slope) = ((1.0 + u * u).sqrt(), u / (1.0 + u * u).sqrt());
///     MassForm { mass: [[1.0]], bias: [slope * u - force], input: [[slope]] }
/// };
/// let [u] = inverse_dynamics(root, &[1.2]).unwrap();
/// assert!((1.0 + u * u - 1.44).abs() < 1e-12);
/// ```
///
/// # Errors
///
/// [`InverseDynamicsError::NotFound`] or [`NotFinite`](InverseDynamicsError::NotFinite).
pub fn inverse_dynamics<R: Ordered, const L: usize, const M: usize>(
    form: impl Fn(&[R; M]) -> MassForm<R, L, M>,
    accelerations: &[R; L],
) -> Result<[R; M], InverseDynamicsError> {
    search(&form, accelerations, (0..STARTS).map(start)).map_err(Stuck::not_found)
}

/// Finds inputs from a given start: of several solutions the one that Newton's method leads to from there. Where the
/// inputs are more than the forces they make and these are affine, it is the nearest to the start.
///
/// ```
/// use guen_runtime::control::{MassForm, inverse_dynamics_from};
/// let square = |[u]: &[f64; 1]| MassForm { mass: [[1.0]], bias: [u * u], input: [[2.0 * u]] };
/// let [u] = inverse_dynamics_from(square, &[9.0], &[-1.0]).unwrap();
/// assert!((u + 3.0).abs() < 1e-12);
/// ```
///
/// # Errors
///
/// [`InverseDynamicsError::NotFound`] or [`NotFinite`](InverseDynamicsError::NotFinite).
pub fn inverse_dynamics_from<R: Ordered, const L: usize, const M: usize>(
    form: impl Fn(&[R; M]) -> MassForm<R, L, M>,
    accelerations: &[R; L],
    start: &[R; M],
) -> Result<[R; M], InverseDynamicsError> {
    search(&form, accelerations, [*start].into_iter()).map_err(Stuck::not_found)
}

/// Finds inputs for equations that hold at all inputs, those of forces that are affine in them: an acceleration that
/// is not found is out of reach.
///
/// ```
/// use guen_runtime::control::{InverseDynamicsError, MassForm, affine_inverse_dynamics};
/// // A cart cannot accelerate sideways.
/// let form = MassForm { mass: [[1.0, 0.0], [0.0, 1.0]], bias: [0.0; 2], input: [[1.0], [0.0]] };
/// assert!(affine_inverse_dynamics(&form, &[1.0, 0.0]).is_ok());
/// let found = affine_inverse_dynamics(&form, &[0.0, 1.0]);
/// assert_eq!(found, Err(InverseDynamicsError::OutOfReach { missing: 1.0, rank: 1 }));
/// ```
///
/// # Errors
///
/// [`InverseDynamicsError::OutOfReach`], or [`NotFound`](InverseDynamicsError::NotFound) where a direction that was left out, because
/// less than `1e-10` of it is left beside the others, could reach them; [`NotFinite`](InverseDynamicsError::NotFinite).
pub fn affine_inverse_dynamics<R: Ordered, const L: usize, const M: usize>(
    form: &MassForm<R, L, M>,
    accelerations: &[R; L],
) -> Result<[R; M], InverseDynamicsError> {
    search(&|_: &[R; M]| *form, accelerations, [[R::zero(); M]].into_iter()).map_err(|stuck| {
        let Stuck { residual, rank, complete, .. } = stuck;
        match complete && residual.is_finite() {
            true => InverseDynamicsError::OutOfReach { missing: residual, rank },
            false => stuck.not_found(),
        }
    })
}

/// Zero, and others of several sizes.
fn start<R: Ordered, const M: usize>(place: usize) -> [R; M] {
    const SIZES: [f64; STARTS / 2] = [1.0, 10.0, 0.1, 100.0, 0.01, 1e3, 1e-3, 1e4];
    /// The golden section: inputs that are alike do not begin alike.
    const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;

    let Some(place) = place.checked_sub(1) else { return [R::zero(); M] };
    let size = SIZES.get(place / 2).copied().unwrap_or_default() * if place % 2 == 0 { 1.0 } else { -1.0 };
    core::array::from_fn(|j| {
        let turns = GOLDEN_SECTION * j as f64;
        R::from_f64(size * (1.0 - (turns - libm::floor(turns))))
    })
}

/// The result of Newton's method where it found no solution: the closest point that it reached.
#[derive(Clone, Copy)]
struct Stuck {
    /// Infinite where nothing was finite.
    residual: f64,
    rank: usize,
    starts: usize,
    closest: usize,
    /// Whether all directions of `G` were used.
    complete: bool,
}

impl Stuck {
    fn not_found(self) -> InverseDynamicsError {
        let Self { residual, rank, starts, closest, .. } = self;
        if residual.is_finite() {
            InverseDynamicsError::NotFound { residual, rank, starts, closest }
        } else {
            InverseDynamicsError::NotFinite
        }
    }
}

/// Newton's method from each start in turn, until one of them leads to a solution.
fn search<R: Ordered, const L: usize, const M: usize>(
    form: &impl Fn(&[R; M]) -> MassForm<R, L, M>,
    accelerations: &[R; L],
    starts: impl Iterator<Item = [R; M]>,
) -> Result<[R; M], Stuck> {
    let mut best = Stuck { residual: f64::INFINITY, rank: 0, starts: 0, closest: 0, complete: false };
    for (place, start) in starts.enumerate() {
        match newton(form, accelerations, start) {
            Ok(inputs) => return Ok(inputs),
            Err(stuck) if stuck.residual < best.residual => best = Stuck { closest: place, ..stuck },
            Err(_) => {}
        }
        best.starts = place + 1;
    }
    Err(best)
}

/// The generalised forces that are missing at trial inputs.
struct Gap<R, const L: usize, const M: usize> {
    /// `M eta' + bias - G u`
    gap: [R; L],
    /// The largest force that is missing.
    missing: f64,
    /// The largest without its unit: over the root of the inertia that it moves. Otherwise nobody would see the forces of a light body beside those of a
    /// heavy one.
    size: f64,
    /// The largest of what it is the difference of, likewise.
    scale: f64,
    columns: [[R; L]; M],
}

impl<R: Ordered, const L: usize, const M: usize> Gap<R, L, M> {
    fn new(form: &MassForm<R, L, M>, accelerations: &[R; L], inputs: &[R; M]) -> Self {
        let MassForm { mass, bias, input } = form;
        let (inertia, made) = (apply(mass, accelerations), apply(input, inputs));
        let gap = core::array::from_fn(|s| inertia[s] + bias[s] - made[s]);
        let terms = core::array::from_fn(|s| largest([inertia[s], bias[s], made[s]].into_iter()));
        let without_unit = |forces: [f64; L]| {
            let of = |s: usize| {
                let root = libm::sqrt(mass[s][s].to_f64());
                forces[s] / if root > 0.0 && root.is_finite() { root } else { 1.0 }
            };
            largest((0..L).map(of))
        };
        let sizes = gap.map(|force| force.abs().to_f64());
        Self {
            gap,
            missing: largest(gap.iter().copied()),
            size: without_unit(sizes),
            scale: without_unit(terms),
            columns: transpose(input),
        }
    }

    fn is_finite(&self) -> bool {
        self.missing.is_finite() && self.size.is_finite() && self.scale.is_finite()
    }

    /// The least change of the inputs that fills the gap as far as `G` reaches, the rank of `G`, and whether all of its
    /// directions were used.
    fn change(&self) -> Option<([R; M], usize, bool)> {
        const INDEPENDENT: f64 = 1e-10;

        let Self { gap, columns, .. } = self;
        let longest = largest(columns.iter().map(length));
        let mut basis = Basis::<R, L>::new();
        basis.add_all(M, |j| columns.get(j).copied(), INDEPENDENT * longest);
        let rank = basis.count;
        let left = largest(columns.iter().map(|column| length(&basis.remainder(column))));
        let complete = left <= FORCE_ROUNDINGS * R::epsilon().to_f64() * longest;
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
            core::array::from_fn(|k| [if k < rank { dot(&basis.vectors[k], gap) } else { R::zero() }]);
        let y = crate::linear_algebra::dense::solve(&s, &right)?;
        let change = core::array::from_fn(|j| (0..rank).fold(R::zero(), |sum, k| sum + r[k][j] * y[k][0]));
        Some((change, rank, complete))
    }
}

/// Roundings that the generalised forces may be off by.
const FORCE_ROUNDINGS: f64 = 1e3;

/// Newton's method from one start.
fn newton<R: Ordered, const L: usize, const M: usize>(
    form: &impl Fn(&[R; M]) -> MassForm<R, L, M>,
    accelerations: &[R; L],
    start: [R; M],
) -> Result<[R; M], Stuck> {
    /// Newton's method doubles the digits; at a root where the derivative vanishes it halves the error.
    const NEWTON_STEPS: usize = 60;
    /// The number of times that a step is halved.
    const STEP_HALVINGS: u32 = 12;

    let mut inputs = start;
    let mut stuck = Stuck { residual: f64::INFINITY, rank: 0, starts: 0, closest: 0, complete: false };
    let mut here = Gap::new(&form(&inputs), accelerations, &inputs);
    for _ in 0..NEWTON_STEPS {
        if !here.is_finite() {
            break;
        }
        if here.size <= FORCE_ROUNDINGS * R::epsilon().to_f64() * here.scale {
            return Ok(inputs);
        }
        stuck.residual = here.missing;
        let Some((change, rank, complete)) = here.change() else { break };
        (stuck.rank, stuck.complete) = (rank, complete);
        let mut part = R::one();
        let next = (0..STEP_HALVINGS).find_map(|_| {
            let moved: [R; M] = core::array::from_fn(|j| inputs[j] + part * change[j]);
            let there = Gap::new(&form(&moved), accelerations, &moved);
            part *= R::from_ratio(1, 2);
            // What is missing is a number, and less.
            (there.is_finite() && there.size < here.size).then_some((moved, there))
        });
        let Some((moved, there)) = next else { break };
        (inputs, here) = (moved, there);
    }
    Err(stuck)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::vec::Vec;

    use super::{
        InverseDynamicsError, MassForm, affine_inverse_dynamics, inverse_dynamics, inverse_dynamics_from,
    };

    /// Forces of one input, with their slopes, whose slopes vanish at zero, or that are flat far out, or not finite there.
    const FORCES: [fn(f64) -> (f64, f64); 9] = [
        |u| ((1.0 + u * u).sqrt(), u / (1.0 + u * u).sqrt()),
        |u| (u * u, 2.0 * u),
        |u| (u * u * u, 3.0 * u * u),
        |u| (u.cosh(), u.sinh()),
        |u| (u.atan(), 1.0 / (1.0 + u * u)),
        |u| (u.tanh(), 1.0 - u.tanh() * u.tanh()),
        |u| (u.exp(), u.exp()),
        |u| (u.ln(), 1.0 / u),
        |u| (u * u.abs() + 0.1 * u, 2.0 * u.abs() + 0.1),
    ];

    fn form(force: fn(f64) -> (f64, f64), mass: f64) -> impl Fn(&[f64; 1]) -> MassForm<f64, 1, 1> {
        move |[u]| {
            let (made, slope) = force(*u);
            MassForm { mass: [[mass]], bias: [slope * u - made], input: [[slope]] }
        }
    }

    #[test]
    fn forces_that_inputs_make_are_found() {
        let mut refused = Vec::new();
        for (i, force) in FORCES.iter().enumerate() {
            for u in [0.5, -0.5, 1e-2, 2.0, 0.03, 7.0, -3.0, 1e-3] {
                for mass in [1.0, 30.0] {
                    let wanted = force(u).0;
                    if !wanted.is_finite() {
                        continue;
                    }
                    match inverse_dynamics(form(*force, mass), &[wanted / mass]) {
                        Ok([found]) => {
                            assert!((force(found).0 - wanted).abs() <= 1e-12 * (1.0 + wanted.abs()))
                        }
                        Err(error) => refused.push((i, u, error)),
                    }
                }
            }
        }
        assert!(refused.is_empty(), "{refused:?}");
    }

    #[test]
    fn forces_of_two_inputs_are_found() {
        // Products and squares, with derivatives that vanish at zero.
        let both = |&[u, v]: &[f64; 2]| {
            let (made, slopes) = ([u * v, u * u - v * v], [[v, u], [2.0 * u, -2.0 * v]]);
            let bias = core::array::from_fn(|s| slopes[s][0] * u + slopes[s][1] * v - made[s]);
            MassForm { mass: [[1.0, 0.0], [0.0, 1.0]], bias, input: slopes }
        };
        for k in 0..200 {
            let (angle, size) = (0.37 * f64::from(k), 1e-2 * 1.05_f64.powi(k));
            let (u, v) = (size * angle.cos(), size * angle.sin());
            let wanted = [u * v, u * u - v * v];
            let [u, v] = inverse_dynamics(both, &wanted).unwrap();
            let scale = wanted[0].abs() + wanted[1].abs();
            assert!((u * v - wanted[0]).abs() + (u * u - v * v - wanted[1]).abs() < 1e-11 * scale);
        }
    }

    #[test]
    fn what_was_not_found_is_not_said_to_be_out_of_reach() {
        // A root is never negative; nobody shows it.
        let found = inverse_dynamics(form(FORCES[0], 1.0), &[0.5]);
        let Err(InverseDynamicsError::NotFound { residual, starts: 17, .. }) = found else {
            panic!("{found:?}")
        };
        assert!((residual - 0.5).abs() < 1e-3, "{residual}");
        // From where the slope vanishes; from elsewhere.
        let from = |start: f64| inverse_dynamics_from(form(FORCES[0], 1.0), &[1.2], &[start]);
        assert!(matches!(
            from(0.0),
            Err(InverseDynamicsError::NotFound { starts: 1, closest: 0, rank: 0, .. })
        ));
        assert!(from(-0.1).unwrap()[0] < 0.0 && from(0.1).unwrap()[0] > 0.0);
        let nowhere = |_: &[f64; 1]| MassForm { mass: [[f64::NAN]], bias: [0.0], input: [[1.0]] };
        assert_eq!(inverse_dynamics(nowhere, &[1.0]), Err(InverseDynamicsError::NotFinite));
    }

    #[test]
    fn a_light_body_is_moved_beside_a_heavy_one() {
        // A heavy body that falls as it is asked to, and a wheel with 50 rad/s^2.
        for light in [1.0, 1e-10, 1e-16] {
            let form = MassForm {
                mass: [[1e4, 0.0], [0.0, light]],
                bias: [1e4 * 9.81, 0.0],
                input: [[1.0, 0.0], [0.0, 1.0]],
            };
            let [push, torque]: [f64; 2] = affine_inverse_dynamics(&form, &[-9.81, 50.0]).unwrap();
            assert!(
                push.abs() < 1e-10 && (torque / (50.0 * light) - 1.0).abs() < 1e-14,
                "{light:e}: {torque:e}"
            );
        }
    }

    #[test]
    fn directions_that_were_left_out_show_nothing() {
        let of = |little: f64| MassForm {
            mass: [[1.0, 0.0], [0.0, 1.0]],
            bias: [0.0; 2],
            input: [[1.0, 1.0], [0.0, little]],
        };
        let found = |little| affine_inverse_dynamics(&of(little), &[0.0, 1.0]);
        assert!(matches!(found(0.0), Err(InverseDynamicsError::OutOfReach { rank: 1, .. })));
        assert!(matches!(found(1e-11), Err(InverseDynamicsError::NotFound { rank: 1, .. })));
        assert!(found(1e-6).is_ok());
    }
}
