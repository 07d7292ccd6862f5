//! Operators of displacement: vector fields over time and coordinates, and how they act on functions.
//!
//! A generated system supplies coefficients; everything that follows from them, applying an operator exactly and
//! nesting operators, is here. The derivative is taken by evaluating the function in duals, so it is that of the
//! function as written, to rounding.

use crate::numbers::dual::Dual;
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// A function `f(t, x)` of time and `N` coordinates, written once for every real over `B`.
///
/// `B` is the real that the system was prepared in. A function that needs no prepared constants ignores it: its
/// `at` may ask for `R: Real` alone, and it may implement the trait for all `B` at once.
///
/// ```
/// use guen_runtime::{Function, Real};
///
/// struct Height;
/// impl<B> Function<2, B> for Height {
///     fn at<R: Real>(&self, _t: R, x: &[R; 2]) -> R {
///         x[0].sin() * x[1]
///     }
/// }
/// assert_eq!(Function::<2>::at(&Height, 0.0, &[0.0, 3.0]), 0.0);
/// ```
pub trait Function<const N: usize, B = f64> {
    /// The value at time `t` and position `x`.
    fn at<R: Real + Lift<B>>(&self, t: R, x: &[R; N]) -> R;
}

impl<B, F: Function<N, B> + ?Sized, const N: usize> Function<N, B> for &F {
    #[inline]
    fn at<R: Real + Lift<B>>(&self, t: R, x: &[R; N]) -> R {
        (**self).at(t, x)
    }
}

/// The coordinate with index `I`, as a function of the position.
///
/// An operator applied to it gives the operator's own coefficient: `X(x_I) = xi^I`. An index beyond the
/// coordinates does not compile:
///
/// ```compile_fail
/// # use guen_runtime::{Coordinate, Function};
/// let beyond = Function::<2>::at(&Coordinate::<2>, 0.0, &[1.0, 2.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coordinate<const I: usize>;

impl<B, const N: usize, const I: usize> Function<N, B> for Coordinate<I> {
    #[inline]
    fn at<R: Real + Lift<B>>(&self, _t: R, x: &[R; N]) -> R {
        const { assert!(I < N, "there is no coordinate with this index") };
        x[I]
    }
}

/// An operator of displacement over time and `N` coordinates.
///
/// ```text
/// X f = tau df/dt + sum_i xi^i(t, x) df/dx_i        tau = 1 if TIME, else 0
/// ```
///
/// - `B`: the real in which the constants were prepared; `R`: the real of the evaluation, `B` itself or duals
///   over it, into which `coefficients` lifts the constants.
/// - `X_0`, the operator of what happens by itself, contains `d/dt`; `X_1 .. X_n`, one for each parameter and
///   constraint form, do not.
///
/// Operators are zero-sized names; their data is in `Prepared`. They nest, because an applied operator is a
/// function again:
///
/// ```
/// use guen_runtime::{Coordinate, Lift, Operator, Real};
///
/// /// The rotation `x d/dy - y d/dx`.
/// #[derive(Clone, Copy)]
/// struct Turn;
/// impl<B: Real> Operator<B, 2> for Turn {
///     type Prepared = ();
///     const TIME: bool = false;
///     fn coefficients<R: Real + Lift<B>>(_: &(), _t: R, x: &[R; 2]) -> [R; 2] {
///         [-x[1], x[0]]
///     }
/// }
///
/// let x = [3.0, 4.0];
/// let abscissa = Coordinate::<0>;
/// assert_eq!(Turn.apply(&(), &abscissa, 0.0, &x), -4.0);
/// // X (X x) = -x
/// let once = Operator::<f64, 2>::of(Turn, &(), abscissa);
/// assert_eq!(Turn.apply(&(), &once, 0.0, &x), -3.0);
/// ```
pub trait Operator<B: Real, const N: usize>: Copy {
    /// The system's prepared constants, of base `B`.
    type Prepared;

    /// Whether the operator contains `d/dt`.
    const TIME: bool;

    /// The coefficients `xi^1 .. xi^N` at time `t` and position `x`.
    fn coefficients<R: Real + Lift<B>>(prepared: &Self::Prepared, t: R, x: &[R; N]) -> [R; N];

    /// The value of `X f` at time `t` and position `x`.
    ///
    /// It is the tangent of `f(t + tau e, x + xi e)` at `e = 0`: one evaluation of the coefficients in `R` and
    /// one of `f` in duals with a single direction, so about twice the cost of `f` for each level of nesting.
    #[inline]
    fn apply<R, F>(self, prepared: &Self::Prepared, function: &F, t: R, x: &[R; N]) -> R
    where
        R: Real + Lift<B>,
        F: Function<N, B> + ?Sized,
    {
        let xi = Self::coefficients(prepared, t, x);
        let moved = core::array::from_fn(|i| Dual { value: x[i], tangent: [xi[i]] });
        let tau = if Self::TIME { R::one() } else { R::zero() };
        let [derivative] = function.at(Dual { value: t, tangent: [tau] }, &moved).tangent;
        derivative
    }

    /// The function `X f`, to be evaluated or to be given to a further operator. Takes a function or a reference
    /// to one.
    #[inline]
    fn of<F: Function<N, B>>(
        self,
        prepared: &Self::Prepared,
        function: F,
    ) -> Applied<'_, Self, Self::Prepared, F> {
        Applied { operator: self, prepared, function }
    }
}

/// An operator applied to a function: the [`Function`] `X f` that [`Operator::of`] returns.
#[derive(Debug)]
pub struct Applied<'a, O, P, F> {
    operator: O,
    prepared: &'a P,
    function: F,
}

// Derived, these would ask for `P: Copy`, though only a reference to it is held.
impl<O: Copy, P, F: Copy> Copy for Applied<'_, O, P, F> {}

impl<O: Copy, P, F: Copy> Clone for Applied<'_, O, P, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<B, O, P, F, const N: usize> Function<N, B> for Applied<'_, O, P, F>
where
    B: Real,
    O: Operator<B, N, Prepared = P>,
    F: Function<N, B>,
{
    #[inline]
    fn at<R: Real + Lift<B>>(&self, t: R, x: &[R; N]) -> R {
        self.operator.apply(self.prepared, &self.function, t, x)
    }
}
