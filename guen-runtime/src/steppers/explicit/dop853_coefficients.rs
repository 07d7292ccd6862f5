//! The published coefficients of DOP853, as decimals of up to 30 digits.
//!
//! Source: E. Hairer and G. Wanner's program `dop853.f` (version of April 25, 1996, corrected August 8, 2005),
//! parameters `c`, `a`, `b`, `er`, `bhh` and, for the interpolant, `d`; scipy's table `dop853_coefficients.py` has the same numbers. Stages
//! count from 1; a row lists the nonzero coefficients only, and its documentation the stages that they belong
//! to. The tests check the row sums and the order conditions of all three formulas.
//!
//! Digits: nodes, matrix and weights fulfil their sums to 27 digits, so a longer real loses at the 28th; the
//! weights of the interpolant are tested to as many as their own sums have.

use crate::numbers::decimal::{Parts, decimal};

/// The nodes of stages 2 to 12.
pub(in crate::steppers) const C: [Parts; 11] = [
    decimal("5.26001519587677318785587544488e-2"),
    decimal("7.89002279381515978178381316732e-2"),
    decimal("1.18350341907227396726757197510e-1"),
    decimal("2.81649658092772603273242802490e-1"),
    decimal("3.33333333333333333333333333333e-1"),
    decimal("2.5e-1"),
    decimal("3.07692307692307692307692307692e-1"),
    decimal("6.51282051282051282051282051282e-1"),
    decimal("6.0e-1"),
    decimal("8.57142857142857142857142857142e-1"),
    decimal("1.0"),
];

/// Stage 2, from stage 1.
pub(in crate::steppers) const A2: [Parts; 1] = [decimal("5.26001519587677318785587544488e-2")];

/// Stage 3, from stages 1, 2.
pub(in crate::steppers) const A3: [Parts; 2] =
    [decimal("1.97250569845378994544595329183e-2"), decimal("5.91751709536136983633785987549e-2")];

/// Stage 4, from stages 1, 3.
pub(in crate::steppers) const A4: [Parts; 2] =
    [decimal("2.95875854768068491816892993775e-2"), decimal("8.87627564304205475450678981324e-2")];

/// Stage 5, from stages 1, 3, 4.
pub(in crate::steppers) const A5: [Parts; 3] = [
    decimal("2.41365134159266685502369798665e-1"),
    decimal("-8.84549479328286085344864962717e-1"),
    decimal("9.24834003261792003115737966543e-1"),
];

/// Stage 6, from stages 1, 4, 5.
pub(in crate::steppers) const A6: [Parts; 3] = [
    decimal("3.7037037037037037037037037037e-2"),
    decimal("1.70828608729473871279604482173e-1"),
    decimal("1.25467687566822425016691814123e-1"),
];

/// Stage 7, from stages 1, 4, 5, 6.
pub(in crate::steppers) const A7: [Parts; 4] = [
    decimal("3.7109375e-2"),
    decimal("1.70252211019544039314978060272e-1"),
    decimal("6.02165389804559606850219397283e-2"),
    decimal("-1.7578125e-2"),
];

/// Stage 8, from stages 1, 4, 5, 6, 7.
pub(in crate::steppers) const A8: [Parts; 5] = [
    decimal("3.70920001185047927108779319836e-2"),
    decimal("1.70383925712239993810214054705e-1"),
    decimal("1.07262030446373284651809199168e-1"),
    decimal("-1.53194377486244017527936158236e-2"),
    decimal("8.27378916381402288758473766002e-3"),
];

/// Stage 9, from stages 1, 4, 5, 6, 7, 8.
pub(in crate::steppers) const A9: [Parts; 6] = [
    decimal("6.24110958716075717114429577812e-1"),
    decimal("-3.36089262944694129406857109825"),
    decimal("-8.68219346841726006818189891453e-1"),
    decimal("2.75920996994467083049415600797e1"),
    decimal("2.01540675504778934086186788979e1"),
    decimal("-4.34898841810699588477366255144e1"),
];

/// Stage 10, from stages 1, 4, 5, 6, 7, 8, 9.
pub(in crate::steppers) const A10: [Parts; 7] = [
    decimal("4.77662536438264365890433908527e-1"),
    decimal("-2.48811461997166764192642586468"),
    decimal("-5.90290826836842996371446475743e-1"),
    decimal("2.12300514481811942347288949897e1"),
    decimal("1.52792336328824235832596922938e1"),
    decimal("-3.32882109689848629194453265587e1"),
    decimal("-2.03312017085086261358222928593e-2"),
];

