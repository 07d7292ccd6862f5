//! The condition of a mass matrix, whatever the units of its parameters.

use crate::linear_algebra::Lu;
use crate::numbers::real::Real;

/// The condition that [`Guarded::condition`](crate::Guarded::condition) speaks of: for a positive definite matrix
/// `max_s M_ss (M^-1)_ss`, by `M = D^{1/2} L P L^T D^{1/2}` with the diagonal `D` of `M`. For one that is not, the
/// condition in the largest row sum of the matrix with its rows and columns scaled to a largest entry of about one.
///
/// In `f64` for longer reals, since an order of magnitude is all that is asked for, and in every lane by itself for lanes;
/// `l^3/3` multiplications. Infinite for
/// a matrix that is singular or not finite. `N` is the number of parameters, and `triangle` the lower triangle, row by
/// row, at the head of a list that may go on.
///
/// ```
/// use guen_runtime::checks::condition;
///
/// // Chaplygin's sled: gamma^2, -beta, 1, whose determinant is 1e-6 of gamma^2.
/// let (gamma2, beta2): (f64, f64) = (4.0, 4.0 * (1.0 - 1e-6));
/// assert!((condition::<f64, 2>(&[gamma2, -beta2.sqrt(), 1.0]) / 1e6 - 1.0).abs() < 1e-9);
/// // Units do not count: masses of a gram and of a million tons that are not coupled.
/// assert_eq!(condition::<f64, 2>(&[1e-3, 0.0, 1e9]), 1.0);
/// assert_eq!(condition::<f64, 2>(&[1.0, 1.0, 1.0]), f64::INFINITY);
/// ```
pub fn condition<R: Real, const N: usize>(triangle: &[R]) -> R {
    let short = R::epsilon().to_f64() >= f64::EPSILON;
    let all = if short {
        R::vectorize(
            #[inline(always)]
            || definite(&matrix::<R, R, N>(triangle, |entry| entry)),
        )
    } else {
        None
    };
    all.unwrap_or_else(|| {
        R::each_alone(|alone| {
            let mass = matrix::<R, f64, N>(triangle, alone);
            definite(&mass).unwrap_or_else(|| indefinite(&mass))
        })
    })
}

/// The whole matrix, with NaN for what is not there.
#[inline(always)]
fn matrix<R: Real, T: Real, const N: usize>(triangle: &[R], entry: impl Fn(R) -> T) -> [[T; N]; N] {
    let mut matrix = [[T::zero(); N]; N];
    for (s, row) in matrix.iter_mut().enumerate() {
        for (k, place) in row.iter_mut().enumerate() {
            let (row, column) = if s < k { (k, s) } else { (s, k) };
            *place = match triangle.get(row * (row + 1) / 2 + column) {
                Some(value) => entry(*value),
                None => T::from_f64(f64::NAN),
            };
        }
    }
    matrix
}

/// Returns the condition from the factors of the matrix with a diagonal of ones; none if a pivot is not positive, of lanes in one of them.
#[inline(always)]
fn definite<R: Real, const N: usize>(mass: &[[R; N]; N]) -> Option<R> {
    let mut root = [R::zero(); N];
    for (s, root) in root.iter_mut().enumerate() {
        *root = mass[s][s].sqrt();
    }
    let mut factor = *mass;
    let mut pivots = [R::zero(); N];
    for s in 0..N {
        for k in 0..=s {
            let mut rest = mass[s][k] / root[s] / root[k];
            for j in 0..k {
                rest -= factor[s][j] * factor[k][j] * pivots[j];
            }
            if k < s {
                factor[s][k] = rest / pivots[k];
            } else if rest.is_finite() && rest.where_above(R::zero(), R::one(), R::zero()) == R::one() {
                pivots[s] = rest;
            } else {
                return None;
            }
        }
    }
    // (M^-1)_ss by the columns of the inverse of the unit triangle.
    let mut worst = R::one();
    for s in 0..N {
        let mut column = [R::zero(); N];
        column[s] = R::one();
        let mut sum = pivots[s].recip();
        for row in s + 1..N {
            let mut value = R::zero();
            for k in s..row {
                value -= factor[row][k] * column[k];
            }
            column[row] = value;
            sum += value * value / pivots[row];
        }
        worst = sum.where_above(worst, sum, worst);
    }
    Some(worst)
}

fn indefinite<const N: usize>(mass: &[[f64; N]; N]) -> f64 {
    let root = mass.map(|row| libm::sqrt(row.iter().fold(0.0_f64, |most, e| most.max(e.abs()))));
    let scaled: [[f64; N]; N] =
        core::array::from_fn(|s| core::array::from_fn(|k| mass[s][k] / root[s] / root[k]));
    let sum = |row: &[f64; N]| row.iter().map(|e| e.abs()).sum::<f64>();
    let Some(factors) = Lu::new(scaled) else { return f64::INFINITY };
    let mut rows = [0.0; N];
    for k in 0..N {
        let unit = core::array::from_fn(|s| if s == k { 1.0 } else { 0.0 });
        for (row, entry) in rows.iter_mut().zip(factors.solve(unit)) {
            *row += f64::abs(entry);
        }
    }
    let inverse = rows.into_iter().fold(0.0, f64::max);
    let condition = inverse * scaled.iter().map(sum).fold(0.0, f64::max);
    if condition.is_nan() { f64::INFINITY } else { condition.max(1.0) }
}

#[cfg(test)]
mod tests {
    use super::condition;

    /// Against the inverse of a matrix that has one in closed form: Hilbert's of order four, whose inverse has the
    /// diagonal 16, 1200, 6480, 2800.
    #[test]
    fn the_inverse_of_hilberts_matrix() {
        let triangle: [f64; 10] =
            [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 3.0, 0.25, 0.2, 0.25, 0.2, 1.0 / 6.0, 1.0 / 7.0];
        let expected = [16.0, 1200.0 / 3.0, 6480.0 / 5.0, 2800.0 / 7.0].into_iter().fold(0.0, f64::max);
        assert!((condition::<f64, 4>(&triangle) / expected - 1.0).abs() < 1e-10);
        // Other units, the same condition.
        let units = [1e-9, 1.0, 1e7, 3.0];
        let mut scaled = triangle;
        let mut place = 0;
        for s in 0..4 {
            for k in 0..=s {
                scaled[place] *= units[s] * units[k];
                place += 1;
            }
        }
        assert!((condition::<f64, 4>(&scaled) / expected - 1.0).abs() < 1e-10);
    }

    #[test]
    fn indefinite_singular_and_other_matrices() {
        assert!((condition::<f64, 2>(&[0.0, 3.0, 0.0]) - 1.0).abs() < 1e-12);
        assert!((condition::<f64, 2>(&[-2.0, 0.0, -5.0]) - 1.0).abs() < 1e-12);
        assert_eq!(condition::<f64, 2>(&[0.0, 0.0, 1.0]), f64::INFINITY);
        assert_eq!(condition::<f64, 1>(&[f64::NAN]), f64::INFINITY);
        assert_eq!(condition::<f64, 1>(&[f64::INFINITY]), f64::INFINITY);
        assert_eq!(condition::<f64, 0>(&[]), 1.0);
    }
}
