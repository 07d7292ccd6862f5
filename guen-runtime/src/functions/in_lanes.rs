//! A function for each lane.

use core::array::from_fn;
use core::cell::Cell;

use crate::functions::smooth::Smooth;
use crate::numbers::real::Real;

/// The most lanes.
const LANES: usize = 8;

/// A function for each lane of a system in lanes.
///
/// Where all lanes have the same function it is evaluated once. Otherwise each is evaluated in all lanes, and every lane takes
/// its own value.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EachLane<F> {
    functions: [F; LANES],
    /// The number of lanes, or one where all have the same function.
    count: usize,
}

impl<F: Copy> EachLane<F> {
    /// The functions of so many lanes.
    pub fn gathered<const N: usize>(count: usize, of: impl Fn(usize) -> F) -> Self
    where
        F: Smooth<N>,
    {
        let first = of(0);
        let functions = from_fn(|lane| if lane < count { of(lane) } else { first });
        let is_one = functions.iter().all(|function| first.is_same(function));
        EachLane { functions, count: if is_one { 1 } else { count.min(LANES) } }
    }
}

impl<F: Smooth<N>, const N: usize> Smooth<N> for EachLane<F> {
    #[inline]
    fn value<R: Real>(&self, arguments: [R; N]) -> R {
        let mut value = self.functions[0].value(arguments);
        if self.count == 1 {
            return value;
        }
        // The number of each lane, as a constant of the real.
        let next = Cell::new(0.0);
        let lane = R::each_alone(|_| next.replace(next.get() + 1.0));
        for (number, function) in self.functions[..self.count].iter().enumerate().skip(1) {
            let before = R::from_f64(number as f64 - 0.5);
            value = lane.where_above(before, function.value(arguments), value);
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{LaneTask, Lanes, Width, dispatch};

    const SLOPES: [f64; 8] = [1.0, -2.0, 0.5, 4.0, 7.0, 8.0, 9.0, -1.0];

    /// The values of a constant function for each lane.
    struct Values;

    impl LaneTask for Values {
        type Output = [f64; 4];

        fn run<L: Lanes>(self) -> [f64; 4] {
            let functions = EachLane::gathered::<1>(L::COUNT, |lane| SLOPES[lane]);
            let value = functions.value([L::from_fn(|lane| lane as f64)]);
            [0, 1, 2, 3].map(|lane| value.lane(lane))
        }
    }

    #[test]
    fn every_lane_has_the_value_of_its_own_function() {
        assert_eq!(dispatch(Width::Four, Values), SLOPES[..4]);
        let one = EachLane::gathered::<1>(4, |_| 3.0);
        assert_eq!((one.count, one.value([0.0])), (1, 3.0));
    }
}
