//! Steps from a base real into a real that was built over it.
//!
//! Prepared constants exist once, in the real that the system was prepared in. A derivative evaluates the same
//! program in duals over that real, and needs the constants there. [`Lift`] is that embedding, and nothing else.

use crate::numbers::dual::Dual;
use crate::numbers::real::Real;

/// Embeds the reals of `B` into a real built over them; what was a number becomes a constant.
///
/// `f32` and `f64` lift into themselves, and `Dual<R, N>` takes whatever `R` takes, so constants of base `B`
/// reach any depth of nesting. There is deliberately no lift from `f64` into a longer real: constants that were
/// rounded once stay rounded, and that should be seen where it happens ([`Real::from_f64`]).
///
/// A new scalar `T` writes `impl Lift<T> for T`.
///
/// ```
/// use guen_runtime::{Dual, Lift};
/// let deep: Dual<Dual<f64, 1>, 2> = Lift::lift(2.5_f64);
/// assert_eq!(deep.value.value, 2.5);
/// assert_eq!(deep.tangent[1].value, 0.0);
/// ```
#[diagnostic::on_unimplemented(
    message = "a real of type `{B}` cannot be embedded into `{Self}`",
    note = "constants prepared in `{B}` serve evaluations in `{B}` and in duals over `{B}`"
)]
pub trait Lift<B>: Real {
    /// The constant `base`.
    fn lift(base: B) -> Self;
}

// Not `impl<R: Real> Lift<R> for R`: it would overlap the impl for duals.
macro_rules! lift_into_itself {
    ($($real:ty),*) => {
        $(impl Lift<$real> for $real {
            #[inline]
            fn lift(base: $real) -> $real {
                base
            }
        })*
    };
}

lift_into_itself!(f32, f64);

impl<B, R: Lift<B>, const N: usize> Lift<B> for Dual<R, N> {
    #[inline]
    fn lift(base: B) -> Self {
        Dual::constant(R::lift(base))
    }
}