/// Stage 11, from stages 1, 4, 5, 6, 7, 8, 9, 10.
pub(in crate::steppers) const A11: [Parts; 8] = [
    decimal("-9.3714243008598732571704021658e-1"),
    decimal("5.18637242884406370830023853209"),
    decimal("1.09143734899672957818500254654"),
    decimal("-8.14978701074692612513997267357"),
    decimal("-1.85200656599969598641566180701e1"),
    decimal("2.27394870993505042818970056734e1"),
    decimal("2.49360555267965238987089396762"),
    decimal("-3.0467644718982195003823669022"),
];

/// Stage 12, from stages 1, 4, 5, 6, 7, 8, 9, 10, 11.
pub(in crate::steppers) const A12: [Parts; 9] = [
    decimal("2.27331014751653820792359768449"),
    decimal("-1.05344954667372501984066689879e1"),
    decimal("-2.00087205822486249909675718444"),
    decimal("-1.79589318631187989172765950534e1"),
    decimal("2.79488845294199600508499808837e1"),
    decimal("-2.85899827713502369474065508674"),
    decimal("-8.87285693353062954433549289258"),
    decimal("1.23605671757943030647266201528e1"),
    decimal("6.43392746015763530355970484046e-1"),
];

/// The weights of order 8, of stages 1, 6, 7, 8, 9, 10, 11, 12.
pub(in crate::steppers) const B: [Parts; 8] = [
    decimal("5.42937341165687622380535766363e-2"),
    decimal("4.45031289275240888144113950566"),
    decimal("1.89151789931450038304281599044"),
    decimal("-5.8012039600105847814672114227"),
    decimal("3.1116436695781989440891606237e-1"),
    decimal("-1.52160949662516078556178806805e-1"),
    decimal("2.01365400804030348374776537501e-1"),
    decimal("4.47106157277725905176885569043e-2"),
];

/// The weights of order 8 less those of order 5, of stages 1, 6, 7, 8, 9, 10, 11, 12.
pub(in crate::steppers) const E5: [Parts; 8] = [
    decimal("1.312004499419488073250102996e-2"),
    decimal("-1.225156446376204440720569753"),
    decimal("-4.957589496572501915214079952e-1"),
    decimal("1.664377182454986536961530415"),
    decimal("-3.503288487499736816886487290e-1"),
    decimal("3.341791187130174790297318841e-1"),
    decimal("8.192320648511571246570742613e-2"),
    decimal("-2.235530786388629525884427845e-2"),
];

/// The weights of order 3, of stages 1, 9, 12.
pub(in crate::steppers) const B3: [Parts; 3] = [
    decimal("2.44094488188976377952755905512e-1"),
    decimal("7.33846688281611857341361741547e-1"),
    decimal("2.20588235294117647058823529412e-2"),
];

/// The nodes of stages 14 to 16.
pub(in crate::steppers) const C_DENSE: [Parts; 3] =
    [decimal("1e-1"), decimal("2e-1"), decimal("7.77777777777777777777777777778e-1")];

/// Stage 14, from stages 1, 7, 8, 9, 10, 11, 12 and 13, the slope at the end of the step.
pub(in crate::steppers) const A14: [Parts; 8] = [
    decimal("5.61675022830479523392909219681e-2"),
    decimal("2.53500210216624811088794765333e-1"),
    decimal("-2.46239037470802489917441475441e-1"),
    decimal("-1.24191423263816360469010140626e-1"),
    decimal("1.5329179827876569731206322685e-1"),
    decimal("8.20105229563468988491666602057e-3"),
    decimal("7.56789766054569976138603589584e-3"),
    decimal("-8.298e-3"),
];

/// Stage 15, from stages 1, 6, 7, 8, 11, 12, 13, 14.
pub(in crate::steppers) const A15: [Parts; 8] = [
    decimal("3.18346481635021405060768473261e-2"),
    decimal("2.83009096723667755288322961402e-2"),
    decimal("5.35419883074385676223797384372e-2"),
    decimal("-5.49237485713909884646569340306e-2"),
    decimal("-1.08347328697249322858509316994e-4"),
    decimal("3.82571090835658412954920192323e-4"),
    decimal("-3.40465008687404560802977114492e-4"),
    decimal("1.41312443674632500278074618366e-1"),
];

/// Stage 16, from stages 1, 6, 7, 8, 9, 13, 14, 15.
pub(in crate::steppers) const A16: [Parts; 8] = [
    decimal("-4.28896301583791923408573538692e-1"),
    decimal("-4.69762141536116384314449447206"),
    decimal("7.68342119606259904184240953878"),
    decimal("4.06898981839711007970213554331"),
    decimal("3.56727187455281109270669543021e-1"),
    decimal("-1.39902416515901462129418009734e-3"),
    decimal("2.9475147891527723389556272149"),
    decimal("-9.15095847217987001081870187138"),
];

