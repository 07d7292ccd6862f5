//! Constraints on positions at run time: coordinates that fulfil them, and keeping them fulfilled on the way.
//!
//! The equations of motion know `f(t, x) = 0` by its rate alone, so rounding and the error of the method let `f`
//! drift away from zero. This module puts the coordinates back and leaves the parameters as they are: velocities
//! `x' = xi_0 + sum_s eta_s xi_s` keep the rate of `f` zero wherever the coordinates are.

use super::nearer;
use super::positions_error::PositionsError;
use crate::numbers::real::{Ordered, Real};
use crate::system::derivatives::differentiable::Differentiable;
use crate::system::derivatives::series::{Coefficients, TaylorSeries};
use crate::system::forward::forward;
use crate::system::{Monitored, System};

/// A system with constraints on positions `f(t, x) = 0`: `H` of them, on `N` coordinates.
pub trait Positions<R: Real, const N: usize, const H: usize> {
    /// The left sides `f_1 .. f_H`, each in its own unit.
    fn gaps(&self, t: R, coordinates: &[R; N]) -> [R; H];

    /// The left sides, and beside them the derivatives `F_vi = d f_v / d x_i`, exact, a row for each constraint.
    fn linearized(&self, t: R, coordinates: &[R; N]) -> ([R; H], [[R; N]; H]);

    /// Hands on further equations that follow from these wherever all hold, each as its left side and the derivatives of it. They are
    /// not solved with the others, on whose gradients theirs depend, and tell apart the branches of these. There may be none.
    fn further(&self, _t: R, _coordinates: &[R; N], _take: &mut dyn FnMut(R, &[R; N])) {}

    /// Returns the distance of the coordinates from the further equations, as a length: the largest left side over the length of its
    /// gradient. Zero where there are none; NaN and infinity count as infinite.
    fn surplus(&self, t: R, coordinates: &[R; N]) -> f64 {
        let mut most = 0.0_f64;
        self.further(t, coordinates, &mut |gap, gradient| {
            let length = match gap.to_f64().abs() {
                0.0 => 0.0,
                gap => gap / size(gradient),
            };
            most = if length.is_nan() { f64::INFINITY } else { most.max(length) };
        });
        most
    }
}

impl<R: Real, S: Positions<R, N, H> + ?Sized, const N: usize, const H: usize> Positions<R, N, H> for &S {
    #[inline]
    fn gaps(&self, t: R, coordinates: &[R; N]) -> [R; H] {
        (**self).gaps(t, coordinates)
    }

    #[inline]
    fn linearized(&self, t: R, coordinates: &[R; N]) -> ([R; H], [[R; N]; H]) {
        (**self).linearized(t, coordinates)
    }

    fn further(&self, t: R, coordinates: &[R; N], take: &mut dyn FnMut(R, &[R; N])) {
        (**self).further(t, coordinates, take);
    }

    #[inline]
    fn surplus(&self, t: R, coordinates: &[R; N]) -> f64 {
        (**self).surplus(t, coordinates)
    }
}

