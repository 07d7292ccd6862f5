//! The inputs of a system over one real: by a closure, by a law for every real, or as a controller has held them.

use super::actuated::{Actuated, StateOf};
use super::input_law::{InputLaw, InputRecords, SmoothLaw};
use crate::numbers::real::Real;
#[cfg(feature = "alloc")]
use alloc::vec::Vec;

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
