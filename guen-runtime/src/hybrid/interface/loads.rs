//! Grips that the reaction of a permanent constraint loads: `|l_t| <= mu |lambda|`.
//!
//! The reaction is affine in those of the contacts, `lambda = free + responses l`. A grip that slips has `l_t = -mu |lambda| d`, so that its
//! load appears on both sides: with the magnitudes `f` as forces given from outside, `f = |free + coupling f|`.

use crate::hybrid::filled::{filled, table};

use crate::numbers::choices::most;
use crate::numbers::real::Real;

/// The reactions of permanent constraints that load grips, one for each element; zero for elements without such a load.
///
/// ```text
/// lambda_c = free_c + sum_w responses_cw l_w
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads<R, const W: usize, const C: usize> {
    /// The reactions where no contact, grip or latch acts.
    pub free: [R; C],
    /// The change of each by a unit reaction along every row.
    pub responses: [[R; W]; C],
}

impl<R: Real, const W: usize, const C: usize> Loads<R, W, C> {
    /// No load.
    ///
    /// ```
    /// use guen_runtime::hybrid::Loads;
    /// assert_eq!(Loads::<f64, 1, 1>::none().free, [0.0]);
    /// ```
    pub fn none() -> Self {
        Self { free: [R::zero(); C], responses: [[R::zero(); W]; C] }
    }
}

/// The part of an element's load that reactions add.
pub(in crate::hybrid) fn added<R: Real, const W: usize>(responses: &[R; W], reactions: &[R; W]) -> R {
    responses.iter().zip(reactions).fold(R::zero(), |sum, (a, l)| l.times_plus(*a, sum))
}

/// Steps from one pattern of signs to the next.
const SIGN_PATTERNS: usize = 64;

/// The magnitudes `f = |free + coupling f|` of the loads of what slips, zero elsewhere; not a number where none was found.
///
/// For each pattern of signs `S` the equation is linear, `(I - S coupling) f = S free`. A magnitude below zero has the wrong sign: the
/// first one is turned, which ends where all principal minors are positive (Murty's principal pivoting for linear complementarity).
pub(in crate::hybrid) fn magnitudes<R: Real, const C: usize>(
    free: &[R; C],
    coupling: &[[R; C]; C],
    slips: &[bool; C],
) -> [R; C] {
    let (zero, one) = (R::zero(), R::one());
    let mut signs: [R; C] = filled(|c| if slips[c] { free[c].where_above(zero, one, -one) } else { zero });
    let mut found = [zero; C];
    for _ in 0..SIGN_PATTERNS {
        let right = filled(|c| signs[c] * free[c]);
        (found, _) = solved(matrix(coupling, &signs), right);
        let Some(c) = (0..C).find(|&c| slips[c] && most(-found[c]) > 0.0) else { return found };
        signs[c] = found[c].where_above(zero, signs[c], -signs[c]);
    }
    let nothing = zero * zero.recip();
    found.map(|f| (-f).where_above(zero, nothing, f))
}

/// The least determinant of `I - S coupling` over all patterns of signs: positive for all of them exactly if every free reaction has one
/// magnitude.
pub(in crate::hybrid) fn regularity<R: Real, const C: usize>(coupling: &[[R; C]; C], slips: &[bool; C]) -> R {
    let count = slips.iter().filter(|slips| **slips).count();
    let mut least = R::one();
    for pattern in 0..1_usize << count {
        let mut rest = pattern;
        let signs = filled(|c| {
            if !slips[c] {
                return R::zero();
            }
            let sign = if rest % 2 == 0 { R::one() } else { -R::one() };
            rest /= 2;
            sign
        });
        let (_, determinant) = solved(matrix(coupling, &signs), [R::zero(); C]);
        least = least.where_above(determinant, determinant, least);
    }
    least
}

/// `I - S coupling`.
fn matrix<R: Real, const C: usize>(coupling: &[[R; C]; C], signs: &[R; C]) -> [[R; C]; C] {
    table(|c, e| {
        let own = if c == e { R::one() } else { R::zero() };
        own.minus_times(signs[c], coupling[c][e])
    })
}

/// The solution of linear equations and the determinant of their matrix, by elimination with the largest pivot of each column.
fn solved<R: Real, const C: usize>(mut matrix: [[R; C]; C], mut right: [R; C]) -> ([R; C], R) {
    let mut determinant = R::one();
    for k in 0..C {
        let size = |matrix: &[[R; C]; C], row: usize| matrix[row][k].to_f64().abs();
        let best =
            (k..C).fold(k, |best, row| if size(&matrix, row) > size(&matrix, best) { row } else { best });
        if best != k {
            matrix.swap(k, best);
            right.swap(k, best);
            determinant = -determinant;
        }
        determinant *= matrix[k][k];
        let inverse = matrix[k][k].recip();
        for row in k + 1..C {
            let factor = matrix[row][k] * inverse;
            for column in k + 1..C {
                let entry = matrix[k][column];
                matrix[row][column] = matrix[row][column].minus_times(factor, entry);
            }
            right[row] = right[row].minus_times(factor, right[k]);
        }
    }
    let mut solution = [R::zero(); C];
    for k in (0..C).rev() {
        let mut rest = right[k];
        for column in k + 1..C {
            rest = rest.minus_times(matrix[k][column], solution[column]);
        }
        solution[k] = rest / matrix[k][k];
    }
    (solution, determinant)
}

#[cfg(test)]
mod tests {
    use super::{magnitudes, regularity};

    /// A number in -1 to 1.
    fn next(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn magnitudes_satisfy_their_equation() {
        let mut seed = 5;
        let mut unique = 0;
        for _ in 0..1000 {
            let coupling: [[f64; 3]; 3] = core::array::from_fn(|_| core::array::from_fn(|_| next(&mut seed)));
            let free: [f64; 3] = core::array::from_fn(|_| next(&mut seed));
            let slips = [true, true, next(&mut seed) > 0.0];
            let found = magnitudes(&free, &coupling, &slips);
            let has_value = found.iter().all(|f| !f.is_nan());
            if regularity(&coupling, &slips) > 0.0 {
                unique += 1;
                assert!(has_value);
            }
            if !has_value {
                continue;
            }
            for c in 0..3 {
                let sum: f64 = free[c] + (0..3).map(|e| coupling[c][e] * found[e]).sum::<f64>();
                let expected = if slips[c] { sum.abs() } else { 0.0 };
                assert!((found[c] - expected).abs() < 1e-9 * (1.0 + expected), "{found:?} {expected}");
            }
        }
        assert!(unique > 300, "{unique}");
    }

    #[test]
    fn a_load_that_grows_faster_than_its_friction_has_no_magnitude() {
        let [none] = magnitudes(&[1.0_f64], &[[2.0]], &[true]);
        assert!(none.is_nan());
        assert!(regularity(&[[2.0]], &[true]) < 0.0);
        assert_eq!(magnitudes(&[1.0], &[[0.5]], &[true]), [2.0]);
        assert_eq!(magnitudes(&[-1.0], &[[0.5]], &[true]), [2.0 / 3.0]);
    }
}