/// Coordinates that fulfil the constraints on positions, near a guess and with some of them as they are in it.
///
/// ```text
/// dx = -F^T (F F^T)^-1 f,    F by the coordinates that are not given
/// ```
///
/// - Newton's method, each step the shortest that fulfils the linearised constraints; steps are halved as long as
///   the next one would not be shorter, and none is longer than twice the largest coordinate that is free. Where fewer coordinates are given than there are degrees of freedom, the
///   result is a point of the constraint set near the guess.
/// - Where that comes to no end, or to a branch where [further equations](Positions::further) do not hold, it begins anew from
///   where all equations together are near zero, by damped least squares from the guess.
/// - `names` are those of the coordinates, `given` some of them.
/// - The lengths of steps add the squares of coordinates in their units.
///
/// # Errors
///
/// See [`PositionsError`]. The guess decides between the assemblies of a mechanism, and whether one is found.
pub fn consistent<R, S, const N: usize, const H: usize>(
    system: &S,
    t: R,
    guess: &[R; N],
    names: &[&str; N],
    given: &[&'static str],
) -> Result<[R; N], PositionsError>
where
    R: Ordered,
    S: Positions<R, N, H> + ?Sized,
{
    let mut free = [true; N];
    for name in given {
        let Some(i) = names.iter().position(|known| known == name) else {
            return Err(PositionsError::UnknownCoordinate { name });
        };
        free[i] = false;
    }
    let left = free.iter().filter(|free| **free).count();
    if left < H {
        return Err(PositionsError::TooManyGiven { left, constraints: H });
    }
    let mut x = *guess;
    let Err(fault) = search(system, t, &mut x, &free, Proof::OfGuess) else { return Ok(x) };
    // Of further equations these may have led to another branch, or have no branches apart here.
    let Some(near) = nearer::by_all(system, t, guess, &free) else { return Err(fault) };
    let mut x = near;
    let is_found = search(system, t, &mut x, &free, Proof::OfGuess).is_ok() && nearer::stayed(&near, &x);
    if is_found { Ok(x) } else { Err(fault) }
}

/// Moves the coordinates at the head of a state onto the constraints, the shortest way, and leaves the parameters.
/// Returns how far, the length of the correction in the units of the coordinates.
///
/// ```text
/// dx = -F^T (F F^T)^-1 f
/// ```
///
/// One evaluation of `f` and `F` and the solution of `H` equations where the state is off by what a step leaves;
/// more only where that was much. No allocation.
///
/// ```
/// use guen_runtime::{Positions, project};
///
/// /// A point on the unit circle.
/// struct Circle;
///
/// impl Positions<f64, 2, 1> for Circle {
///     fn gaps(&self, _t: f64, [x, y]: &[f64; 2]) -> [f64; 1] {
///         [x * x + y * y - 1.0]
///     }
///     fn linearized(&self, t: f64, x: &[f64; 2]) -> ([f64; 1], [[f64; 2]; 1]) {
///         (self.gaps(t, x), [x.map(|x| 2.0 * x)])
///     }
/// }
///
/// // Two coordinates and a velocity, which stays.
/// let mut state = [0.9, 1.2, 5.0];
/// assert!((project(&Circle, 0.0, &mut state).unwrap() - 0.5).abs() < 1e-14);
/// assert!((state[0] - 0.6).abs() < 1e-14 && (state[1] - 0.8).abs() < 1e-14 && state[2] == 5.0);
/// // In the middle of the circle no way is the shortest.
/// assert!(project(&Circle, 0.0, &mut [0.0, 0.0, 5.0]).is_err());
/// ```
///
/// # Errors
///
/// [`PositionsError`]; the state is unchanged then.
pub fn project<R, S, const N: usize, const H: usize, const M: usize>(
    system: &S,
    t: R,
    state: &mut [R; M],
) -> Result<f64, PositionsError>
where
    R: Ordered,
    S: Positions<R, N, H> + ?Sized,
{
    const { assert!(N <= M, "a state begins with its coordinates") }
    let mut x: [R; N] = core::array::from_fn(|i| state[i]);
    let moved = search(system, t, &mut x, &[true; N], Proof::OfStep)?;
    state[..N].copy_from_slice(&x);
    Ok(moved)
}

/// The state with the coordinates at its head moved onto constraints on positions, the shortest way, over any real: the derivatives of the
/// result are those of the way. `linearized` returns the left sides and their gradients.
///
/// ```text
/// dx = -F^T (F F^T)^-1 f
/// ```
///
/// # Errors
///
/// [`PositionsError`].
#[doc(hidden)]
pub fn onto<R: Real, const N: usize, const M: usize, const H: usize>(
    t: R,
    state: &[R; M],
    linearized: impl Fn(R, &[R; N]) -> ([R; H], [[R; N]; H]),
) -> Result<[R; M], PositionsError> {
    /// Steps of Newton's method: it doubles the digits, of which what a step of an integration leaves has half at least.
    const RESTORING_STEPS: usize = 8;

    const { assert!(N <= M, "a state begins with its coordinates") }
    let mut onto = *state;
    let precision = libm::sqrt(R::epsilon().to_f64());
    let mut f = [R::zero(); H];
    for _ in 0..RESTORING_STEPS {
        let x: [R; N] = core::array::from_fn(|i| onto[i]);
        let gradients;
        (f, gradients) = linearized(t, &x);
        let mut squares: [[R; H]; H] = core::array::from_fn(|v| {
            core::array::from_fn(|w| {
                let products = gradients[v].iter().zip(&gradients[w]);
                products.fold(R::zero(), |sum, (a, b)| a.times_plus(*b, sum))
            })
        });
        // Symmetric and positive definite: no order of elimination is better than another.
        let mut multipliers = f;
        for k in 0..H {
            for row in k + 1..H {
                let pivot = squares[k];
                let factor = squares[row][k] / pivot[k];
                for (entry, above) in squares[row].iter_mut().zip(&pivot).skip(k + 1) {
                    *entry = entry.minus_times(factor, *above);
                }
                multipliers[row] = multipliers[row].minus_times(factor, multipliers[k]);
            }
        }
        for k in (0..H).rev() {
            for column in k + 1..H {
                multipliers[k] = multipliers[k].minus_times(squares[k][column], multipliers[column]);
            }
            multipliers[k] /= squares[k][k];
        }
        let step: [R; N] = core::array::from_fn(|i| {
            (0..H).fold(R::zero(), |sum, v| multipliers[v].times_plus(gradients[v][i], sum))
        });
        let length = size(&step);
        if !length.is_finite() {
            return Err(PositionsError::Singular { residual: largest(&f) });
        }
        for (x, step) in onto.iter_mut().zip(step) {
            *x -= step;
        }
        let extent = x.iter().fold(length, |most, x| most.max(x.to_f64().abs()));
        // Newton's method squares the error, so that after a step as short as this nothing is left to do.
        if length <= precision * extent {
            return Ok(onto);
        }
    }
    Err(PositionsError::NotFound { residual: largest(&f) })
}

/// Whether a search that ends at once asks the equations once more.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Proof {
    /// A guess may be far off in coordinates that are small beside others.
    OfGuess,
    /// A step leaves little.
    OfStep,
}

