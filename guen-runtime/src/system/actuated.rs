//! Systems with inputs, and laws that say what the inputs are.

use core::marker::PhantomData;

use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::system::invariants::Invariants;
use crate::system::positions_error::PositionsError;
use crate::system::simulate::Simulate;
use crate::system::{Monitored, System};

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
    /// Every method serves that needs rates alone: `Dop853`, `Tsit5`, `Rk8`, `Rk4`, `Euler`. Implicit ones and Taylor series
    /// would need derivatives of the law. Guards watch as they do with inputs held at the law's values. What is
    /// constant over a period of time is [`held`](Self::held), which generated systems call `driven`.
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
        F: Fn(R, &<Self::Driven as Simulate<R, N>>::State) -> Self::Inputs,
    {
        WithInputs { system: self, law, real: PhantomData }
    }
}

/// A system whose inputs are functions of time and state: see [`Actuated::with_inputs`].
#[derive(Clone, Copy, Debug)]
pub struct WithInputs<S, F, R, const N: usize> {
    system: S,
    law: F,
    real: PhantomData<R>,
}

impl<S, F, R, const N: usize> WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: Fn(R, &<S::Driven as Simulate<R, N>>::State) -> S::Inputs,
{
    /// The inputs at a time and state.
    pub fn inputs(&self, t: R, state: &<S::Driven as Simulate<R, N>>::State) -> S::Inputs {
        (self.law)(t, state)
    }

    /// The system with inputs held at what the law says at a time and state.
    #[inline]
    fn at(&self, t: R, state: &[R; N]) -> S::Driven {
        self.system.held((self.law)(t, &(*state).into()))
    }

    /// The system with whatever inputs, for what does not depend on them.
    #[inline]
    fn anywhere(&self) -> S::Driven {
        self.system.held(S::Inputs::default())
    }
}

impl<S, F, R, const N: usize> System<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: Fn(R, &<S::Driven as Simulate<R, N>>::State) -> S::Inputs,
{
    #[inline]
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N] {
        self.at(t, state).rhs(t, state)
    }

    fn restore(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError> {
        self.anywhere().restore(t, state)
    }

    fn conserved(&self, t: R, state: &[R; N]) -> Invariants<R> {
        self.at(t, state).conserved(t, state)
    }

    fn singularities(
        &self,
        t: RunningError<R>,
        state: &[RunningError<R>; N],
        values: &mut [RunningError<R>],
    ) -> usize {
        self.anywhere().singularities(t, state, values)
    }

    fn condition(&self, t: R, state: &[R; N]) -> R {
        self.anywhere().condition(t, state)
    }

    fn check_cost(&self) -> u32 {
        self.anywhere().check_cost()
    }

    fn singularity_check_cost(&self) -> f64 {
        self.anywhere().singularity_check_cost()
    }
}

impl<S, F, R, const N: usize> Monitored<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    S::Driven: Monitored<R, N>,
    F: Fn(R, &<S::Driven as Simulate<R, N>>::State) -> S::Inputs,
{
    fn energy(&self, t: R, state: &[R; N]) -> R {
        self.at(t, state).energy(t, state)
    }

    fn residual(&self, t: R, state: &[R; N]) -> R {
        self.anywhere().residual(t, state)
    }
}

impl<S, F, R, const N: usize> Simulate<R, N> for WithInputs<S, F, R, N>
where
    R: Real,
    S: Actuated<R, N>,
    F: Fn(R, &<S::Driven as Simulate<R, N>>::State) -> S::Inputs,
{
    type State = <S::Driven as Simulate<R, N>>::State;
    const STATES: &'static [&'static str] = S::Driven::STATES;
    const DOMAIN: &'static [&'static str] = S::Driven::DOMAIN;
}
