//! Arithmetic modulo one fixed prime: what goes in and out are residues below [`PRIME`].
//!
//! The prime is safe and 23 modulo 24: minus one is not a square, so the circle `x^2 + y^2 = 1` is a
//! cyclic group of `p + 1` points; two and three are squares; every odd root is unique.

use num_bigint::BigInt;
use num_traits::ToPrimitive;

use crate::algebra::Rational;

/// The largest safe prime of 61 bits found that is 23 modulo 24.
pub(crate) const PRIME: u64 = 2_305_843_009_213_690_799;

/// `2^61 - PRIME`: folding the high bits costs one small multiplication.
const EXCESS: u128 = (1 << 61) - PRIME as u128;
const LOW: u128 = (1 << 61) - 1;

/// The order of [`TURN`]: the smooth part of `p + 1`, which holds the angles that people write.
pub(crate) const TURN_ORDER: u64 = 75_600;

/// A point of the circle of that order, playing the part of `exp(2 pi i / 75600)`.
///
/// Of its conjugates this one makes sine and cosine of the common angles squares where they are
/// positive: so `cos(pi/5)`, `cos(pi/8)` and the roots written for them agree.
pub(crate) const TURN: Point = Point { cos: 919_336_598_222_743_920, sin: 210_824_192_571_962_334 };

pub(crate) fn add(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= PRIME { sum - PRIME } else { sum }
}

pub(crate) fn neg(a: u64) -> u64 {
    if a == 0 { 0 } else { PRIME - a }
}

pub(crate) fn sub(a: u64, b: u64) -> u64 {
    add(a, neg(b))
}

pub(crate) fn mul(a: u64, b: u64) -> u64 {
    let x = u128::from(a) * u128::from(b);
    let x = (x >> 61) * EXCESS + (x & LOW);
    let x = ((x >> 61) * EXCESS + (x & LOW)) as u64;
    if x >= PRIME { x - PRIME } else { x }
}

pub(crate) fn pow(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = mul(result, base);
        }
        exponent >>= 1;
        if exponent > 0 {
            base = mul(base, base);
        }
    }
    result
}

/// `1/a`, or `None` for zero.
pub(crate) fn inverse(a: u64) -> Option<u64> {
    if a == 0 { None } else { Some(inverse_modulo(a, PRIME)) }
}

/// The inverse of a unit, by Euclid: cheaper than a power.
fn inverse_modulo(a: u64, modulus: u64) -> u64 {
    let (mut r0, mut r1) = (modulus as i64, a as i64);
    let (mut t0, mut t1) = (0_i64, 1_i64);
    while r1 != 0 {
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (t0, t1) = (t1, t0 - quotient * t1);
    }
    debug_assert_eq!(r0, 1, "not a unit");
    if t0 < 0 { (t0 + modulus as i64) as u64 } else { t0 as u64 }
}

/// The square root that is itself a square, or `None` if there is none.
pub(crate) fn sqrt(a: u64) -> Option<u64> {
    let root = pow(a, PRIME.div_ceil(4));
    (mul(root, root) == a).then_some(root)
}

/// Whether `a` is a square (zero is).
pub(crate) fn is_residue(a: u64) -> bool {
    sqrt(a).is_some()
}

/// The root of order `q`: unique for odd `q`, a square for even `q`.
pub(crate) fn root(a: u64, q: u32) -> Option<u64> {
    let mut value = a;
    for _ in 0..q.trailing_zeros() {
        value = sqrt(value)?;
    }
    let odd = u64::from(q >> q.trailing_zeros());
    Some(if odd == 1 { value } else { pow(value, inverse_modulo(odd, PRIME - 1)) })
}

/// The size below which integers are below the prime.
const BELOW_PRIME: i64 = 1 << 60;