/// Newton's method on the coordinates that are free; the distance to where it began.
fn search<R, S, const N: usize, const H: usize>(
    system: &S,
    t: R,
    x: &mut [R; N],
    free: &[bool; N],
    proof: Proof,
) -> Result<f64, PositionsError>
where
    R: Ordered,
    S: Positions<R, N, H> + ?Sized,
{
    /// Far more than a search takes that comes near a solution at all.
    const SEARCH_STEPS: usize = 60;
    /// The shortest part of a step that is tried, of the longest that is.
    const SHORTEST: f64 = 1e-4;
    /// The longest step over the largest coordinate: near a dead point steps lead far away, where angles have turned round many times.
    const LONGEST: f64 = 2.0;
    /// The part of a step that the next one may be at most where the digits have doubled.
    const DOUBLED: f64 = 1e-6;
    /// Roundings of the largest coordinate that a step may be where nothing gets shorter.
    const ROUNDINGS: f64 = 1e3;

    let begin = *x;
    let precision = libm::sqrt(R::epsilon().to_f64());
    let reach = |x: &[R; N]| {
        let found = x.iter().zip(free).filter(|(_, free)| **free);
        found.fold(0.0_f64, |most, (x, _)| most.max(x.to_f64().abs()))
    };
    let mut extent = reach(x);
    for round in 0..SEARCH_STEPS {
        let (f, gradients) = system.linearized(t, x);
        if f.iter().all(|f| f.to_f64() == 0.0) {
            return ended(system, t, x, &begin, precision * extent);
        }
        let factor = Factor::new(gradients, free, &f)?;
        let step = factor.step(&f);
        let length = size(&step);
        if !length.is_finite() {
            return Err(PositionsError::NotFinite);
        }
        if extent == 0.0 {
            extent = length;
        }
        // Newton's method squares the error, so that after a step as short as this nothing is left to do, if the error of every coordinate is
        // small beside it. Of a guess the next step tells.
        if length <= precision * extent {
            let there = moved(x, &step, 1.0);
            let is_last = round == 0 && proof == Proof::OfStep || {
                let next = size(&factor.step(&system.gaps(t, &there)));
                next <= DOUBLED * length
                    || next > length / 2.0 && length <= ROUNDINGS * R::epsilon().to_f64() * extent
            };
            if is_last {
                *x = there;
                return ended(system, t, x, &begin, precision * extent);
            }
        }
        let longest = (LONGEST * extent / length).min(1.0);
        let mut part = longest;
        loop {
            let trial = moved(x, &step, part);
            let gaps = system.gaps(t, &trial);
            // Measured by the step that they would ask for, whatever units the constraints have.
            if size(&factor.step(&gaps)) <= (1.0 - part / 4.0) * length {
                *x = trial;
                break;
            }
            part /= 2.0;
            if part < SHORTEST * longest {
                return Err(PositionsError::NotFound { residual: largest(&f) });
            }
        }
        extent = extent.max(reach(x));
    }
    Err(PositionsError::NotFound { residual: largest(&system.gaps(t, x)) })
}

/// The distance from where a search began, if what follows from the equations holds where it ended: on another branch of the
/// equations that were solved it may not.
fn ended<R, S, const N: usize, const H: usize>(
    system: &S,
    t: R,
    x: &[R; N],
    begin: &[R; N],
    near: f64,
) -> Result<f64, PositionsError>
where
    R: Ordered,
    S: Positions<R, N, H> + ?Sized,
{
    let surplus = system.surplus(t, x);
    if surplus <= near { Ok(distance(x, begin)) } else { Err(PositionsError::NotFound { residual: surplus }) }
}

/// `F` with the factor `L` of `F F^T = L L^T`.
struct Factor<R, const N: usize, const H: usize> {
    gradients: [[R; N]; H],
    lower: [[R; H]; H],
}

