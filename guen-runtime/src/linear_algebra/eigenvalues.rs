//! Eigenvalues of a real matrix: balancing, Hessenberg form, and the QR algorithm with double shifts (Francis 1961).
//!
//! Of our own, and not `nalgebra`'s, for the reasons of [`lu`](super::lu): no feature is needed, and every ordered real serves.

use super::dense::{largest, length};
use crate::numbers::real::Ordered;

/// Steps of the QR algorithm for each eigenvalue; three are usual.
const MOST_STEPS: usize = 60;
/// Steps after which the shifts are others, for matrices on which the usual ones go in circles.
const STEPS_OF_ONE_KIND: usize = 10;

/// The eigenvalues as real and imaginary parts, conjugate pairs beside each other with the same bits. `None` if an entry is not
/// finite, or the algorithm does not converge.
///
/// Each is an eigenvalue of a matrix that differs from the balanced one by a few roundings of its norm.
pub(crate) fn eigenvalues<R: Ordered, const N: usize>(a: &[[R; N]; N]) -> Option<[[R; 2]; N]> {
    if !a.iter().flatten().all(|x| x.is_finite()) {
        return None;
    }
    let mut h = *a;
    balance(&mut h);
    let sizes = scale(&mut h);
    to_hessenberg(&mut h);
    let mut values = [[R::zero(); 2]; N];
    // The rows `..count` have still to be done.
    let mut count = N;
    let mut steps = 0;
    while count > 0 {
        let last = count - 1;
        let first = (1..count).rev().find(|i| is_negligible(&mut h, *i)).unwrap_or(0);
        if first == last {
            values[last] = [h[last][last], R::zero()];
            (count, steps) = (last, 0);
        } else if first + 1 == last {
            [values[first], values[last]] = of_two(&h, first);
            (count, steps) = (first, 0);
        } else {
            steps += 1;
            if steps > MOST_STEPS {
                return None;
            }
            step(&mut h, first, last, steps % STEPS_OF_ONE_KIND == 0);
        }
    }
    // One power of two after the other, of which a real with fewer exponents may not hold the product.
    let values = values.map(|value| value.map(|part| sizes.into_iter().fold(part, |part, size| part * size)));
    values.iter().flatten().all(|part| part.is_finite()).then_some(values)
}

/// Divides a matrix by a power of two, so that its largest entry is about one and no square overflows or vanishes. Returns two factors
/// of that power.
fn scale<R: Ordered, const N: usize>(h: &mut [[R; N]; N]) -> [R; 2] {
    let size = largest(h.iter().flatten().copied());
    if size == 0.0 || !size.is_finite() {
        return [R::one(); 2];
    }
    let exponent = libm::floor(libm::log2(size));
    let half = libm::floor(0.5 * exponent);
    let powers = [half, exponent - half];
    for power in powers {
        let down = R::from_f64(libm::exp2(-power));
        h.iter_mut().flatten().for_each(|x| *x *= down);
    }
    powers.map(|power| R::from_f64(libm::exp2(power)))
}

/// Scales rows and columns by powers of two until those of one index are about as long: units leave the matrix. Returns the numbers that
/// columns were multiplied by.
pub(crate) fn balance<R: Ordered, const N: usize>(h: &mut [[R; N]; N]) -> [R; N] {
    const SWEEPS: usize = 30;
    let mut factors = [R::one(); N];
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..N {
            let others = || (0..N).filter(|j| *j != i);
            let column: f64 = others().map(|j| h[j][i].to_f64().abs()).sum();
            let row: f64 = others().map(|j| h[i][j].to_f64().abs()).sum();
            if column == 0.0 || row == 0.0 || !(row / column).is_finite() {
                continue;
            }
            let exponent = libm::round(libm::log2(row / column) / 2.0).clamp(-500.0, 500.0) as i32;
            let factor = libm::exp2(f64::from(exponent));
            if (column * factor + row / factor) < 0.95 * (column + row) {
                changed = true;
                let (up, down) = (R::from_f64(factor), R::from_f64(factor.recip()));
                h[i].iter_mut().for_each(|x| *x *= down);
                h.iter_mut().for_each(|row| row[i] *= up);
                factors[i] *= up;
            }
        }
        if !changed {
            break;
        }
    }
    factors
}

/// A reflection `1 - v v^T/norm` that leaves of a vector its first entry only.
struct Reflection<R, const K: usize> {
    vector: [R; K],
    norm: R,
}

impl<R: Ordered, const K: usize> Reflection<R, K> {
    /// `None` where nothing has to be done.
    fn of(mut vector: [R; K]) -> Option<Self> {
        let most = R::from_f64(largest(vector[1..].iter().copied()));
        if most == R::zero() {
            return None;
        }
        let first = vector[0].abs();
        let most = if most > first { most } else { first };
        vector.iter_mut().for_each(|x| *x /= most);
        let size = length(&vector);
        let size = if vector[0] < R::zero() { -size } else { size };
        let norm = size * (vector[0] + size);
        vector[0] += size;
        Some(Reflection { vector, norm })
    }