/// The residue of a rational number.
///
/// `None` also for a nonzero number that the prime divides: nothing may be called zero for that reason.
pub(crate) fn residue(value: &Rational) -> Option<u64> {
    if value.is_zero() {
        return Some(0);
    }
    if let Some(n) = value.to_i64()
        && -BELOW_PRIME < n
        && n < BELOW_PRIME
    {
        return Some(if n < 0 { PRIME - n.unsigned_abs() } else { n as u64 });
    }
    let (n, d) = match value.to_i64_pair() {
        Some((n, d)) => {
            let magnitude = n.unsigned_abs() % PRIME;
            (if n < 0 { neg(magnitude) } else { magnitude }, d.unsigned_abs() % PRIME)
        }
        None => {
            let (n, d) = value.to_big_pair();
            let reduce = |x: &BigInt| num_integer::Integer::mod_floor(x, &BigInt::from(PRIME)).to_u64();
            (reduce(&n)?, reduce(&d)?)
        }
    };
    if n == 0 {
        return None;
    }
    if d == 1 { Some(n) } else { Some(mul(n, inverse(d)?)) }
}

/// A point of the circle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Point {
    pub(crate) cos: u64,
    pub(crate) sin: u64,
}

impl Point {
    pub(crate) const EAST: Point = Point { cos: 1, sin: 0 };

    /// The point with `tan(angle/2) = u`; the denominator never vanishes.
    pub(crate) fn from_half_tangent(u: u64) -> Self {
        let u2 = mul(u, u);
        let scale = inverse(add(1, u2)).expect("minus one is not a square");
        Point { cos: mul(sub(1, u2), scale), sin: mul(add(u, u), scale) }
    }

    pub(crate) fn turn(self, by: Point) -> Point {
        Point {
            cos: sub(mul(self.cos, by.cos), mul(self.sin, by.sin)),
            sin: add(mul(self.cos, by.sin), mul(self.sin, by.cos)),
        }
    }

    /// The angle times `n`.
    pub(crate) fn times(self, n: i128) -> Point {
        let mut base = if n < 0 { Point { cos: self.cos, sin: neg(self.sin) } } else { self };
        let mut n = (n.unsigned_abs() % u128::from(PRIME + 1)) as u64;
        let mut result = Point::EAST;
        while n > 0 {
            if n & 1 == 1 {
                result = result.turn(base);
            }
            n >>= 1;
            if n > 0 {
                base = base.turn(base);
            }
        }
        result
    }
}

/// `a^n` for a unit and any integer.
pub(crate) fn unit_power(a: u64, n: i128) -> Option<u64> {
    let base = if n < 0 { inverse(a)? } else { a };
    Some(pow(base, (n.unsigned_abs() % u128::from(PRIME - 1)) as u64))
}

/// The reduced row echelon form, in place; returns the pivot columns in order.
pub(crate) fn eliminate(rows: &mut [Vec<u64>]) -> Vec<usize> {
    let width = rows.first().map_or(0, Vec::len);
    let mut pivots = Vec::new();
    for column in 0..width {
        let top = pivots.len();
        let Some(found) = (top..rows.len()).find(|&i| rows[i][column] != 0) else { continue };
        rows.swap(top, found);
        let scale = inverse(rows[top][column]).expect("a pivot");
        // Rows of forms are sparse, most of them have one entry.
        let mut entries: Vec<(usize, u64)> = Vec::new();
        for (place, value) in rows[top].iter_mut().enumerate().skip(column) {
            if *value != 0 {
                *value = mul(*value, scale);
                entries.push((place, *value));
            }
        }
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[column];
            if i != top && factor != 0 {
                for (place, pivot) in &entries {
                    row[*place] = sub(row[*place], mul(factor, *pivot));
                }
            }
        }
        pivots.push(column);
    }
    pivots
}

/// The rank of a matrix given by rows.
pub(crate) fn rank(rows: &[Vec<u64>]) -> usize {
    eliminate(&mut rows.to_vec()).len()
}

/// A basis of the vectors `v` with `rows v = 0`; `width` is needed where there is no row.
pub(crate) fn kernel(rows: &[Vec<u64>], width: usize) -> Vec<Vec<u64>> {
    let mut rows = rows.to_vec();
    let pivots = eliminate(&mut rows);
    (0..width)
        .filter(|column| !pivots.contains(column))
        .map(|free| {
            let mut vector = vec![0; width];
            vector[free] = 1;
            for (row, &pivot) in rows.iter().zip(&pivots) {
                vector[pivot] = neg(row[free]);
            }
            vector
        })
        .collect()
}

