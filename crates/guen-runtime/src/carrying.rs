//! Systems that carry elementary functions as states, and keeping these on their relations.

use crate::differentiable::Differentiable;
use crate::positions::PositionsError;
use crate::real::Real;
use crate::rounded::Rounded;
use crate::system::{Monitored, System};
use crate::vitals::Vitals;

/// A system with elementary functions among its states, such as the sine and the cosine of an angle. The carried form of
/// a generated system is one: see `provide carried;` in the language reference.
pub trait Carrying<R: Real, const N: usize>: System<R, N> {
    /// Moves the carried functions closer to the relations among them, without an elementary call: a pair of sine and
    /// cosine onto the circle, a root and a hyperbolic cosine by a step of Newton's method. What has no relation stays.
    /// The phase of a sine is not mended by this; to compute all functions anew is `carry`.
    ///
    /// ```text
    /// (s, c) -> (3 - s^2 - c^2)/2 (s, c)
    /// ```
    fn rejoin(&self, t: R, state: &mut [R; N]);
}

impl<R: Real, S: Carrying<R, N> + ?Sized, const N: usize> Carrying<R, N> for &S {
    #[inline]
    fn rejoin(&self, t: R, state: &mut [R; N]) {
        (**self).rejoin(t, state);
    }
}

/// A system whose carried functions are put back onto their relations after every step: see [`rejoined`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rejoined<S>(S);

/// The system, with [`Carrying::rejoin`] after every accepted step of a stepper. Costs four multiplications and three
/// additions for a sine with its cosine in every step, and a further evaluation where the method would have used the slope
/// at the end of the step again.
///
/// ```
/// use guen_runtime::prelude::*;
/// use guen_runtime::{Carrying, rejoined};
///
/// /// An angle that grows by one each second, by its sine and cosine.
/// struct Clock;
///
/// impl System<f64, 2> for Clock {
///     fn rhs(&self, _t: f64, &[s, c]: &[f64; 2]) -> [f64; 2] {
///         [c, -s]
///     }
/// }
///
/// impl Carrying<f64, 2> for Clock {
///     fn rejoin(&self, _t: f64, state: &mut [f64; 2]) {
///         let factor = (3.0 - state[0] * state[0] - state[1] * state[1]) / 2.0;
///         *state = state.map(|x| x * factor);
///     }
/// }
///
/// let run = |end: Done<f64, 2>| (end.state[0].powi(2) + end.state[1].powi(2) - 1.0).abs();
/// let go_on = |_: f64, _: &[f64; 2]| ControlFlow::Continue(());
/// let free = Rk4 { step: 0.1 }.integrate(&Clock, 0.0, &[0.0, 1.0], 100.0, go_on).unwrap();
/// let held = Rk4 { step: 0.1 }.integrate(&rejoined(Clock), 0.0, &[0.0, 1.0], 100.0, go_on).unwrap();
/// assert!(run(free) > 1e-6 && run(held) < 1e-13);
/// ```
pub fn rejoined<S>(system: S) -> Rejoined<S> {
    Rejoined(system)
}

impl<R: Real, S: Carrying<R, N>, const N: usize> System<R, N> for Rejoined<S> {
    #[inline]
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N] {
        self.0.rhs(t, state)
    }

    #[inline]
    fn restore(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError> {
        self.0.rejoin(t, state);
        self.0.restore(t, state)
    }

    fn vitals(&self, t: R, state: &[R; N]) -> Vitals<R> {
        self.0.vitals(t, state)
    }

    fn edges(&self, t: Rounded<R>, state: &[Rounded<R>; N], values: &mut [Rounded<R>]) -> usize {
        self.0.edges(t, state, values)
    }

    fn condition(&self, t: R, state: &[R; N]) -> R {
        self.0.condition(t, state)
    }

    fn cost_of_look(&self) -> u32 {
        self.0.cost_of_look()
    }

    fn cost_of_edges(&self) -> f64 {
        self.0.cost_of_edges()
    }
}

impl<R: Real, S: Carrying<R, N> + Differentiable<R, N>, const N: usize> Differentiable<R, N> for Rejoined<S> {
    fn jacobian(&self, t: R, state: &[R; N]) -> [[R; N]; N] {
        self.0.jacobian(t, state)
    }

    fn along(&self, t: R, state: &[R; N], dt: R, dx: &[R; N]) -> [R; N] {
        self.0.along(t, state, dt, dx)
    }
}

impl<R: Real, S: Carrying<R, N> + Monitored<R, N>, const N: usize> Monitored<R, N> for Rejoined<S> {
    fn energy(&self, t: R, state: &[R; N]) -> R {
        self.0.energy(t, state)
    }

    fn residual(&self, t: R, state: &[R; N]) -> R {
        self.0.residual(t, state)
    }
}