    /// Applies it to rows, and to the same columns, of the rows and columns from `first` to `last`.
    fn apply<const N: usize>(
        &self,
        h: &mut [[R; N]; N],
        place: impl Fn(usize) -> usize,
        first: usize,
        last: usize,
    ) {
        (first..=last).for_each(|j| {
            let part = (0..K).fold(R::zero(), |sum, k| sum + self.vector[k] * h[place(k)][j]) / self.norm;
            (0..K).for_each(|k| h[place(k)][j] -= part * self.vector[k]);
        });
        for row in &mut h[first..=last] {
            let part = (0..K).fold(R::zero(), |sum, k| sum + self.vector[k] * row[place(k)]) / self.norm;
            (0..K).for_each(|k| row[place(k)] -= part * self.vector[k]);
        }
    }
}

/// Zeros below the subdiagonal, by a reflection for each column.
fn to_hessenberg<R: Ordered, const N: usize>(h: &mut [[R; N]; N]) {
    for k in 0..N.saturating_sub(2) {
        // The column below the diagonal, turned round so that its first entry is the first of the vector.
        let place = |i: usize| (k + 1 + i) % N;
        let column: [R; N] = core::array::from_fn(|i| if i + k + 1 < N { h[place(i)][k] } else { R::zero() });
        if let Some(reflection) = Reflection::of(column) {
            reflection.apply(h, place, 0, N - 1);
        }
        h.iter_mut().skip(k + 2).for_each(|row| row[k] = R::zero());
    }
}

/// Tells whether the entry left of a diagonal one is lost in rounding, and makes it zero.
fn is_negligible<R: Ordered, const N: usize>(h: &mut [[R; N]; N], i: usize) -> bool {
    let beside = h[i - 1][i - 1].abs() + h[i][i].abs();
    let beside = if beside == R::zero() { R::from_f64(largest(h.iter().flatten().copied())) } else { beside };
    let negligible = h[i][i - 1].abs() <= R::epsilon() * beside;
    if negligible {
        h[i][i - 1] = R::zero();
    }
    negligible
}

/// The eigenvalues of the two rows and columns from `i` on.
fn of_two<R: Ordered, const N: usize>(h: &[[R; N]; N], i: usize) -> [[R; 2]; 2] {
    let [a, b, c, d] = [h[i][i], h[i][i + 1], h[i + 1][i], h[i + 1][i + 1]];
    let p = (a - d) * R::from_ratio(1, 2);
    let q = p * p + b * c;
    if q < R::zero() {
        let root = (-q).sqrt();
        return [[d + p, root], [d + p, -root]];
    }
    let z = if p < R::zero() { p - q.sqrt() } else { p + q.sqrt() };
    let other = if z == R::zero() { d } else { d - b * c / z };
    [[d + z, R::zero()], [other, R::zero()]]
}

