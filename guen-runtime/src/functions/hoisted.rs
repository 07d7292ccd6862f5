//! The values and functions that a prepared system keeps beside its constants where the program supplies functions.

use core::ops::Deref;

use crate::numbers::real::Real;
use crate::numbers::running_error::{RunningError, rounded};

/// The values that depend on constants alone, and the functions that the program supplies.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hoisted<R, const N: usize, F> {
    /// The values.
    pub values: [R; N],
    /// The functions, in a tuple.
    pub functions: F,
}

impl<R, const N: usize, F> Deref for Hoisted<R, N, F> {
    type Target = [R; N];

    #[inline(always)]
    fn deref(&self) -> &[R; N] {
        &self.values
    }
}

impl<R, const N: usize, F> Hoisted<R, N, F> {
    /// Maps the values, as `map` of an array does, and keeps the functions.
    #[inline]
    pub fn map<S>(self, function: impl FnMut(R) -> S) -> Hoisted<S, N, F> {
        Hoisted { values: self.values.map(function), functions: self.functions }
    }
}

/// Values that were prepared, as numbers that were rounded once.
#[doc(hidden)]
pub trait PreparedValues {
    /// The values with their errors.
    type Rounded;

    /// The values, each rounded once.
    fn rounded_once(&self) -> Self::Rounded;
}

impl<R: Real, const N: usize> PreparedValues for [R; N] {
    type Rounded = [RunningError<R>; N];

    #[inline]
    fn rounded_once(&self) -> Self::Rounded {
        rounded(self)
    }
}

impl<R: Real, const N: usize, F: Copy> PreparedValues for Hoisted<R, N, F> {
    type Rounded = Hoisted<RunningError<R>, N, F>;

    #[inline]
    fn rounded_once(&self) -> Self::Rounded {
        Hoisted { values: rounded(&self.values), functions: self.functions }
    }
}
