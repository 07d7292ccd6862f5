//! Laws for inputs: what they are at a time and state.

use core::marker::PhantomData;

use crate::numbers::real::Real;
use crate::system::actuated::{Actuated, StateOf};
#[cfg(feature = "alloc")]
use alloc::vec::Vec;

/// A prepared system with inputs, as a family over every real: its states and its inputs, with named fields. Generated systems
/// are; [`InputLaw`] has an example.
pub trait InputRecords {
    /// A state over another real.
    type StateOver<R: Real>;

    /// The inputs over another real.
    type InputsOver<R: Real>;
}

/// A law for the inputs of the prepared system `P` that is written for every real, so that methods and analyses which need its
/// derivatives can have them: for [`Actuated::with_law`](crate::Actuated::with_law).
///
/// For a generated system `cart` it is `impl InputLaw<cart::Prepared> for Spring`, and its function is
/// `fn at<R: Real>(&self, t: R, state: &cart::State<R>) -> cart::Inputs<R>`.
///
/// ```
/// use guen_runtime::{InputLaw, InputRecords, Real};
///
/// /// What the macro generates.
/// struct Prepared;
/// struct State<R> { x: R, v: R }
/// struct Inputs<R> { force: R }
/// impl InputRecords for Prepared {
///     type StateOver<R: Real> = State<R>;
///     type InputsOver<R: Real> = Inputs<R>;
/// }
///
/// struct Spring { stiffness: f64, damping: f64 }
/// impl InputLaw<Prepared> for Spring {
///     fn at<R: Real>(&self, _t: R, state: &State<R>) -> Inputs<R> {
///         let [stiffness, damping] = [self.stiffness, self.damping].map(R::from_f64);
///         Inputs { force: -stiffness * state.x - damping * state.v }
///     }
/// }
/// assert_eq!(Spring { stiffness: 2.0, damping: 1.0 }.at(0.0, &State { x: 3.0, v: 0.5 }).force, -6.5);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no law for the inputs of `{P}`",
    note = "it is written for every real: `fn at<R: Real>(&self, t: R, state: &State<R>) -> Inputs<R>`",
    note = "a closure is for one real: `.with_inputs(|t, state| ..)`"
)]
pub trait InputLaw<P: InputRecords> {
    /// The inputs at a time and state.
    fn at<R: Real>(&self, t: R, state: &P::StateOver<R>) -> P::InputsOver<R>;
}

impl<P: InputRecords, L: InputLaw<P> + ?Sized> InputLaw<P> for &L {
    fn at<R: Real>(&self, t: R, state: &P::StateOver<R>) -> P::InputsOver<R> {
        (**self).at(t, state)
    }
}

/// The inputs of the system `S` as values over one real, at a time and a state: a closure, an [`InputLaw`] in [`SmoothLaw`], or
/// what a controller has held.
pub trait InputValues<S: Actuated<R, N>, R: Real, const N: usize> {
    /// The inputs at a time and state.
    fn values(&self, t: R, state: &StateOf<S, R, N>) -> S::Inputs;
}

impl<F, S, R, const N: usize> InputValues<S, R, N> for F
where
    F: Fn(R, &StateOf<S, R, N>) -> S::Inputs,
    S: Actuated<R, N>,
    R: Real,
{
    #[inline]
    fn values(&self, t: R, state: &StateOf<S, R, N>) -> S::Inputs {
        self(t, state)
    }
}

/// An [`InputLaw`] of the system `P` with `M` inputs.
#[derive(Debug)]
pub struct SmoothLaw<L, P, const M: usize> {
    pub(crate) law: L,
    system: PhantomData<fn() -> P>,
}

impl<L, P, const M: usize> SmoothLaw<L, P, M> {
    pub(crate) fn new(law: L) -> Self {
        Self { law, system: PhantomData }
    }
}

impl<L: Clone, P, const M: usize> Clone for SmoothLaw<L, P, M> {
    fn clone(&self) -> Self {
        Self::new(self.law.clone())
    }
}

impl<L: Copy, P, const M: usize> Copy for SmoothLaw<L, P, M> {}

impl<L, S, R, const N: usize, const M: usize> InputValues<S, R, N> for SmoothLaw<L, S, M>
where
    L: InputLaw<S>,
    S: Actuated<R, N> + InputRecords<StateOver<R> = StateOf<S, R, N>, InputsOver<R> = S::Inputs>,
    R: Real,
{
    #[inline]
    fn values(&self, t: R, state: &StateOf<S, R, N>) -> S::Inputs {
        self.law.at(t, state)
    }
}

/// The inputs that a controller has held, each from its time on.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, PartialEq)]
pub struct InputSamples<R, U> {
    samples: Vec<(R, U)>,
}

#[cfg(feature = "alloc")]
impl<R, U> InputSamples<R, U> {
    pub(crate) fn new() -> Self {
        Self { samples: Vec::new() }
    }

    pub(crate) fn of(samples: Vec<(R, U)>) -> Self {
        Self { samples }
    }

    /// The times of the samples with the inputs that were held from there on.
    pub fn as_slice(&self) -> &[(R, U)] {
        &self.samples
    }
}

#[cfg(feature = "alloc")]
impl<S: Actuated<R, N>, R: Real, const N: usize> InputValues<S, R, N> for InputSamples<R, S::Inputs> {
    /// The inputs of the last sample at this time or before; before the first one those of the first.
    fn values(&self, t: R, _state: &StateOf<S, R, N>) -> S::Inputs {
        let next = self.samples.partition_point(|(time, _)| (*time - t).to_f64() <= 0.0);
        let place = next.saturating_sub(1);
        self.samples.get(place).map_or_else(S::Inputs::default, |(_, inputs)| *inputs)
    }
}