impl<R: Ordered, const N: usize, const H: usize> Factor<R, N, H> {
    fn new(mut gradients: [[R; N]; H], free: &[bool; N], f: &[R; H]) -> Result<Self, PositionsError> {
        /// A pivot that is this many roundings of its diagonal entry is none.
        const PIVOT_ROUNDINGS: f64 = 64.0;

        for row in &mut gradients {
            for (entry, free) in row.iter_mut().zip(free) {
                if !free {
                    *entry = R::zero();
                }
            }
        }
        let mut lower = [[R::zero(); H]; H];
        for v in 0..H {
            for u in 0..=v {
                let product = (0..N).fold(R::zero(), |sum, i| sum + gradients[v][i] * gradients[u][i]);
                let known = (0..u).fold(R::zero(), |sum, k| sum + lower[v][k] * lower[u][k]);
                let rest = product - known;
                if u < v {
                    lower[v][u] = rest / lower[u][u];
                    continue;
                }
                let (pivot, whole) = (rest.to_f64(), product.to_f64());
                if !whole.is_finite() {
                    return Err(PositionsError::NotFinite);
                }
                if pivot <= PIVOT_ROUNDINGS * R::epsilon().to_f64() * whole {
                    return Err(PositionsError::Singular { residual: largest(f) });
                }
                lower[v][v] = rest.sqrt();
            }
        }
        Ok(Factor { gradients, lower })
    }

    /// `-F^T (F F^T)^-1 f`.
    fn step(&self, f: &[R; H]) -> [R; N] {
        let mut y = *f;
        for v in 0..H {
            let known = (0..v).fold(R::zero(), |sum, k| sum + self.lower[v][k] * y[k]);
            y[v] = (y[v] - known) / self.lower[v][v];
        }
        for v in (0..H).rev() {
            let known = (v + 1..H).fold(R::zero(), |sum, k| sum + self.lower[k][v] * y[k]);
            y[v] = (y[v] - known) / self.lower[v][v];
        }
        core::array::from_fn(|i| -(0..H).fold(R::zero(), |sum, v| sum + self.gradients[v][i] * y[v]))
    }
}

pub(super) fn moved<R: Real, const N: usize>(x: &[R; N], step: &[R; N], part: f64) -> [R; N] {
    let part = R::from_f64(part);
    core::array::from_fn(|i| x[i] + part * step[i])
}

pub(super) fn size<R: Real>(step: &[R]) -> f64 {
    libm::sqrt(step.iter().map(|e| e.to_f64() * e.to_f64()).sum())
}

pub(super) fn distance<R: Real, const N: usize>(a: &[R; N], b: &[R; N]) -> f64 {
    size(&core::array::from_fn::<R, N, _>(|i| a[i] - b[i]))
}

fn largest<R: Real>(values: &[R]) -> f64 {
    crate::numbers::choices::largest(values).to_f64()
}

/// A system whose coordinates are put back onto its constraints after every step: see [`projected`].
#[derive(Clone, Copy, Debug)]
pub struct Projected<S, const N: usize, const H: usize>(S);

/// The system, or a reference to it, for a stepper that restores `f(t, x) = 0` after each step by [`project`].
///
/// Without it the constraints drift by the error of the method, usually along with everything else; with it they
/// hold to rounding, at the price that [`project`] names.
pub fn projected<R, S, const N: usize, const H: usize>(system: S) -> Projected<S, N, H>
where
    R: Real,
    S: Positions<R, N, H>,
{
    Projected(system)
}

impl<R, S, const N: usize, const H: usize, const M: usize> System<R, M> for Projected<S, N, H>
where
    R: Ordered,
    S: System<R, M> + Positions<R, N, H>,
{
    forward!(self -> self.0; System<R, M>, guarded);

    fn restore(&self, t: R, state: &mut [R; M]) -> Result<(), PositionsError> {
        let mut restored = *state;
        self.0.restore(t, &mut restored)?;
        project(&self.0, t, &mut restored)?;
        *state = restored;
        Ok(())
    }
}

impl<R, S, const N: usize, const H: usize, const M: usize> Differentiable<R, M> for Projected<S, N, H>
where
    R: Ordered,
    S: Differentiable<R, M> + Positions<R, N, H>,
{
    forward!(self -> self.0; Differentiable<R, M>);
}

impl<R, S, const N: usize, const H: usize, const M: usize> TaylorSeries<R, M> for Projected<S, N, H>
where
    R: Ordered,
    S: TaylorSeries<R, M> + Positions<R, N, H>,
{
    forward!(self -> self.0; TaylorSeries<R, M>);
}

impl<R, S, const N: usize, const H: usize, const M: usize> Monitored<R, M> for Projected<S, N, H>
where
    R: Ordered,
    S: Monitored<R, M> + Positions<R, N, H>,
{
    forward!(self -> self.0; Monitored<R, M>);
}
