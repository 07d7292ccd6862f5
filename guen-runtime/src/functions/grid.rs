//! A function of two arguments through values on a grid.

use crate::functions::error::TableError;
use crate::functions::knots::{check, check_finite, check_slopes, natural, piece};
use crate::functions::smooth::Smooth;
use crate::numbers::real::Real;

/// A smooth function of two arguments through values on a rectangular grid: the height of a terrain, a map of a motor.
///
/// The function is the bicubic natural spline: twice continuously differentiable. Outside of the grid it goes on straight along each
/// argument, with the slope at the edge; value, slopes and second derivatives are continuous there. An argument that is NaN gives
/// NaN.
///
/// `M` arguments `x`, `N` arguments `y`, `values[i][j]` at `(x[i], y[j])`. A grid takes `32 M N` bytes, and evaluation does not
/// allocate. A large one is lent to a system as a `&'static` reference.
///
/// ```
/// use guen_runtime::{Grid, Smooth};
///
/// let ground = Grid::new([0.0, 1.0, 2.0], [0.0, 5.0], [[0.0, 0.1], [0.4, 0.5], [0.2, 0.3]])?;
/// assert_eq!(ground.value([1.0, 5.0]), 0.5);
/// # Ok::<(), guen_runtime::TableError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid<const M: usize, const N: usize> {
    x: [f64; M],
    y: [f64; N],
    /// The value at each node, its derivatives by `x` and by `y`, and the mixed one.
    nodes: [[[f64; 4]; N]; M],
}

impl<const M: usize, const N: usize> Grid<M, N> {
    /// The bicubic spline through `values[i][j]` at `(x[i], y[j])`, arguments increasing.
    ///
    /// # Errors
    ///
    /// Fewer than two arguments along an axis, arguments that do not increase, a number that is not finite. The index is that along the
    /// axis, and of a value that of its row.
    ///
    /// ```
    /// use guen_runtime::{Grid, TableError};
    /// let grid = Grid::new([0.0, 1.0], [1.0, 0.0], [[0.0; 2]; 2]);
    /// assert_eq!(grid.unwrap_err(), TableError::NotIncreasing { index: 1, before: 1.0, value: 0.0 });
    /// ```
    pub fn new(x: [f64; M], y: [f64; N], values: [[f64; N]; M]) -> Result<Self, TableError> {
        check(&x)?;
        check(&y)?;
        for (index, row) in values.iter().enumerate() {
            check_finite(row).map_err(|_| TableError::NotFinite { index })?;
        }
        let mut nodes = values.map(|row| row.map(|value| [value, 0.0, 0.0, 0.0]));
        (0..N).try_for_each(|j| {
            let slopes: [f64; M] = natural(&x, |i| nodes[i][j][0]);
            nodes.iter_mut().zip(slopes).for_each(|(row, slope)| row[j][1] = slope);
            check_slopes(&slopes)
        })?;
        for row in &mut nodes {
            for k in [0, 1] {
                let slopes: [f64; N] = natural(&y, |j| row[j][k]);
                check_slopes(&slopes)?;
                row.iter_mut().zip(slopes).for_each(|(node, slope)| node[k + 2] = slope);
            }
        }
        Ok(Grid { x, y, nodes })
    }
}

/// The place of an argument along an axis: the knot in front of it, and the weights of what is known there and at the next one.
struct Along<R> {
    knot: R,
    /// The weights of the value and the slope at the knot, and of those at the next one.
    weights: [[R; 2]; 2],
}

