//! The trait of functions that the program supplies.

use crate::numbers::real::Real;

/// A smooth function of `N` scalars that a program supplies to a generated system: one method over every real.
///
/// Derivatives are those of the method, by dual numbers, to the order that the equations of motion need. So it has to be as
/// smooth as that: twice differentiable where it stands in a constraint or in a position, once in an energy, and not at all in a
/// force. A branch on the value of an argument is written by [`select`](crate::select), [`minimum`](crate::minimum) and [`maximum`](crate::maximum).
///
/// A number is a constant function, [`Table`](crate::Table) and [`Grid`](crate::Grid) interpolate, and what a
/// `&'static` reference leads to is a function too.
///
/// ```
/// use guen_runtime::{Real, Smooth};
///
/// /// A hill of height `h`.
/// #[derive(Clone, Copy)]
/// struct Hill {
///     h: f64,
/// }
///
/// impl Smooth<2> for Hill {
///     fn value<R: Real>(&self, [x, y]: [R; 2]) -> R {
///         R::from_f64(self.h) * (-(x * x + y * y)).exp()
///     }
/// }
///
/// assert_eq!(Hill { h: 2.0 }.value([0.0, 0.0]), 2.0);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no smooth function of {N} arguments",
    label = "not `Smooth<{N}>`",
    note = "a `Table` is a function of one argument, a `Grid` of two, a number of any; a struct of one's own implements `guen::Smooth<{N}>` by `fn value<R: Real>(&self, arguments: [R; {N}]) -> R`",
    note = "a closure has one real and no derivatives: make it a struct with its constants as fields"
)]
pub trait Smooth<const N: usize>: Copy + 'static {
    /// The value at these arguments.
    fn value<R: Real>(&self, arguments: [R; N]) -> R;

    /// Whether both are known to be one function. Where all lanes have the same one, it is evaluated once for all of them.
    ///
    /// ```
    /// use guen_runtime::Smooth;
    /// assert!(Smooth::<1>::is_same(&2.0, &2.0) && !Smooth::<1>::is_same(&2.0, &3.0));
    /// ```
    #[inline]
    fn is_same(&self, other: &Self) -> bool {
        let _ = other;
        core::mem::size_of::<Self>() == 0
    }
}

/// A constant function.
impl<const N: usize> Smooth<N> for f64 {
    #[inline]
    fn value<R: Real>(&self, _arguments: [R; N]) -> R {
        R::from_f64(*self)
    }

    #[inline]
    fn is_same(&self, other: &Self) -> bool {
        self.to_bits() == other.to_bits()
    }
}

/// The function that a reference leads to: large tables are not copied.
impl<F: Smooth<N>, const N: usize> Smooth<N> for &'static F {
    #[inline]
    fn value<R: Real>(&self, arguments: [R; N]) -> R {
        (**self).value(arguments)
    }

    #[inline]
    fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(*self, *other) || (**self).is_same(other)
    }
}
