//! Answers of a system to a guard.

use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::system::check_costs::CheckCosts;
use crate::system::invariants::Invariants;

/// Answers of a system of `N` equations to the [`Guard`](crate::steppers::Guard) of a stepper.
///
/// Every method has a default, by which there is nothing to watch: a system written by hand need not mention this trait. One with more to
/// say implements it, and returns itself from [`System::guarded`](crate::System::guarded):
///
/// ```
/// use guen_runtime::steppers::{Dop853, Integration};
/// use guen_runtime::{Cause, Guarded, Invariants, System};
///
/// /// A mass on a spring, damped by mistake: its energy should be kept.
/// struct Oscillator;
/// impl System<f64, 2> for Oscillator {
///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -x - 0.1 * v]
///     }
///     fn guarded(&self) -> impl Guarded<f64, 2> {
///         self
///     }
/// }
/// impl Guarded<f64, 2> for Oscillator {
///     fn conserved(&self, _t: f64, &[x, v]: &[f64; 2]) -> Invariants<f64> {
///         let energy = v * v + x * x;
///         Invariants { energy: Some(energy), scale: energy, ..Invariants::default() }
///     }
/// }
/// let error = Integration::new(&Oscillator, 0.0, &[1.0, 0.0]).run(&Dop853::new(1e-9, 1e-9), 50.0).unwrap_err();
/// assert!(matches!(error.cause, Cause::Energy { .. }), "{error}");
/// ```
///
/// An implementation alone, without the method `guarded`, compiles and is never asked.
pub trait Guarded<R: Real, const N: usize> {
    /// Quantities that the exact motion keeps, for the [`Guard`](crate::steppers::Guard) of a stepper to look at now
    /// and then. None, unless a system says more; generated systems do.
    #[inline]
    fn conserved(&self, _t: R, _state: &[R; N]) -> Invariants<R> {
        Invariants::default()
    }

    /// Writes functions that must not vanish, since the system's chart or its equations end there, to the head of
    /// `values`, and returns how many: none, unless a system says more. What does not fit is left out. Their distance
    /// from vanishing is what is [`left`](RunningError::left) of them, given how uncertain time and state are. A guard
    /// refuses to go on where one of them changes its sign or is closer than its limit, and calls this inside of
    /// [`Real::vectorize`], which costs less than to do so here.
    #[inline]
    fn singularities(
        &self,
        _t: RunningError<R>,
        _state: &[RunningError<R>; N],
        _values: &mut [RunningError<R>],
    ) -> usize {
        0
    }

    /// Returns the condition of the equations for the accelerations: one where they are not coupled, infinite where
    /// they cannot be solved, whatever the units. Rounding errors of the accelerations are up to so many roundings.
    ///
    /// ```text
    /// max_s M_ss (M^-1)_ss
    /// ```
    ///
    /// with the mass matrix `M`: how much less inertia a parameter has while the others are free to move than while
    /// they are held. The condition of `M`, scaled to a diagonal of ones, is at least this and at most `l^2` times
    /// this, with `l` parameters. Of lanes that of each. One, unless a system says more; generated systems do.
    #[inline]
    fn condition(&self, _t: R, _state: &[R; N]) -> R {
        R::one()
    }

    /// The costs of [`conserved`](Guarded::conserved), [`singularities`](Guarded::singularities) and
    /// [`condition`](Guarded::condition), by which a guard decides how often it checks. Those of
    /// [`CheckCosts::default`], unless a system says more; generated systems count their operations.
    #[inline]
    fn check_costs(&self) -> CheckCosts {
        CheckCosts::default()
    }
}

/// Answers of a system that has none of its own.
impl<R: Real, const N: usize> Guarded<R, N> for () {}
