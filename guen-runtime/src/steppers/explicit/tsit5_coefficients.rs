//! The coefficients of Tsit5, as decimals of 33 digits.
//!
//! Source: C. Tsitouras, *Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying assumption*,
//! Computers & Mathematics with Applications 62 (2011) 770-775, gives 16 digits; the longer ones of matrix and weights
//! are those of SciML's OrdinaryDiffEq, `tsit_tableaus.jl`. The interpolant is published with 16 digits as well. With
//! the form of [`Dense`](crate::steppers::Dense) it has seven unknowns, the coefficients of the fourth power, which the
//! conditions of order four determine up to one; with the published `5/2` for the last stage they were solved in 60
//! digits, and agree with the published ones to all of theirs. The tests check every condition.

use crate::numbers::decimal::{Parts, decimal};

/// The nodes of stages 2 to 6; that of stage 7 is one.
pub(in crate::steppers) const C: [Parts; 5] = [
    decimal("0.161"),
    decimal("0.327"),
    decimal("0.9"),
    decimal("0.980025540904509685729810286287025"),
    decimal("1.0"),
];

/// Stage 2, from stage 1.
pub(in crate::steppers) const A2: [Parts; 1] = [decimal("0.161")];

/// Stage 3, from stages 1, 2.
pub(in crate::steppers) const A3: [Parts; 2] =
    [decimal("-0.00848065549235698854442687425023077"), decimal("0.335480655492356988544426874250231")];

/// Stage 4, from stages 1 to 3.
pub(in crate::steppers) const A4: [Parts; 3] = [
    decimal("2.89715305710549343213043259419294"),
    decimal("-6.35944848997507484314815991238383"),
    decimal("4.36229543286958141101772731819089"),
];

/// Stage 5, from stages 1 to 4.
pub(in crate::steppers) const A5: [Parts; 4] = [
    decimal("5.32586482843925660442887792084051"),
    decimal("-11.7488835640628278777471703397858"),
    decimal("7.49553934288983620830460478456436"),
    decimal("-0.0924950663617552492565020793320719"),
];

/// Stage 6, from stages 1 to 5.
pub(in crate::steppers) const A6: [Parts; 5] = [
    decimal("5.86145544294642002865925148698265"),
    decimal("-12.9209693178471092917061186817834"),
    decimal("8.15936789857615864318040079453925"),
    decimal("-0.0715849732814009972245305425258297"),
    decimal("-0.0282690503940683829090030572127122"),
];

/// The weights of order 5, of stages 1 to 6; stage 7 is evaluated at their result.
pub(in crate::steppers) const B: [Parts; 6] = [
    decimal("0.0964607668180652295181673131651288"),
    decimal("0.01"),
    decimal("0.479889650414499574775249532290597"),
    decimal("1.37900857410374189319227482185687"),
    decimal("-3.29006951543608067990104758571136"),
    decimal("2.32471052409977398241535591839877"),
];

/// The weights of order 4 less those of order 5, of stages 1 to 7.
pub(in crate::steppers) const E: [Parts; 7] = [
    decimal("-0.00178001105222577144337855060753953"),
    decimal("-0.000816434459656746903223636063354686"),
    decimal("0.0078808780102619960103147276725263"),
    decimal("-0.144711007173262907537165147972635"),
    decimal("0.582357165452555225019937610652042"),
    decimal("-0.458082105929186946661636518832554"),
    decimal("0.0151515151515151515151515151515152"),
];

