//! The derivatives of a right-hand side that implicit methods need, and two ways to them: emitted, or by duals.

use super::linearization::seeded;
use crate::numbers::dual::Dual;
use crate::numbers::real::Real;
use crate::system::System;
use crate::system::forward::forward;

/// A system that knows the derivatives of its right-hand side.
///
/// ```text
/// J_ij = d f_i / d x_j        along(tau, v) = f_t tau + J v
/// ```
///
/// Prepared systems implement it where their real lifts into duals; where `linearize` is code of its own, `jacobian` is its `a`. A right-hand side written by hand is one
/// through [`generic`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` offers no derivatives of its right-hand side",
    note = "implicit methods need them; write the right-hand side for every real as `Equations` and pass `generic(..)`",
    note = "inputs that are a closure have no derivatives; write them for every real as an `InputLaw` and pass them to `.with_law(..)`",
    note = "constants are prepared before, with `.prepare()?`; a prepared system with inputs gets them by `.with_law(..)` or `.driven(..)`"
)]
pub trait Differentiable<R: Real, const N: usize>: System<R, N> {
    /// The Jacobian by the state at time `t`: row `i` holds the derivatives of rate `i`.
    fn jacobian(&self, t: R, state: &[R; N]) -> [[R; N]; N];

    /// The derivative of the rates when time changes at the rate `dt` and the state at the rates `dx`. With `dt = 1`
    /// and `dx = f` these are the second derivatives of the motion.
    fn along(&self, t: R, state: &[R; N], dt: R, dx: &[R; N]) -> [R; N];
}

impl<R: Real, S: Differentiable<R, N> + ?Sized, const N: usize> Differentiable<R, N> for &S {
    forward!(self -> (**self); Differentiable<R, N>);
}

/// A right-hand side written once for every real.
///
/// ```
/// use guen_runtime::{Differentiable, Equations, Real, System, generic};
///
/// struct Pendulum {
///     length: f64,
/// }
///
/// impl Equations<2> for Pendulum {
///     fn rates<R: Real>(&self, _t: R, &[angle, speed]: &[R; 2]) -> [R; 2] {
///         [speed, -R::from_f64(9.81 / self.length) * angle.sin()]
///     }
/// }
///
/// let pendulum = generic(Pendulum { length: 9.81 });
/// assert_eq!(pendulum.rhs(0.0, &[0.0, 2.0]), [2.0, 0.0]);
/// assert_eq!(pendulum.jacobian(0.0, &[0.0, 2.0]), [[0.0, 1.0], [-1.0, 0.0]]);
/// ```
pub trait Equations<const N: usize> {
    /// The rate of change of the state at time `t`.
    fn rates<R: Real>(&self, t: R, state: &[R; N]) -> [R; N];
}

/// A system over every real, made of [`Equations`]: see [`generic`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Generic<E>(E);

/// The system of these equations, over every real and with derivatives by dual numbers: a Jacobian costs a little more
/// than `N` right-hand sides.
pub fn generic<E: Equations<N>, const N: usize>(equations: E) -> Generic<E> {
    Generic(equations)
}

impl<R: Real, E: Equations<N>, const N: usize> System<R, N> for Generic<E> {
    #[inline]
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N] {
        self.0.rates(t, state)
    }
}

impl<R: Real, E: Equations<N>, const N: usize> Differentiable<R, N> for Generic<E> {
    fn jacobian(&self, t: R, state: &[R; N]) -> [[R; N]; N] {
        self.0.rates(Dual::constant(t), &seeded(state)).map(|rate| rate.tangent)
    }

    fn along(&self, t: R, state: &[R; N], dt: R, dx: &[R; N]) -> [R; N] {
        let time = Dual { value: t, tangent: [dt] };
        let state = core::array::from_fn(|i| Dual { value: state[i], tangent: [dx[i]] });
        self.0.rates(time, &state).map(|rate| rate.tangent[0])
    }
}
