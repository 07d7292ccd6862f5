//! Systems: a right-hand side over `N` reals, and the quantities that its motion keeps.

pub(crate) mod check_costs;
pub(crate) mod constants_error;
pub(crate) mod constraints;
pub(crate) mod derivatives;
pub(crate) mod forward;
pub(crate) mod guarded;
pub(crate) mod hints;
pub(crate) mod inputs;
pub(crate) mod invariants;
pub(crate) mod level;
pub(crate) mod observables;
pub(crate) mod operators;
pub(crate) mod simulate;
pub(crate) mod with_scalar;

use self::constraints::positions_error::PositionsError;
use crate::numbers::lanes::Lanes;
use crate::numbers::real::Real;
use crate::system::forward::forward;
use crate::system::guarded::Guarded;

/// The most [switching functions](System::switches) of a system.
pub const MAX_SWITCHES: usize = 64;

/// A system of `N` ordinary differential equations of first order over the real `R`.
///
/// ```text
/// dx/dt = rhs(t, x)
/// ```
///
/// - `t`: time; `x`: the state, for a generated system its coordinates and then its parameters (the
///   quasi-velocities), in the order of their declaration.
/// - The result holds the rates, in the same order.
/// - Outside the domain of its chart the right-hand side is NaN or infinite. It does not panic; steppers test.
/// - Inputs are constant during a step: an implementation for a driven system holds them.
///
/// A closure becomes a system with [`from_fn`], and a reference to a system is one.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no system of {N} equations over `{R}`",
    note = "constants become a system with `.prepare()?`, over the real that they are given in",
    note = "a prepared system with inputs becomes one with `.with_inputs(|t, state| ..)`, or with `.driven(inputs)` where they are held",
    note = "a closure `(t, state) -> rates` becomes one with `from_fn`"
)]
pub trait System<R: Real, const N: usize> {
    /// The rate of change of the state at time `t`.
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N];

    /// Puts the state at the end of a step back to where it belongs; steppers call it for every step that they
    /// accept. Does nothing, unless the system is [`projected`](crate::projected).
    ///
    /// # Errors
    ///
    /// Whatever keeps the state from being put back; the state is unchanged then, and the integration ends.
    #[inline]
    fn restore(&self, _t: R, _state: &mut [R; N]) -> Result<(), PositionsError> {
        Ok(())
    }

    /// Writes functions at whose zeros the right-hand side changes its formula, as `max(0, x)` does at `x = 0`, to the head of
    /// `values`, and returns how many: none, unless a system says more. At most [`MAX_SWITCHES`] count. A method that chooses its
    /// steps ends one at every change of sign, located to rounding, and starts anew behind it.
    ///
    /// ```
    /// use guen_runtime::System;
    /// use guen_runtime::steppers::{Dop853, Integration};
    ///
    /// /// A mass that a spring pushes on one side of zero only.
    /// struct Stop;
    /// impl System<f64, 2> for Stop {
    ///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
    ///         [v, if x < 0.0 { -100.0 * x } else { 0.0 }]
    ///     }
    ///     fn switches(&self, _t: f64, state: &[f64; 2], values: &mut [f64]) -> usize {
    ///         values[0] = state[0];
    ///         1
    ///     }
    /// }
    /// // It comes back after half a period of the spring, as fast as it came.
    /// let done = Integration::new(&Stop, 0.0, &[1.0, -1.0]).run(&Dop853::new(1e-10, 1e-10), 3.0).unwrap();
    /// assert!((done.state[0] - (2.0 - std::f64::consts::PI / 10.0)).abs() < 1e-9);
    /// assert_eq!(done.statistics.switches, 2);
    /// ```
    #[inline]
    fn switches(&self, _t: R, _state: &[R; N], _values: &mut [R]) -> usize {
        0
    }

    /// Answers to the [`Guard`](crate::steppers::Guard) of a stepper: by default those of `()`, which are the defaults of [`Guarded`]. A
    /// system with answers of its own implements that trait and returns `self`; generated systems do.
    #[inline]
    fn guarded(&self) -> impl Guarded<R, N> {}
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> System<R, N> for &S {
    forward!(self -> (**self); System<R, N>, restore, guarded);
}