impl<R: Real> Along<R> {
    fn of(knots: &[f64], x: R) -> Self {
        let last = knots.len() - 1;
        let found = |x: f64| piece(|i| knots[i], knots.len(), x);
        let knot = R::each_alone(|alone| found(alone(x)).0 as f64);
        // Zero outside: there the next knot has no weight.
        let inverse = R::each_alone(|alone| match found(alone(x)) {
            (i, true) if i < last => (knots[i + 1] - knots[i]).recip(),
            _ => 0.0,
        });
        let distance = x - R::each_alone(|alone| knots[alone(knot) as usize]);
        let part = distance * inverse;
        let one = R::one();
        let (two, three) = (R::from_ratio(2, 1), R::from_ratio(3, 1));
        let rise = part * part * (three - two * part);
        let slope = distance * (one - part * (two - part));
        let next_slope = distance * part * (part - one);
        Along { knot, weights: [[one - rise, slope], [rise, next_slope]] }
    }
}

impl<const M: usize, const N: usize> Smooth<2> for Grid<M, N> {
    fn value<R: Real>(&self, [x, y]: [R; 2]) -> R {
        let (along_x, along_y) = (Along::of(&self.x, x), Along::of(&self.y, y));
        let mut sum = R::zero();
        for (i, by_x) in along_x.weights.iter().enumerate() {
            for (j, by_y) in along_y.weights.iter().enumerate() {
                let at = |k: usize| {
                    R::each_alone(|alone| {
                        let row = (alone(along_x.knot) as usize + i).min(M - 1);
                        let column = (alone(along_y.knot) as usize + j).min(N - 1);
                        self.nodes[row][column][k]
                    })
                };
                let value = by_x[0] * at(0) + by_x[1] * at(1);
                let slope = by_x[0] * at(2) + by_x[1] * at(3);
                sum += by_y[0] * value + by_y[1] * slope;
            }
        }
        sum
    }

    fn is_same(&self, other: &Self) -> bool {
        self == other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::derivatives::derivatives_2;
    use crate::functions::table::Table;

    const X: [f64; 4] = [0.0, 1.0, 1.5, 3.0];
    const Y: [f64; 3] = [-1.0, 0.5, 2.0];

    #[test]
    fn a_product_of_functions_is_the_product_of_their_splines() {
        let (u, v) = ([1.0, -0.5, 2.0, 0.3], [0.7, 1.5, -1.0]);
        let values = u.map(|a| v.map(|b| a * b));
        let grid = Grid::new(X, Y, values).unwrap();
        let along_x = Table::<4>::new(core::array::from_fn(|i| (X[i], u[i]))).unwrap();
        let along_y = Table::<3>::new(core::array::from_fn(|j| (Y[j], v[j]))).unwrap();
        for x in [-1.3, 0.2, 1.2, 2.9, 4.0] {
            for y in [-2.0, -0.3, 1.0, 3.5] {
                let found = derivatives_2(&grid, [x, y]);
                let (a, b) = (derivatives_2(&along_x, [x]), derivatives_2(&along_y, [y]));
                let (a0, b0) = (a.value.value, b.value.value);
                let (a1, b1) = (a.value.tangent[0], b.value.tangent[0]);
                let second = a.tangent[0].tangent[0];
                let pairs = [
                    (found.value.value, a0 * b0),
                    (found.value.tangent[0], a1 * b0),
                    (found.value.tangent[1], a0 * b1),
                    (found.tangent[0].tangent[1], a1 * b1),
                    (found.tangent[0].tangent[0], second * b0),
                ];
                for (place, (found, expected)) in pairs.into_iter().enumerate() {
                    assert!((found - expected).abs() < 1e-12, "{place} at {x}, {y}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn bad_values_have_typed_errors() {
        let bad = Grid::new([0.0, 1.0], [0.0, 1.0], [[0.0, 1.0], [f64::NAN, 0.0]]);
        assert_eq!(bad.unwrap_err(), TableError::NotFinite { index: 1 });
        assert_eq!(Grid::new([0.0], [0.0, 1.0], [[0.0; 2]]).unwrap_err(), TableError::TooFew { points: 1 });
        let grid = Grid::new(X, Y, [[1.0; 3]; 4]).unwrap();
        assert!(grid.value([f64::NAN, 0.0]).is_nan() && grid.value([0.0, f64::NAN]).is_nan());
    }
}