/// The coefficients of the fourth power in the interpolant, of stages 1 to 7.
pub(in crate::steppers) const D: [Parts; 7] = [
    decimal("-1.05308849772902155722749030252307"),
    decimal("0.1017"),
    decimal("2.4906272856512527930835450725882"),
    decimal("-16.5481028892449027183072978622825"),
    decimal("47.3795219628192812186815818681988"),
    decimal("-34.8706578614966097362303387759815"),
    decimal("2.5"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Real;

    fn row<const M: usize>(parts: &[Parts; M]) -> [f64; 7] {
        core::array::from_fn(|j| parts.get(j).map_or(0.0, f64_of))
    }

    fn f64_of(parts: &Parts) -> f64 {
        f64::from_parts(parts)
    }

    fn matrix() -> ([f64; 7], [[f64; 7]; 7]) {
        let c = [0.0, f64_of(&C[0]), f64_of(&C[1]), f64_of(&C[2]), f64_of(&C[3]), 1.0, 1.0];
        (c, [[0.0; 7], row(&A2), row(&A3), row(&A4), row(&A5), row(&A6), row(&B)])
    }

    /// The sums of a formula with weights `b` for all trees of up to five nodes, and what they must be for a step to
    /// the part `s` of the way: `s^order / gamma`. In the order of Hairer, Norsett and Wanner, table II.2.1.
    fn conditions(b: &[f64; 7], s: f64) -> [(u32, f64, f64); 17] {
        let (c, a) = matrix();
        let times = |x: [f64; 7], y: [f64; 7]| -> [f64; 7] { core::array::from_fn(|i| x[i] * y[i]) };
        let apply = |x: [f64; 7]| -> [f64; 7] { a.map(|row| (0..7).map(|j| row[j] * x[j]).sum()) };
        let one = [1.0; 7];
        let c2 = times(c, c);
        let (c3, c4) = (times(c2, c), times(c2, c2));
        let (ac, ac2, ac3) = (apply(c), apply(c2), apply(c3));
        let (aac, aac2) = (apply(ac), apply(ac2));
        let trees = [
            (1, one, 1.0),
            (2, c, 2.0),
            (3, c2, 3.0),
            (3, ac, 6.0),
            (4, c3, 4.0),
            (4, times(c, ac), 8.0),
            (4, ac2, 12.0),
            (4, aac, 24.0),
            (5, c4, 5.0),
            (5, times(c2, ac), 10.0),
            (5, times(c, ac2), 15.0),
            (5, times(c, aac), 30.0),
            (5, times(ac, ac), 20.0),
            (5, ac3, 20.0),
            (5, apply(times(c, ac)), 40.0),
            (5, aac2, 60.0),
            (5, apply(aac), 120.0),
        ];
        trees.map(|(order, tree, gamma)| {
            let sum: f64 = (0..7).map(|i| b[i] * tree[i]).sum();
            (order, sum, Real::powi(s, order as i32) / gamma)
        })
    }

    #[test]
    fn rows_sum_to_their_nodes() {
        let (c, a) = matrix();
        for (node, row) in c.iter().zip(a) {
            assert!((row.iter().sum::<f64>() - node).abs() < 4e-15);
        }
    }

    #[test]
    fn weights_meet_the_conditions_of_orders_five_and_four() {
        let b = row(&B);
        for (_, sum, expected) in conditions(&b, 1.0) {
            assert!((sum - expected).abs() < 1e-14, "{sum} instead of {expected}");
        }
        let e = row(&E);
        let four = core::array::from_fn(|i| b[i] + e[i]);
        for (order, sum, expected) in conditions(&four, 1.0) {
            let off = (sum - expected).abs();
            assert!(if order <= 4 { off < 1e-14 } else { off < 1e-2 }, "{sum} instead of {expected}");
        }
        assert!(conditions(&four, 1.0).iter().any(|(_, sum, expected)| (sum - expected).abs() > 1e-4));
    }

    #[test]
    fn the_interpolant_has_order_four_all_the_way() {
        let (b, d) = (row(&B), row(&D));
        for s in [0.0, 0.1, 0.37, 0.5, 0.81, 1.0] {
            let rest = 1.0 - s;
            let weights = core::array::from_fn(|i| {
                let start = if i == 0 { s * rest * rest } else { 0.0 };
                let end = if i == 6 { -s * s * rest } else { 0.0 };
                s * s * (3.0 - 2.0 * s) * b[i] + start + end + s * s * rest * rest * d[i]
            });
            for (order, sum, expected) in conditions(&weights, s) {
                let enough = order == 5 || (sum - expected).abs() < 2e-14;
                assert!(enough, "s = {s}, order {order}: {sum} instead of {expected}");
            }
        }
    }
}