/// The weights of term `r4` of the interpolant, of stages 1, 6 to 12, 13, 14, 15, 16.
pub(in crate::steppers) const D4: [Parts; 12] = [
    decimal("-0.84289382761090128651353491142e1"),
    decimal("0.56671495351937776962531783590e0"),
    decimal("-0.30689499459498916912797304727e1"),
    decimal("0.23846676565120698287728149680e1"),
    decimal("0.21170345824450282767155149946e1"),
    decimal("-0.87139158377797299206789907490e0"),
    decimal("0.22404374302607882758541771650e1"),
    decimal("0.63157877876946881815570249290e0"),
    decimal("-0.88990336451333310820698117400e-1"),
    decimal("0.18148505520854727256656404962e2"),
    decimal("-0.91946323924783554000451984436e1"),
    decimal("-0.44360363875948939664310572000e1"),
];

/// The weights of term `r5` of the interpolant, of stages 1, 6 to 12, 13, 14, 15, 16.
pub(in crate::steppers) const D5: [Parts; 12] = [
    decimal("0.10427508642579134603413151009e2"),
    decimal("0.24228349177525818288430175319e3"),
    decimal("0.16520045171727028198505394887e3"),
    decimal("-0.37454675472269020279518312152e3"),
    decimal("-0.22113666853125306036270938578e2"),
    decimal("0.77334326684722638389603898808e1"),
    decimal("-0.30674084731089398182061213626e2"),
    decimal("-0.93321305264302278729567221706e1"),
    decimal("0.15697238121770843886131091075e2"),
    decimal("-0.31139403219565177677282850411e2"),
    decimal("-0.93529243588444783865713862664e1"),
    decimal("0.35816841486394083752465898540e2"),
];

/// The weights of term `r6` of the interpolant, of stages 1, 6 to 12, 13, 14, 15, 16.
pub(in crate::steppers) const D6: [Parts; 12] = [
    decimal("0.19985053242002433820987653617e2"),
    decimal("-0.38703730874935176555105901742e3"),
    decimal("-0.18917813819516756882830838328e3"),
    decimal("0.52780815920542364900561016686e3"),
    decimal("-0.11573902539959630126141871134e2"),
    decimal("0.68812326946963000169666922661e1"),
    decimal("-0.10006050966910838403183860980e1"),
    decimal("0.77771377980534432092869265740e0"),
    decimal("-0.27782057523535084065932004339e1"),
    decimal("-0.60196695231264120758267380846e2"),
    decimal("0.84320405506677161018159903784e2"),
    decimal("0.11992291136182789328035130030e2"),
];

