//! Systems with inputs: with values for them, or with a law, they can be integrated.

use core::marker::PhantomData;

use super::input_law::{InputLaw, InputRecords, SmoothLaw};
#[cfg(feature = "alloc")]
use crate::numbers::real::Ordered;
use crate::numbers::real::Real;
#[cfg(feature = "alloc")]
use crate::simulation::SimulationWithoutInputs;
use crate::system::derivatives::linearization::Liftable;
use crate::system::hints::Inputs;
use crate::system::simulate::Simulate;

/// A state of the system `S` with inputs.
pub(crate) type StateOf<S, R, const N: usize> = <<S as Actuated<R, N>>::Driven as Simulate<R, N>>::State;

/// A prepared system with inputs: with values for them it is something that steppers integrate. Generated systems are.
pub trait Actuated<R: Real, const N: usize> {
    /// The inputs, with named fields.
    type Inputs: Copy + Default;

    /// The system with inputs that are held.
    type Driven: Simulate<R, N>;

    /// The system with these inputs held.
    fn held(&self, inputs: Self::Inputs) -> Self::Driven;

    /// The system with inputs that are functions of time and state: `law` is evaluated in every right-hand side.
    ///
    /// A closure serves every method that needs rates alone: `Dop853`, `Tsit5`, `Rk8`, `Rk4`, `Euler`. Implicit ones need
    /// derivatives of the law: [`with_law`](Self::with_law). Guards watch as they do with inputs held at the law's values. What
    /// is constant over a period of time is [`held`](Self::held), which generated systems call `driven`.
    ///
    /// ```
    /// use guen_runtime::{Actuated, Simulate, System};
    ///
    /// /// A mass that is pushed.
    /// #[derive(Clone, Copy)]
    /// struct Cart;
    /// #[derive(Clone, Copy)]
    /// struct Pushed(f64);
    ///
    /// impl System<f64, 2> for Pushed {
    ///     fn rhs(&self, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
    ///         [v, self.0]
    ///     }
    /// }
    /// impl Simulate<f64, 2> for Pushed {
    ///     type State = [f64; 2];
    /// }
    /// impl Actuated<f64, 2> for Cart {
    ///     type Inputs = f64;
    ///     type Driven = Pushed;
    ///     fn held(&self, force: f64) -> Pushed {
    ///         Pushed(force)
    ///     }
    /// }
    ///
    /// // A spring by the law of a controller.
    /// let cart = Cart.with_inputs(|_t, &[x, _]: &[f64; 2]| -x);
    /// assert_eq!(cart.rhs(0.0, &[3.0, 4.0]), [4.0, -3.0]);
    /// ```
    fn with_inputs<F>(self, law: F) -> WithInputs<Self, F, R, N>
    where
        Self: Sized,
        F: Fn(R, &StateOf<Self, R, N>) -> Self::Inputs,
    {
        WithInputs::new(self, law)
    }

    /// The system with inputs by an [`InputLaw`], which is written for every real: `Radau5`, `Gauss4`, `Gauss6` and
    /// [`Linearizable`](crate::Linearizable) see its derivatives, and `Taylor` its series where the system provides one. One law serves every method.
    fn with_law<L, const M: usize>(self, law: L) -> WithInputs<Self, SmoothLaw<L, Self, M>, R, N>
    where
        Self: Sized + InputRecords + Liftable<R, N, M>,
        L: InputLaw<Self>,
    {
        WithInputs::new(self, SmoothLaw::new(law))
    }

    /// A simulation from a state, which first needs inputs: [`inputs`](SimulationWithoutInputs::inputs) that are functions of
    /// time and state, or those of a controller that [`hold`](SimulationWithoutInputs::hold)s them between its samples.
    #[cfg(feature = "alloc")]
    fn simulation(&self, start: &StateOf<Self, R, N>) -> SimulationWithoutInputs<Self, R, N>
    where
        R: Ordered,
        Self: Clone,
    {
        SimulationWithoutInputs::new(self.clone(), start)
    }

    /// Answers with the message of its bound: inputs come first.
    #[doc(hidden)]
    fn simulate<Start, Span, Motion>(&mut self, _: Start, _: Span) -> Motion
    where
        Self: Inputs,
    {
        self.never()
    }
}

/// A system whose inputs are functions of time and state: see [`Actuated::with_inputs`].
#[derive(Clone, Copy, Debug)]
pub struct WithInputs<S, F, R, const N: usize> {
    pub(crate) system: S,
    pub(crate) law: F,
    real: PhantomData<R>,
}

impl<S, F, R, const N: usize> WithInputs<S, F, R, N> {
    pub(crate) fn new(system: S, law: F) -> Self {
        Self { system, law, real: PhantomData }
    }

    /// The law.
    pub fn law(&self) -> &F {
        &self.law
    }
}
