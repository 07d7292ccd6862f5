//! A function with its partial derivatives up to an order, by one evaluation in dual numbers over dual numbers.

use core::array::from_fn;

use crate::functions::smooth::Smooth;
use crate::numbers::dual::Dual;
use crate::numbers::real::Real;

/// The value.
#[doc(hidden)]
#[inline]
pub fn derivatives_0<F: Smooth<N>, R: Real, const N: usize>(function: &F, x: [R; N]) -> R {
    function.value(x)
}

/// The value and the first derivatives.
#[doc(hidden)]
#[inline]
pub fn derivatives_1<F: Smooth<N>, R: Real, const N: usize>(function: &F, x: [R; N]) -> Dual<R, N> {
    derivatives_0(function, from_fn(|i| Dual::variable(x[i], i)))
}

/// The derivatives up to the second: `tangent[i].tangent[j]` is the one by the arguments `i` and `j`.
#[doc(hidden)]
#[inline]
pub fn derivatives_2<F: Smooth<N>, R: Real, const N: usize>(function: &F, x: [R; N]) -> Dual<Dual<R, N>, N> {
    derivatives_1(function, from_fn(|i| Dual::variable(x[i], i)))
}

/// The derivatives up to the third.
#[doc(hidden)]
#[inline]
pub fn derivatives_3<F: Smooth<N>, R: Real, const N: usize>(
    function: &F,
    x: [R; N],
) -> Dual<Dual<Dual<R, N>, N>, N> {
    derivatives_2(function, from_fn(|i| Dual::variable(x[i], i)))
}

/// The derivatives up to the fourth.
#[doc(hidden)]
#[inline]
pub fn derivatives_4<F: Smooth<N>, R: Real, const N: usize>(
    function: &F,
    x: [R; N],
) -> Dual<Dual<Dual<Dual<R, N>, N>, N>, N> {
    derivatives_3(function, from_fn(|i| Dual::variable(x[i], i)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x^3 y^2`
    #[derive(Clone, Copy)]
    struct Monomial;

    impl Smooth<2> for Monomial {
        fn value<R: Real>(&self, [x, y]: [R; 2]) -> R {
            x * x * x * y * y
        }
    }

    #[test]
    fn tangents_are_the_partial_derivatives() {
        let (x, y) = (1.5_f64, -0.5_f64);
        let at = [x, y];
        assert_eq!(derivatives_1(&Monomial, at).tangent, [3.0 * x * x * y * y, 2.0 * x * x * x * y]);
        let third = derivatives_3(&Monomial, at);
        assert_eq!(third.value.value.value, x * x * x * y * y);
        assert_eq!(third.value.tangent[0].tangent[1], 6.0 * x * x * y);
        assert_eq!(third.tangent[0].tangent[0].tangent[1], 12.0 * x * y);
        assert_eq!(third.tangent[1].tangent[1].tangent[1], 0.0);
        let fourth = derivatives_4(&Monomial, at);
        assert_eq!(fourth.tangent[0].tangent[0].tangent[1].tangent[1], 12.0 * x);
    }
}
