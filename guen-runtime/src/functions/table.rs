//! A function of one argument through given points.

use crate::functions::error::TableError;
use crate::functions::knots::{check, check_finite, check_slopes, monotone, natural, piece};
use crate::functions::smooth::Smooth;
use crate::numbers::real::Real;

/// A smooth function of one argument through given points: a torque curve, a profile of a road, a law of resistance.
///
/// - [`new`](Self::new) makes the natural cubic spline, which is twice continuously differentiable. It may overshoot between points.
/// - [`monotone`](Self::monotone) makes a cubic curve that rises and falls only where the values do. Its second derivative
///   jumps at the points, so that it is better in forces than in constraints or positions.
///
/// Outside of the points both go on straight, with the slope at the end: value and slope are continuous there, and of the spline
/// the second derivative is, too. The argument NaN gives NaN.
///
/// A table holds up to `N` points in itself, 40 bytes each, and evaluation does not allocate. Over a longer real it is the polynomial
/// whose coefficients are these doubles. A large one is lent to a system as a `&'static` reference.
///
/// ```
/// use guen_runtime::{Smooth, Table};
///
/// let torque = Table::monotone([(0.0, 2.0), (100.0, 1.8), (200.0, 0.5), (250.0, 0.0)])?;
/// assert_eq!(torque.value([100.0]), 1.8);
/// // Behind the last point it goes on with the slope there.
/// let [end, further] = [250.0, 260.0].map(|speed| torque.value([speed]));
/// assert!(end == 0.0 && further < 0.0);
/// # Ok::<(), guen_runtime::TableError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table<const N: usize> {
    knots: [Knot; N],
    count: usize,
}

/// A point with the cubic polynomial behind it, in powers of the distance from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Knot {
    argument: f64,
    coefficients: [f64; 4],
}

impl<const N: usize> Table<N> {
    /// The natural cubic spline through points `(argument, value)`, arguments increasing.
    ///
    /// # Errors
    ///
    /// Fewer than two points, arguments that do not increase, a number that is not finite.
    ///
    /// ```
    /// use guen_runtime::{Smooth, Table};
    /// let ground = Table::new([(0.0, 0.0), (1.0, 0.3), (2.0, 0.1), (3.0, 0.4)])?;
    /// assert_eq!(ground.value([2.0]), 0.1);
    /// # Ok::<(), guen_runtime::TableError>(())
    /// ```
    pub fn new(points: [(f64, f64); N]) -> Result<Self, TableError> {
        Self::spline_through(&points)
    }

    /// A monotone cubic curve through points: between two of them it stays between their values.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new).
    ///
    /// ```
    /// use guen_runtime::{Smooth, Table};
    /// let step = Table::monotone([(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 1.0)])?;
    /// assert!((0..30).all(|i| (0.0..=1.0).contains(&step.value([0.1 * f64::from(i)]))));
    /// # Ok::<(), guen_runtime::TableError>(())
    /// ```
    pub fn monotone(points: [(f64, f64); N]) -> Result<Self, TableError> {
        Self::monotone_through(&points)
    }

    /// The natural cubic spline, as [`new`](Self::new), through points whose number the program finds out when it runs: at most `N`.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new); more points than the table holds.
    ///
    /// ```
    /// use guen_runtime::{Smooth, Table};
    /// let measured = vec![(0.0, 1.0), (2.0, 5.0)];
    /// let line = Table::<100>::spline_through(&measured)?;
    /// assert_eq!(line.value([1.0]), 3.0);
    /// # Ok::<(), guen_runtime::TableError>(())
    /// ```
    pub fn spline_through(points: &[(f64, f64)]) -> Result<Self, TableError> {
        Self::through(points, |x, y| natural(x, |i| y[i]))
    }