/// A step of the QR algorithm with two shifts on the rows from `first` to `last`, three at least.
fn step<R: Ordered, const N: usize>(h: &mut [[R; N]; N], first: usize, last: usize, unusual: bool) {
    let (sum, determinant) = if unusual {
        let size = h[last][last - 1].abs() + h[last - 1][last - 2].abs();
        (size * R::from_ratio(3, 2), size * size)
    } else {
        let (a, d) = (h[last - 1][last - 1], h[last][last]);
        (a + d, a * d - h[last - 1][last] * h[last][last - 1])
    };
    let (corner, next, below) = (h[first][first], h[first + 1][first + 1], h[first + 1][first]);
    // The first column of (H - s_1)(H - s_2).
    let mut column = [
        corner * (corner - sum) + h[first][first + 1] * below + determinant,
        below * (corner + next - sum),
        below * h[first + 2][first + 1],
    ];
    for k in first..last - 1 {
        if let Some(reflection) = Reflection::of(column) {
            reflection.apply(h, |i| k + i, first, last);
        }
        column = [h[k + 1][k], h[k + 2][k], if k + 3 <= last { h[k + 3][k] } else { R::zero() }];
    }
    if let Some(reflection) = Reflection::of([column[0], column[1]]) {
        reflection.apply(h, |i| last - 1 + i, first, last);
    }
    // What the reflections have made zero.
    for i in first + 2..=last {
        h[i][first..i - 1].fill(R::zero());
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use std::vec::Vec;

    use super::eigenvalues;
    use crate::linear_algebra::dense::{product, solve, unit};

    /// A sequence of numbers between -1 and 1.
    struct Sequence(u64);

    impl Sequence {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    fn sorted<const N: usize>(mut values: [[f64; 2]; N]) -> [[f64; 2]; N] {
        values.sort_by(|a, b| a.partial_cmp(b).unwrap());
        values
    }

    #[test]
    fn a_matrix_that_was_built_of_eigenvalues_has_them() {
        let mut draw = Sequence(7);
        for _ in 0..300 {
            // Three pairs and two real ones, in a basis drawn at random.
            let mut blocks = [[0.0; 8]; 8];
            let mut wanted = [[0.0; 2]; 8];
            for i in [0, 2, 4] {
                let (re, im) = (draw.next(), 3.0 * draw.next().abs() + 0.1);
                (blocks[i][i], blocks[i + 1][i + 1]) = (re, re);
                (blocks[i][i + 1], blocks[i + 1][i]) = (im, -im);
                (wanted[i], wanted[i + 1]) = ([re, im], [re, -im]);
            }
            for i in [6, 7] {
                blocks[i][i] = draw.next() + if i == 6 { 2.0 } else { -2.0 };
                wanted[i] = [blocks[i][i], 0.0];
            }
            let basis: [[f64; 8]; 8] = core::array::from_fn(|i| {
                core::array::from_fn(|j| draw.next() + if i == j { 4.0 } else { 0.0 })
            });
            let Some(inverse) = solve(&basis, &unit()) else { continue };
            let found = eigenvalues(&product(&basis, &product(&blocks, &inverse))).unwrap();
            for (found, wanted) in sorted(found).iter().zip(sorted(wanted)) {
                assert!(
                    (found[0] - wanted[0]).abs() + (found[1] - wanted[1]).abs() < 1e-9,
                    "{found:?} {wanted:?}"
                );
            }
        }
    }

    #[test]
    fn matrices_on_which_usual_shifts_go_in_circles_are_done() {
        // A cyclic permutation: roots of one.
        let mut cycle = [[0.0; 5]; 5];
        (0..5).for_each(|i| cycle[i][(i + 1) % 5] = 1.0);
        let found = eigenvalues(&cycle).unwrap();
        assert!(found.iter().all(|[re, im]: &[f64; 2]| (re.hypot(*im) - 1.0).abs() < 1e-14));
        let pairs: Vec<_> = found.iter().filter(|[_, im]| *im != 0.0).collect();
        assert!(pairs.len() == 4 && pairs[0][0] == pairs[1][0] && pairs[0][1] == -pairs[1][1]);
        assert_eq!(eigenvalues(&[[0.0; 4]; 4]), Some([[0.0; 2]; 4]));
    }

    #[test]
    fn units_do_not_cost_digits() {
        // Springs of 1e12 N/m in nanometres and of 1 N/m in metres.
        let a = [[0.0, 1e-9, 0.0], [-1e12, -1.0, 1e3], [0.0, 0.0, -1e-6]];
        let found = sorted(eigenvalues(&a).unwrap());
        assert!((found[0][0] + 0.5).abs() < 1e-12 && (found[2][0] + 1e-6).abs() < 1e-18, "{found:?}");
    }

    #[test]
    fn sizes_do_not_matter() {
        let turning = |size: f64| [[size, -size], [size, size]];
        for size in [1e200, 1e-200, 1e307, 1e-310, 5e-324] {
            assert_eq!(eigenvalues(&turning(size)), Some([[size, size], [size, -size]]), "{size:e}");
        }
        let mut draw = Sequence(3);
        let drawn: [[f64; 6]; 6] = core::array::from_fn(|_| core::array::from_fn(|_| draw.next()));
        let plain = eigenvalues(&drawn).unwrap();
        for power in [-1000, -60, 60, 1000] {
            let size = libm::exp2(f64::from(power));
            let found = eigenvalues(&drawn.map(|row| row.map(|x| x * size))).unwrap();
            assert_eq!(found, plain.map(|value| value.map(|part| part * size)), "{power}");
        }
        // Entries that are far apart, and a product of one.
        let found = sorted(eigenvalues(&[[0.0, 1e300], [1e-300, 0.0]]).unwrap());
        assert!((found[0][0] + 1.0).abs() < 1e-15 && (found[1][0] - 1.0).abs() < 1e-15, "{found:?}");
        // In single precision, too.
        let found = eigenvalues(&turning(1.0).map(|row| row.map(|x| x as f32 * 1e30))).unwrap();
        assert_eq!(found, [[1e30, 1e30], [1e30, -1e30]]);
        // Beyond the largest number.
        assert_eq!(eigenvalues(&[[1.7e308, 1.7e308], [1.7e308, 1.7e308]]), None);
    }

    #[test]
    fn what_is_not_finite_has_none() {
        assert_eq!(eigenvalues(&[[f64::NAN, 0.0], [0.0, 1.0]]), None);
        assert_eq!(eigenvalues(&[[f64::INFINITY]]), None);
    }
}
