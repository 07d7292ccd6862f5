//! Choices between reals by their sizes: functions that follow from [`Real::where_above`] and [`Real::each_alone`], the same for every real.

use core::cell::Cell;

use crate::numbers::real::Real;

/// Returns `above` where the condition is at least zero, `below` where it is less, and NaN where it is NaN; in every lane by itself.
///
/// ```
/// use guen_runtime::select;
/// assert_eq!([1.0, 0.0, -1.0].map(|c: f64| select(c, 10.0, 20.0)), [10.0, 10.0, 20.0]);
/// assert!(select(f64::NAN, 10.0, 20.0).is_nan());
/// ```
#[inline(always)]
pub fn select<R: Real>(condition: R, above: R, below: R) -> R {
    let at_most_zero = condition.where_above(R::zero(), condition, below);
    (-condition).where_above(R::zero(), at_most_zero, above)
}

/// Returns the smaller of two numbers; NaN where one of them is, which `f64::min` ignores.
///
/// ```
/// use guen_runtime::minimum;
/// assert_eq!(minimum(2.0, 1.0), 1.0);
/// assert!(minimum(f64::NAN, 1.0).is_nan() && minimum(1.0, f64::NAN).is_nan());
/// ```
#[inline(always)]
pub fn minimum<R: Real>(a: R, b: R) -> R {
    a.where_above(b, b.where_above(a, a + b, b), a)
}

/// Returns the larger of two numbers; NaN where one of them is, which `f64::max` ignores.
///
/// ```
/// use guen_runtime::maximum;
/// assert_eq!(maximum(2.0, 1.0), 2.0);
/// assert!(maximum(f64::NAN, 1.0).is_nan() && maximum(1.0, f64::NAN).is_nan());
/// ```
#[inline(always)]
pub fn maximum<R: Real>(a: R, b: R) -> R {
    a.where_above(b, b.where_above(a, a + b, a), b)
}

/// Returns the largest of the numbers that a real consists of, as the nearest `f64`, and NaN if one of them is: of lanes that of all
/// lanes, of any other real [`to_f64`](Real::to_f64).
#[inline(always)]
pub(crate) fn most<R: Real>(x: R) -> f64 {
    let most = Cell::new(f64::NEG_INFINITY);
    R::each_alone(
        #[inline(always)]
        |alone| {
            let (x, before) = (alone(x), most.get());
            most.set(if x <= before || before.is_nan() { before } else { x });
            x
        },
    );
    most.get()
}

/// The largest absolute value, as a real without an order can have it: through `f64` for the comparison, of lanes in every
/// lane by itself. Zero for no values, not finite if one of them is not.
///
/// ```
/// assert_eq!(guen_runtime::checks::largest(&[1.0, -3.0, 2.0]), 3.0);
/// ```
#[inline(always)]
pub fn largest<R: Real>(values: &[R]) -> R {
    let (mut most, mut rest) = (R::zero(), R::zero());
    for value in values {
        let size = value.abs();
        most = size.where_above(most, size, most);
        // Zero, unless it is not finite: what is compared with NaN would be taken for larger.
        rest += size * R::zero();
    }
    most + rest
}

#[cfg(test)]
mod tests {
    use super::most;
    use crate::lanes::{LaneTask, Lanes, Width, dispatch};
    use crate::{Dual, RunningError};

    /// The most of lanes of which the third may be another.
    struct Third(f64);
    impl LaneTask for Third {
        type Output = f64;
        fn run<L: Lanes>(self) -> f64 {
            most(L::from_fn(|lane| if lane == 2 { self.0 } else { -1.0 }))
        }
    }

    #[test]
    fn the_most_of_all_lanes() {
        for width in [Width::Four, Width::Eight] {
            assert_eq!(
                [-2.0, 7.0, f64::INFINITY].map(|x| dispatch(width, Third(x))),
                [-1.0, 7.0, f64::INFINITY]
            );
            assert!(dispatch(width, Third(f64::NAN)).is_nan());
        }
        assert_eq!((most(2.5), most(f64::NEG_INFINITY)), (2.5, f64::NEG_INFINITY));
        assert_eq!((most(Dual::<f64, 1>::variable(3.0, 0)), most(RunningError::once(-4.0))), (3.0, -4.0));
    }
}