    /// A monotone cubic curve, as [`monotone`](Self::monotone), through points whose number the program finds out when it runs: at most `N`.
    ///
    /// # Errors
    ///
    /// Those of [`new`](Self::new); more points than the table holds.
    ///
    /// ```
    /// use guen_runtime::{Table, TableError};
    /// let points = [(0.0, 1.0), (1.0, 2.0), (2.0, 2.0)];
    /// assert_eq!(Table::<2>::monotone_through(&points), Err(TableError::TooMany { points: 3, capacity: 2 }));
    /// ```
    pub fn monotone_through(points: &[(f64, f64)]) -> Result<Self, TableError> {
        Self::through(points, |x, y| monotone(x, |i| y[i]))
    }

    fn through(
        points: &[(f64, f64)],
        slopes: impl Fn(&[f64], &[f64]) -> [f64; N],
    ) -> Result<Self, TableError> {
        let count = points.len();
        if count > N {
            return Err(TableError::TooMany { points: count, capacity: N });
        }
        let (mut arguments, mut values) = ([0.0; N], [0.0; N]);
        for (i, (argument, value)) in points.iter().enumerate() {
            (arguments[i], values[i]) = (*argument, *value);
        }
        let (x, y) = (&arguments[..count], &values[..count]);
        check(x)?;
        check_finite(y)?;
        let slopes = slopes(x, y);
        check_slopes(&slopes[..count])?;
        let mut knots = [Knot::default(); N];
        for i in 0..count {
            let mut coefficients = [y[i], slopes[i], 0.0, 0.0];
            if i + 1 < count {
                let h = x[i + 1] - x[i];
                let chord = (y[i + 1] - y[i]) / h;
                coefficients[2] = (3.0 * chord - 2.0 * slopes[i] - slopes[i + 1]) / h;
                coefficients[3] = (slopes[i] + slopes[i + 1] - 2.0 * chord) / (h * h);
                check_slopes(&coefficients).map_err(|_| TableError::TooSteep { index: i + 1 })?;
            }
            knots[i] = Knot { argument: x[i], coefficients };
        }
        Ok(Table { knots, count })
    }

    /// The least and the largest argument of a point.
    ///
    /// ```
    /// use guen_runtime::Table;
    /// assert_eq!(Table::new([(-1.0, 0.0), (3.0, 1.0)])?.range(), -1.0..=3.0);
    /// # Ok::<(), guen_runtime::TableError>(())
    /// ```
    pub fn range(&self) -> core::ops::RangeInclusive<f64> {
        self.knots[0].argument..=self.knots[self.count - 1].argument
    }

    /// The knot at which the piece of an argument begins, and whether the argument lies between knots.
    fn piece(&self, x: f64) -> (usize, bool) {
        piece(|i| self.knots[i].argument, self.count, x)
    }
}

impl<const N: usize> Smooth<1> for Table<N> {
    fn value<R: Real>(&self, [x]: [R; 1]) -> R {
        // The piece of each lane: its knot, and half a knot more where only the straight line counts.
        let piece = R::each_alone(|alone| {
            let (knot, is_between) = self.piece(alone(x));
            knot as f64 + if is_between { 0.0 } else { 0.5 }
        });
        let knot = |alone: &dyn Fn(R) -> f64| &self.knots[alone(piece) as usize];
        let coefficient = |k: usize| {
            R::each_alone(|alone| {
                let is_straight = alone(piece) % 1.0 != 0.0;
                if is_straight && k > 1 { 0.0 } else { knot(alone).coefficients[k] }
            })
        };
        let distance = x - R::each_alone(|alone| knot(alone).argument);
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(coefficient);
        let slope = c3.times_plus(distance, c2).times_plus(distance, c1);
        slope.times_plus(distance, c0)
    }