/// The weights of term `r7` of the interpolant, of stages 1, 6 to 12, 13, 14, 15, 16.
pub(in crate::steppers) const D7: [Parts; 12] = [
    decimal("-0.25693933462703749003312586129e2"),
    decimal("-0.15418974869023643374053993627e3"),
    decimal("-0.23152937917604549567536039109e3"),
    decimal("0.35763911791061412378285349910e3"),
    decimal("0.93405324183624310003907691704e2"),
    decimal("-0.37458323136451633156875139351e2"),
    decimal("0.10409964950896230045147246184e3"),
    decimal("0.29840293426660503123344363579e2"),
    decimal("-0.43533456590011143754432175058e2"),
    decimal("0.96324553959188282948394950600e2"),
    decimal("-0.39177261675615439165231486172e2"),
    decimal("-0.14972683625798562581422125276e3"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Real;

    /// Stage numbers of the nonzero coefficients of each row, from stage 2.
    const ROWS: [(&[Parts], &[usize]); 11] = [
        (&A2, &[1]),
        (&A3, &[1, 2]),
        (&A4, &[1, 3]),
        (&A5, &[1, 3, 4]),
        (&A6, &[1, 4, 5]),
        (&A7, &[1, 4, 5, 6]),
        (&A8, &[1, 4, 5, 6, 7]),
        (&A9, &[1, 4, 5, 6, 7, 8]),
        (&A10, &[1, 4, 5, 6, 7, 8, 9]),
        (&A11, &[1, 4, 5, 6, 7, 8, 9, 10]),
        (&A12, &[1, 4, 5, 6, 7, 8, 9, 10, 11]),
    ];
    const WEIGHTED: [usize; 8] = [1, 6, 7, 8, 9, 10, 11, 12];

    /// The number as an integer of units `2^-110`, hence to 33 digits: sums of these are exact.
    fn fixed(parts: &Parts) -> i128 {
        const UNIT: i32 = 110;
        let mut sum = 0;
        for &(mantissa, exponent) in parts {
            let shift = exponent + UNIT;
            let mantissa = i128::from(mantissa);
            sum += if shift >= 0 { mantissa << shift } else { mantissa >> -shift };
        }
        sum
    }

    /// `1e-27` in those units: the published digits end there or later.
    const LAST_DIGIT: i128 = (1 << 110) / 1_000_000_000_000_000_000_000_000_000;

    #[test]
    fn rows_sum_to_their_nodes_in_all_published_digits() {
        for (i, (row, _)) in ROWS.iter().enumerate() {
            let sum: i128 = row.iter().map(fixed).sum();
            assert!((sum - fixed(&C[i])).abs() <= LAST_DIGIT, "stage {}", i + 2);
        }
        for (weights, total) in [(&B[..], 1), (&E5[..], 0), (&B3[..], 1)] {
            let sum: i128 = weights.iter().map(fixed).sum();
            assert!((sum - (total << 110)).abs() <= LAST_DIGIT, "{sum}");
        }
    }

    /// The conditions that the further stages and the weights of the interpolant have to meet in all their digits:
    /// rows sum to their nodes, and what is added to the cubic through both ends vanishes for a constant slope.
    #[test]
    fn the_interpolant_keeps_constant_slopes() {
        for (row, node) in [&A14, &A15, &A16].into_iter().zip(&C_DENSE) {
            let sum: i128 = row.iter().map(fixed).sum();
            assert!((sum - fixed(node)).abs() <= 10 * LAST_DIGIT, "{sum}");
        }
        for weights in [&D4, &D5, &D6, &D7] {
            let sum: i128 = weights.iter().map(fixed).sum();
            assert!(sum.abs() <= 10 * LAST_DIGIT, "{sum}");
        }
    }

    /// Nodes, matrix and weights as plain arrays, stage `i` at index `i - 1`.
    struct Dense {
        c: [f64; 12],
        a: [[f64; 12]; 12],
        eight: [f64; 12],
        five: [f64; 12],
        three: [f64; 12],
    }

    fn dense() -> Dense {
        let mut dense =
            Dense { c: [0.0; 12], a: [[0.0; 12]; 12], eight: [0.0; 12], five: [0.0; 12], three: [0.0; 12] };
        for (i, (row, stages)) in ROWS.iter().enumerate() {
            dense.c[i + 1] = f64::from_parts(&C[i]);
            assert_eq!(row.len(), stages.len());
            for (parts, stage) in row.iter().zip(*stages) {
                dense.a[i + 1][stage - 1] = f64::from_parts(parts);
            }
        }
        for (j, stage) in WEIGHTED.into_iter().enumerate() {
            dense.eight[stage - 1] = f64::from_parts(&B[j]);
            dense.five[stage - 1] = f64::from_parts(&B[j]) - f64::from_parts(&E5[j]);
        }
        for (j, stage) in [1, 9, 12].into_iter().enumerate() {
            dense.three[stage - 1] = f64::from_parts(&B3[j]);
        }
        dense
    }

    /// Conditions of order up to `order`: quadrature, and the trees with one branch and with a branch upon it.
    ///
    /// ```text
    /// sum b_i c_i^k = 1/(k+1)
    /// sum b_i c_i^m a_ij c_j^k = 1/((k+1) (k+m+2))
    /// sum b_i c_i^m a_ij c_j^n a_jl c_l^k = 1/((k+1) (k+n+2) (k+n+m+3))
    /// ```
    fn check(Dense { c, a, .. }: &Dense, b: &[f64; 12], order: i32) {
        let power = |x: f64, k: i32| Real::powi(x, k);
        let sum = |f: &dyn Fn(usize) -> f64| (0..12).map(f).sum::<f64>();
        let close = |sum: f64, denominator: i32| {
            assert!((sum - 1.0 / f64::from(denominator)).abs() < 2e-14, "{sum} instead of 1/{denominator}");
        };
        for k in 0..order {
            close(sum(&|i| b[i] * power(c[i], k)), k + 1);
            for m in 0..order - k - 1 {
                let inner = |i: usize| sum(&|j| a[i][j] * power(c[j], k));
                close(sum(&|i| b[i] * power(c[i], m) * inner(i)), (k + 1) * (k + m + 2));
                for n in 0..order - k - m - 2 {
                    let middle = |i: usize| sum(&|j| a[i][j] * power(c[j], n) * inner(j));
                    let denominator = (k + 1) * (k + n + 2) * (k + n + m + 3);
                    close(sum(&|i| b[i] * power(c[i], m) * middle(i)), denominator);
                }
            }
        }
    }

    #[test]
    fn the_formula_meets_the_conditions_of_order_eight() {
        let dense = dense();
        check(&dense, &dense.eight, 8);
    }

    #[test]
    fn the_embedded_formulas_meet_the_conditions_of_orders_five_and_three() {
        let dense = dense();
        check(&dense, &dense.five, 5);
        check(&dense, &dense.three, 3);
    }
}