/// Returns a solution of `rows x = right`, free unknowns zero; `None` if there is none.
pub(crate) fn solve(rows: &[Vec<u64>], right: &[u64]) -> Option<Vec<u64>> {
    let width = rows.first().map_or(0, Vec::len);
    let mut extended: Vec<Vec<u64>> =
        rows.iter().zip(right).map(|(row, b)| row.iter().copied().chain([*b]).collect()).collect();
    let pivots = eliminate(&mut extended);
    let mut solution = vec![0; width];
    for (row, &pivot) in extended.iter().zip(&pivots) {
        *solution.get_mut(pivot)? = row[width];
    }
    Some(solution)
}

/// The inverse of a symmetric matrix; `None` if it is singular. Rows with few entries are eliminated first, which fills least: in an arrow matrix the
/// dense row comes last.
pub(crate) fn inverse_of_symmetric(rows: &[Vec<u64>]) -> Option<Vec<Vec<u64>>> {
    let n = rows.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|i| rows[*i].iter().filter(|value| **value != 0).count());
    let unit = |i: usize| (0..n).map(move |j| u64::from(i == j));
    let extended = order
        .iter()
        .enumerate()
        .map(|(i, row)| order.iter().map(|j| rows[*row][*j]).chain(unit(i)).collect());
    let mut extended: Vec<Vec<u64>> = extended.collect();
    let pivots = eliminate(&mut extended);
    if pivots.last().is_some_and(|last| *last >= n) {
        return None;
    }
    let mut inverse = vec![vec![0; n]; n];
    for (row, i) in extended.iter().zip(&order) {
        for (value, j) in row[n..].iter().zip(&order) {
            inverse[*i][*j] = *value;
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symmetric_matrices_are_inverted() {
        // An arrow, whose head comes first.
        let rows = vec![vec![7, 1, 2, 3], vec![1, 5, 0, 0], vec![2, 0, 4, 0], vec![3, 0, 0, 9]];
        let inverse = inverse_of_symmetric(&rows).expect("an inverse");
        for (i, row) in rows.iter().enumerate() {
            // The inverse is symmetric, too.
            for (j, column) in inverse.iter().enumerate() {
                let product = row.iter().zip(column).fold(0, |sum, (a, b)| add(sum, mul(*a, *b)));
                assert_eq!(product, u64::from(i == j));
            }
        }
        assert_eq!(inverse_of_symmetric(&[vec![1, 2], vec![2, 4]]), None);
    }

    #[test]
    fn the_prime_is_safe() {
        // Fermat's test to several bases; the number itself was proved prime elsewhere.
        for base in [2, 3, 5, 7, 11, 13] {
            assert_eq!(pow(base, PRIME - 1), 1);
        }
        assert_eq!(PRIME % 24, 23);
        assert!(is_residue(2) && is_residue(3) && !is_residue(PRIME - 1));
    }

    #[test]
    fn roots_invert_powers() {
        for a in [2, 5, 123_456_789, PRIME - 7] {
            assert_eq!(mul(a, inverse(a).unwrap()), 1);
            assert_eq!(root(pow(a, 3), 3), Some(a));
            let squared = mul(a, a);
            let root = sqrt(squared).unwrap();
            assert!(is_residue(root) && (root == a || root == neg(a)));
        }
    }

    #[test]
    fn turns_are_exact() {
        assert_eq!(TURN.times(TURN_ORDER.into()), Point::EAST);
        let eighth = TURN.times((TURN_ORDER / 8).into());
        assert_eq!(add(eighth.cos, eighth.cos), sqrt(2).unwrap());
        assert_eq!(eighth.cos, eighth.sin);
        let twelfth = TURN.times((TURN_ORDER / 12).into());
        assert_eq!(add(twelfth.cos, twelfth.cos), sqrt(3).unwrap());
        assert_eq!(add(twelfth.sin, twelfth.sin), 1);
    }

    #[test]
    fn linear_algebra() {
        let rows = vec![vec![1, 2, 3], vec![2, 4, 6], vec![1, 0, 1]];
        assert_eq!(rank(&rows), 2);
        assert_eq!(solve(&rows, &[6, 12, 2]), Some(vec![2, 2, 0]));
        assert_eq!(solve(&rows, &[6, 11, 2]), None);
    }
}