    fn is_same(&self, other: &Self) -> bool {
        self == other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::derivatives::derivatives_2;

    const POINTS: [(f64, f64); 6] =
        [(-2.0, 1.0), (-1.0, 0.2), (0.5, 0.3), (1.0, 2.0), (2.5, 1.9), (4.0, -1.0)];

    /// The value and two derivatives.
    fn at<const N: usize>(table: &Table<N>, x: f64) -> [f64; 3] {
        let found = derivatives_2(table, [x]);
        [found.value.value, found.value.tangent[0], found.tangent[0].tangent[0]]
    }

    #[test]
    fn a_spline_goes_through_its_points_twice_differentiable() {
        let table = Table::new(POINTS).unwrap();
        for (x, y) in POINTS {
            let (before, behind) = (at(&table, x - 1e-9), at(&table, x + 1e-9));
            assert!((table.value([x]) - y).abs() < 1e-14);
            for k in 0..3 {
                assert!((before[k] - behind[k]).abs() < 1e-7, "derivative {k} at {x}: {before:?} {behind:?}");
            }
        }
    }

    #[test]
    fn a_spline_through_a_cubic_with_natural_ends_is_that_cubic() {
        // y'' = 6x - 6x/2.. vanishes at both ends for x^3 - 3 x^2 on [1, 1]: a line is the only cubic, so two pieces by hand.
        // Through (0, 0), (1, 1), (2, 0): slopes 3/2, 0, -3/2, from the equations of three knots.
        let table = Table::new([(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]).unwrap();
        let curve = |x: f64| 1.5 * x - 0.5 * x * x * x;
        for x in [0.1, 0.4, 0.9] {
            let [value, slope, second] = at(&table, x);
            assert!((value - curve(x)).abs() < 1e-15 && (slope - (1.5 - 1.5 * x * x)).abs() < 1e-15);
            assert!((second + 3.0 * x).abs() < 1e-14);
            assert!((table.value([2.0 - x]) - curve(x)).abs() < 1e-15);
        }
    }

    #[test]
    fn a_monotone_curve_stays_between_the_values() {
        let table = Table::monotone(POINTS).unwrap();
        for pair in POINTS.windows(2) {
            let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
            for i in 0..=40 {
                let y = table.value([x0 + (x1 - x0) * f64::from(i) / 40.0]);
                assert!(y >= y0.min(y1) - 1e-15 && y <= y0.max(y1) + 1e-15);
            }
        }
        let line = Table::monotone([(0.0, 1.0), (2.0, 5.0)]).unwrap();
        assert_eq!(line.value([0.5]), 2.0);
    }

    #[test]
    fn outside_it_goes_on_straight_and_nan_stays_nan() {
        for table in [Table::new(POINTS).unwrap(), Table::monotone(POINTS).unwrap()] {
            for (end, step) in [(-2.0, -1.0), (4.0, 1.0)] {
                let [value, slope, _] = at(&table, end);
                let [further, same, second] = at(&table, end + 3.0 * step);
                assert!((further - (value + 3.0 * step * slope)).abs() < 1e-13);
                assert!((same - slope).abs() < 1e-13 && second == 0.0);
            }
            assert!(table.value([f64::NAN]).is_nan());
            assert!(table.value([f64::INFINITY]).is_infinite() || table.value([f64::INFINITY]).is_nan());
        }
    }

    #[test]
    fn bad_points_have_typed_errors() {
        assert_eq!(Table::new([(0.0, 1.0)]), Err(TableError::TooFew { points: 1 }));
        let unsorted = Table::new([(0.0, 1.0), (2.0, 1.0), (1.0, 0.0)]);
        assert_eq!(unsorted, Err(TableError::NotIncreasing { index: 2, before: 2.0, value: 1.0 }));
        assert_eq!(
            Table::new([(0.0, 1.0), (f64::NAN, 1.0)]).unwrap_err(),
            TableError::NotFinite { index: 1 }
        );
        assert_eq!(
            Table::monotone([(0.0, f64::INFINITY), (1.0, 1.0)]),
            Err(TableError::NotFinite { index: 0 })
        );
        assert_eq!(Table::new([(0.0, 0.0), (1e-300, 1e300)]).unwrap_err(), TableError::TooSteep { index: 1 });
    }
}
