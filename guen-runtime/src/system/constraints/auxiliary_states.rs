//! Systems that carry elementary functions as states, and keeping these on their relations.

use super::positions_error::PositionsError;
use crate::numbers::real::Real;
use crate::system::derivatives::differentiable::Differentiable;
use crate::system::forward::forward;
use crate::system::{Monitored, System};

/// A system with elementary functions among its states, such as the sine and the cosine of an angle. The carried form of
/// a generated system is one: see `provide carried;` in the language reference.
pub trait AuxiliaryStates<R: Real, const N: usize>: System<R, N> {
    /// Moves the carried functions closer to the relations among them, without an elementary call: a pair of sine and
    /// cosine onto the circle, a root and a hyperbolic cosine by a step of Newton's method. What has no relation stays.
    /// The phase of a sine is not mended by this; to compute all functions anew is `carry`.
    ///
    /// ```text
    /// (s, c) -> (3 - s^2 - c^2)/2 (s, c)
    /// ```
    fn renormalize(&self, t: R, state: &mut [R; N]);
}

impl<R: Real, S: AuxiliaryStates<R, N> + ?Sized, const N: usize> AuxiliaryStates<R, N> for &S {
    #[inline]
    fn renormalize(&self, t: R, state: &mut [R; N]) {
        (**self).renormalize(t, state);
    }
}

/// A system whose carried functions are put back onto their relations after every step: see [`renormalized`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Renormalized<S>(S);

/// The system, with [`AuxiliaryStates::renormalize`] after every accepted step of a stepper. Costs four multiplications and three
/// additions for a sine with its cosine in every step, and a further evaluation where the method would have used the slope
/// at the end of the step again.
///
/// ```
/// use guen_runtime::prelude::*;
/// use guen_runtime::{AuxiliaryStates, renormalized};
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
/// impl AuxiliaryStates<f64, 2> for Clock {
///     fn renormalize(&self, _t: f64, state: &mut [f64; 2]) {
///         let factor = (3.0 - state[0] * state[0] - state[1] * state[1]) / 2.0;
///         *state = state.map(|x| x * factor);
///     }
/// }
///
/// let run = |end: IntegrationResult<f64, 2>| (end.state[0].powi(2) + end.state[1].powi(2) - 1.0).abs();
/// let go_on = |_: f64, _: &[f64; 2]| ControlFlow::Continue(());
/// let free = Rk4::new(0.1).integrate(&Clock, 0.0, &[0.0, 1.0], 100.0, go_on).unwrap();
/// let held = Rk4::new(0.1).integrate(&renormalized(Clock), 0.0, &[0.0, 1.0], 100.0, go_on).unwrap();
/// assert!(run(free) > 1e-6 && run(held) < 1e-13);
/// ```
pub fn renormalized<S>(system: S) -> Renormalized<S> {
    Renormalized(system)
}

impl<R: Real, S: AuxiliaryStates<R, N>, const N: usize> System<R, N> for Renormalized<S> {
    forward!(self -> self.0; System<R, N>, guarded);

    #[inline]
    fn restore(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError> {
        self.0.renormalize(t, state);
        self.0.restore(t, state)
    }
}

impl<R: Real, S: AuxiliaryStates<R, N> + Differentiable<R, N>, const N: usize> Differentiable<R, N>
    for Renormalized<S>
{
    forward!(self -> self.0; Differentiable<R, N>);
}

impl<R: Real, S: AuxiliaryStates<R, N> + Monitored<R, N>, const N: usize> Monitored<R, N>
    for Renormalized<S>
{
    forward!(self -> self.0; Monitored<R, N>);
}