impl<R: Real, G: Guarded<R, N> + ?Sized, const N: usize> Guarded<R, N> for &G {
    forward!(self -> (**self); Guarded<R, N>);
}

/// A system over `f64` of which several, with constants of their own, can be put into lanes.
///
/// Generated systems are; so is one written by hand that is generic in its real:
///
/// ```
/// use guen_runtime::lanes::Lanes;
/// use guen_runtime::{Laned, Real, System};
///
/// struct Decay<R>(R);
///
/// impl<R: Real> System<R, 1> for Decay<R> {
///     #[inline]
///     fn rhs(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
///         R::vectorize(#[inline(always)] || [-self.0 * x])
///     }
/// }
///
/// impl Laned<1> for Decay<f64> {
///     type Over<L: Lanes> = Decay<L>;
///
///     fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Decay<L> {
///         Decay(L::from_fn(|lane| member(lane).0))
///     }
/// }
/// # fn is_laned<S: Laned<1>>(_: S) {}
/// # is_laned(Decay(0.5));
/// ```
pub trait Laned<const N: usize>: System<f64, N> {
    /// The system over lanes.
    type Over<L: Lanes>: System<L, N>;

    /// The systems `member(0) .. member(L::COUNT - 1)` side by side.
    fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Self::Over<L>
    where
        Self: 'a;
}

impl<S: Laned<N>, const N: usize> Laned<N> for &S {
    type Over<L: Lanes> = S::Over<L>;

    fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> S::Over<L>
    where
        Self: 'a,
    {
        S::gather(|lane| *member(lane))
    }
}

/// A system with quantities that its exact solutions keep, for a monitor to watch.
///
/// The quantities are computed from the state alone, by other expressions than the right-hand side, so a change
/// in them measures what the integration got wrong.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no energy to watch",
    note = "a scene has one if it says `provide energy;`"
)]
pub trait Monitored<R: Real, const N: usize>: System<R, N> {
    /// The energy integral at time `t`, in the units of the declared energies; a system that is
    /// [`Conservative`](crate::Conservative) keeps it.
    ///
    /// ```text
    /// h = sum_i x_i' dT/dx_i' - T - U
    /// ```
    ///
    /// With `T` homogeneous of degree two in the velocities this is `T - U`, kinetic plus potential energy.
    fn energy(&self, t: R, state: &[R; N]) -> R;

    /// The largest absolute value among the left sides `f(t, x)` of the holonomic constraints `f = 0`, each in
    /// its own unit; zero for a system without any.
    fn residual(&self, _t: R, _state: &[R; N]) -> R {
        R::zero()
    }
}

impl<R: Real, S: Monitored<R, N> + ?Sized, const N: usize> Monitored<R, N> for &S {
    forward!(self -> (**self); Monitored<R, N>);
}

/// A system made of a closure: see [`from_fn`].
#[derive(Clone, Copy, Debug)]
pub struct FromFn<F>(F);

/// Turns a closure `(t, state) -> rates` into a [`System`].
///
/// ```
/// use guen_runtime::{System, from_fn};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// assert_eq!(oscillator.rhs(0.0, &[1.0, 2.0]), [2.0, -1.0]);
/// ```
pub fn from_fn<R, F, const N: usize>(rhs: F) -> FromFn<F>
where
    R: Real,
    F: Fn(R, &[R; N]) -> [R; N],
{
    FromFn(rhs)
}

impl<R, F, const N: usize> System<R, N> for FromFn<F>
where
    R: Real,
    F: Fn(R, &[R; N]) -> [R; N],
{
    #[inline]
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N] {
        (self.0)(t, state)
    }
}
