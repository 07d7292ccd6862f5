//! A system over `f64` made anew over a shorter or longer real.

use super::derivatives::differentiable::{Equations, Generic};
use crate::numbers::real::Real;
use crate::system::System;
use crate::system::constants_error::ConstantsError;

/// A system of `N` equations that can be made anew over every real: what a study of the trade of speed for accuracy
/// takes, because it runs one system over several reals and has its reference computed over a long one.
///
/// The constants are those doubles that the system has, exactly; whatever depends on them alone is computed again in the
/// other real, not converted. So a run over a longer real solves the same problem with more digits, and a run over a
/// shorter one has the error of rounding the constants in its result.
///
/// The constants of a generated system implement it, and so does the prepared system, with its inputs held
/// (`Driven`) where it has inputs. A right-hand side written by hand is one through [`generic`](crate::generic).
///
/// ```
/// use guen_runtime::{Equations, Real, WithScalar, System, generic};
///
/// #[derive(Clone)]
/// struct Decay;
/// impl Equations<1> for Decay {
///     fn rates<R: Real>(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
///         [-x]
///     }
/// }
/// let short = generic(Decay).with_scalar::<f32>()?;
/// assert_eq!(short.rhs(0.0_f32, &[2.0]), [-2.0]);
/// # Ok::<(), guen_runtime::ConstantsError>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be made anew over another real, as a system of {N} equations",
    note = "the constants of a generated system can, and so can a prepared one; one with inputs through `driven(..)`; a right-hand side written for every real as `Equations` through `generic(..)`"
)]
pub trait WithScalar<const N: usize> {
    /// The system over the real `R`.
    type Over<R: Real>: System<R, N> + 'static;

    /// Makes the system over the real `R`.
    ///
    /// # Errors
    ///
    /// Those of `prepare` over that real: a constant may be finite as a double and not in a shorter real.
    fn with_scalar<R: Real>(&self) -> Result<Self::Over<R>, ConstantsError>;
}

impl<E: Equations<N> + Clone + 'static, const N: usize> WithScalar<N> for Generic<E> {
    type Over<R: Real> = Generic<E>;

    fn with_scalar<R: Real>(&self) -> Result<Generic<E>, ConstantsError> {
        Ok(self.clone())
    }
}

impl<S: WithScalar<N>, const N: usize> WithScalar<N> for &S {
    type Over<R: Real> = S::Over<R>;

    fn with_scalar<R: Real>(&self) -> Result<S::Over<R>, ConstantsError> {
        (**self).with_scalar()
    }
}
