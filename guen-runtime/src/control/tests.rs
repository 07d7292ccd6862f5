//! Feedback and estimation against what they are defined by: the eigenvalues of the Hamiltonian and of the symplectic matrix, the
//! equations themselves, costs that are summed along a motion, and closed forms.

extern crate std;
use std::vec::Vec;

use super::*;
use crate::linear_algebra::dense::{apply, dot, largest, product, solve, transpose, unit};
use crate::system::derivatives::linearization::{Linearizable, Linearization};

type Square<const N: usize> = [[f64; N]; N];

/// A sequence of numbers between -1 and 1.
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn matrix<const N: usize, const M: usize>(&mut self) -> [[f64; M]; N] {
        core::array::from_fn(|_| core::array::from_fn(|_| self.next()))
    }

    /// `F F^T`, of rank `M`, and a little of the unit matrix.
    fn weight<const N: usize, const M: usize>(&mut self, little: f64) -> Square<N> {
        let f: [[f64; M]; N] = self.matrix();
        let mut weight = product(&f, &transpose(&f));
        (0..N).for_each(|i| weight[i][i] += little);
        weight
    }
}

/// The matrix of four blocks.
fn of_blocks<const N: usize, const TWICE: usize>(blocks: [[Square<N>; 2]; 2]) -> Square<TWICE> {
    core::array::from_fn(|i| core::array::from_fn(|j| blocks[i / N][j / N][i % N][j % N]))
}

fn linear_sum<const N: usize>(terms: &[(f64, Square<N>)]) -> Square<N> {
    core::array::from_fn(|i| core::array::from_fn(|j| terms.iter().map(|(factor, m)| factor * m[i][j]).sum()))
}

/// `B R^-1 B^T`.
fn effort<const N: usize, const M: usize>(b: &[[f64; M]; N], r: &Square<M>) -> Square<N> {
    product(&product(b, &solve(r, &unit()).unwrap()), &transpose(b))
}

/// Each pole of `few` is among `many`, to so much.
fn assert_among(few: &[Pole<f64>], many: &[Pole<f64>], most: f64) {
    for pole in few {
        let distance = |other: &Pole<f64>| (pole.re - other.re).hypot(pole.im - other.im);
        let nearest = many.iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest < most * (1.0 + pole.magnitude()), "{pole:?} is {nearest:e} off {many:?}");
    }
}

#[test]
fn continuous_feedback_has_the_stable_poles_of_the_hamiltonian() {
    let mut draw = Sequence(1);
    for _ in 0..60 {
        let (a, b): (Square<4>, [[f64; 2]; 4]) = (draw.matrix(), draw.matrix());
        let (q, r) = (draw.weight::<4, 2>(1e-3), draw.weight::<2, 2>(0.1));
        let linear = Linearization { a, b };
        let regulator = lqr(&linear, &q, &r).unwrap();
        let (p, g) = (regulator.cost, effort(&b, &r));
        let (at_p, p_a, pgp) = (product(&transpose(&a), &p), product(&p, &a), product(&p, &product(&g, &p)));
        let residual = linear_sum(&[(1.0, at_p), (1.0, p_a), (-1.0, pgp), (1.0, q)]);
        let terms = largest(pgp.iter().chain(&p_a).chain(&q).flatten().copied());
        let left = largest(residual.iter().flatten().copied());
        assert!(left < 1e-13 * terms, "{left:e} of {terms:e}");
        let minus = |m: Square<4>| m.map(|row| row.map(|x| -x));
        let hamiltonian: Square<8> = of_blocks([[a, minus(g)], [minus(q), minus(transpose(&a))]]);
        let closed = poles(&regulator.closed_loop(&linear)).unwrap();
        assert!(closed[0].re < 0.0);
        assert_among(&closed, &poles(&hamiltonian).unwrap(), 1e-7);
    }
}

#[test]
fn discrete_feedback_has_the_stable_poles_of_the_symplectic_matrix() {
    let mut draw = Sequence(2);
    for _ in 0..60 {
        let (a, b): (Square<4>, [[f64; 2]; 4]) = (draw.matrix(), draw.matrix());
        let (q, r) = (draw.weight::<4, 2>(1e-3), draw.weight::<2, 2>(0.1));
        let linear = Linearization { a, b };
        let regulator = dlqr(&linear, &q, &r).unwrap();
        let closed = regulator.closed_loop(&linear);
        let found = poles(&closed).unwrap();
        assert!(found.iter().all(|pole| pole.magnitude() < 1.0));
        let Some(inverse) = solve(&transpose(&a), &unit()) else { continue };
        let (g, minus) = (effort(&b, &r), |m: Square<4>| m.map(|row| row.map(|x| -x)));
        let corner = linear_sum(&[(1.0, a), (1.0, product(&g, &product(&inverse, &q)))]);
        let symplectic: Square<8> =
            of_blocks([[corner, minus(product(&g, &inverse))], [minus(product(&inverse, &q)), inverse]]);
        assert_among(&found, &poles(&symplectic).unwrap(), 1e-6);
        // What the motion from some deviation costs.
        let start: [f64; 4] = core::array::from_fn(|_| draw.next());
        let (mut x, mut cost) = (start, 0.0);
        for _ in 0..5_000 {
            let u = regulator.feedback(&x);
            cost += dot(&x, &apply(&q, &x)) + dot(&u, &apply(&r, &u));
            x = apply(&closed, &x);
        }
        let said = dot(&start, &apply(&regulator.cost, &start));
        assert!((cost - said).abs() < 1e-11 * said, "{cost} {said}");
    }
}

#[test]
fn stiff_and_slow_models_keep_their_digits() {
    // Two models that do not know of each other, with time constants 1e12 apart: k = a + sqrt(a^2 + q) each.
    let (quick, slow) = (-1e8, 1e-4);
    let linear = Linearization { a: diagonal([quick, slow]), b: unit::<f64, 2>() };
    let regulator = lqr(&linear, &diagonal([1.0, 1e-6]), &unit()).unwrap();
    let gain = |a: f64, q: f64| if a > 0.0 { a + (a * a + q).sqrt() } else { q / ((a * a + q).sqrt() - a) };
    assert!((regulator.gain[0][0] / gain(quick, 1.0) - 1.0).abs() < 1e-13, "{regulator:?}");
    assert!((regulator.gain[1][1] / gain(slow, 1e-6) - 1.0).abs() < 1e-9, "{regulator:?}");
    // A mode that dies out by itself needs neither input nor weight.
    let dying = Linearization { a: diagonal([1.0, -1e-6]), b: [[1.0], [0.0]] };
    let regulator = lqr(&dying, &diagonal([0.1, 0.0]), &[[1.0]]).unwrap();
    assert!((regulator.gain[0][0] - 1.0 - 1.1_f64.sqrt()).abs() < 1e-13 && regulator.gain[0][1] == 0.0);
    // Nothing costs anything, and nothing has to be done.
    assert_eq!(lqr(&dying_only(), &[[0.0]], &[[1.0]]).unwrap().gain, [[0.0]]);
}

fn dying_only() -> Linearization<f64, 1, 1> {
    Linearization { a: [[-2.0]], b: [[1.0]] }
}

#[test]
fn what_no_gain_stabilises_is_an_error() {
    let both = |linear: &Linearization<f64, 2, 1>, q: Square<2>| {
        [lqr(linear, &q, &[[1.0]]).map(|_| ()), dlqr(linear, &q, &[[1.0]]).map(|_| ())]
    };
    // Out of reach, and unstable as a continuous and as a discrete model.
    let unreached = Linearization { a: diagonal([-0.5, 1.5]), b: [[1.0], [0.0]] };
    assert_eq!(both(&unreached, unit()), [Err(RiccatiError::NotStabilizable); 2]);
    // In reach and without weight.
    let reached = Linearization { a: diagonal([-0.5, 1.5]), b: [[1.0], [1.0]] };
    assert_eq!(both(&reached, diagonal([1.0, 0.0])), [Err(RiccatiError::NotStabilizable); 2]);
    assert_eq!(both(&reached, unit()), [Ok(()); 2]);
    // A nonholonomic robot at rest: sideways nothing moves.
    let sideways = Linearization { a: [[0.0; 2]; 2], b: [[1.0], [0.0]] };
    assert_eq!(lqr(&sideways, &unit(), &[[1.0]]), Err(RiccatiError::NotStabilizable));
    // Oscillators without weight neither decay nor grow, beside what does decay, too.
    for frequency in [0.3, 1.0, 7.0, 1e4] {
        let swinging = Linearization { a: [[0.0, frequency], [-frequency, 0.0]], b: [[0.0], [1.0]] };
        assert_eq!(lqr(&swinging, &diagonal([0.0; 2]), &[[1.0]]), Err(RiccatiError::NotStabilizable));
        let turning = c2d(&swinging, 0.1).unwrap();
        assert_eq!(dlqr(&turning, &diagonal([0.0; 2]), &[[1.0]]), Err(RiccatiError::NotStabilizable));
    }
    let beside =
        Linearization { a: [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1e-3]], b: [[0.0], [1.0], [1.0]] };
    assert_eq!(lqr(&beside, &diagonal([0.0, 0.0, 1.0]), &[[1.0]]), Err(RiccatiError::NotStabilizable));
}

/// A charge on a spring beside a wall that attracts it, `x'' = d^3/(8 (d - x)^2) - x`, in lengths of `d`: at rest in `x = (3 - sqrt 5) d/4`.
struct Attracted(f64);

impl Linearizable<f64, 2, 1> for Attracted {
    fn rates(&self, _t: f64, [x, v]: &[f64; 2], [u]: &[f64; 1]) -> [f64; 2] {
        let Attracted(d) = *self;
        [*v, d * d * d / (8.0 * (d - x) * (d - x)) - x + u]
    }

    fn linearization(&self, _t: f64, [x, _]: &[f64; 2], _: &[f64; 1]) -> Linearization<f64, 2, 1> {
        let Attracted(d) = *self;
        let slope = d * d * d / (4.0 * (d - x).powi(3)) - 1.0;
        Linearization { a: [[0.0, 1.0], [slope, 0.0]], b: [[0.0], [1.0]] }
    }
}

#[test]
fn equilibria_have_all_digits_in_small_units_and_in_large_ones() {
    let still = SteadyMotion { drifting: [false; 2], fixed_states: [false; 2], fixed_inputs: [true] };
    for d in [1e-12, 1e-9, 1e-6, 1.0, 1e6] {
        for guess in [0.0, 0.1, 0.3] {
            let ([x, v], _) = steady(&Attracted(d), 0.0, &[guess * d, 0.5 * d], &[0.0], &still).unwrap();
            let expected = (3.0 - 5.0_f64.sqrt()) / 4.0;
            assert!((x / d - expected).abs() < 1e-12 && v == 0.0, "{} at {d:e}", x / d);
        }
    }
}

#[test]
fn weights_that_are_none_are_refused() {
    let linear = Linearization { a: unit::<f64, 2>(), b: unit::<f64, 2>() };
    let of =
        |q: Square<2>, r: Square<2>| [lqr(&linear, &q, &r).unwrap_err(), dlqr(&linear, &q, &r).unwrap_err()];
    assert_eq!(of(unit(), [[1.0, 0.0], [0.0, 0.0]]), [RiccatiError::NotDefinite; 2]);
    assert_eq!(of(unit(), [[1.0, 2.0], [2.0, 1.0]]), [RiccatiError::NotDefinite; 2]);
    assert_eq!(of(unit(), [[1.0, 0.5], [0.0, 1.0]]), [RiccatiError::NotDefinite; 2]);
    assert_eq!(of(diagonal([1.0, -1.0]), unit()), [RiccatiError::NotSemidefinite; 2]);
    assert_eq!(of([[1.0, 1.0], [0.0, 1.0]], unit()), [RiccatiError::NotSemidefinite; 2]);
    assert_eq!(of(diagonal([f64::NAN, 1.0]), unit()), [RiccatiError::NotFinite; 2]);
}

#[test]
fn filters_are_the_regulators_of_the_transposed_model() {
    let mut draw = Sequence(3);
    for _ in 0..50 {
        let (a, c): (Square<3>, [[f64; 3]; 2]) = (draw.matrix(), draw.matrix());
        let (w, v) = (draw.weight::<3, 1>(1e-2), draw.weight::<2, 2>(0.1));
        let Observer { gain, covariance: p } = dkalman(&a, &c, &w, &v).unwrap();
        // A correction and a prediction lead to the same covariance.
        let corrected = linear_sum(&[(1.0, p), (-1.0, product(&gain, &product(&c, &p)))]);
        let again =
            linear_sum(&[(1.0, product(&a, &product(&corrected, &transpose(&a)))), (1.0, w), (-1.0, p)]);
        assert!(largest(again.iter().flatten().copied()) < 1e-12 * largest(p.iter().flatten().copied()));
        // The error of the estimate dies out.
        let Observer { gain, .. } = kalman(&a, &c, &w, &v).unwrap();
        let error = linear_sum(&[(1.0, a), (-1.0, product(&gain, &c))]);
        assert!(poles(&error).unwrap()[0].re < 0.0);
    }
}

#[test]
fn poles_are_where_they_were_placed() {
    let mut draw = Sequence(4);
    for round in 0..200 {
        let linear = Linearization::<f64, 5, 1> { a: draw.matrix(), b: draw.matrix() };
        let [above, below] = Pole::oscillation(1.0 + draw.next().abs(), 0.5);
        let real = || Pole::real(-1.0);
        // Pairs apart from each other, and a double one.
        let wanted = if round % 2 == 0 {
            [above, Pole::real(-3.0), below, Pole::real(-2.0), real()]
        } else {
            [Pole::real(-2.0), real(), above, real(), below]
        };
        let Ok(gain) = place(&linear, &wanted) else { panic!("{linear:?}") };
        let closed = Regulator { gain: [gain], cost: unit() }.closed_loop(&linear);
        // The characteristic polynomial at points of the plane, by which double poles are no worse than single ones.
        for z in [0.0, 0.7, 2.5] {
            let value = determinant(linear_sum(&[(z, unit()), (-1.0, closed)]));
            let product: f64 = wanted.iter().fold(1.0, |product, pole| match pole.im > 0.0 {
                true => product * ((z - pole.re).powi(2) + pole.im * pole.im),
                false if pole.im < 0.0 => product,
                false => product * (z - pole.re),
            });
            let scale = 1.0 + largest(gain.iter().copied());
            assert!((value - product).abs() < 1e-9 * scale * product, "{value} {product} {gain:?}");
        }
    }
    let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0]] };
    let [above, _] = Pole::oscillation(1.0, 0.5);
    assert_eq!(place(&mass, &[Pole::real(-1.0), above]), Err(PlaceError::Unpaired { pole: 1 }));
    assert_eq!(place(&mass, &[above, above]), Err(PlaceError::Unpaired { pole: 0 }));
    assert_eq!(place(&mass, &[Pole::real(f64::NAN); 2]), Err(PlaceError::NotFinite));
    let stuck = Linearization { a: unit::<f64, 2>(), b: [[1.0], [0.0]] };
    assert!(matches!(place(&stuck, &[Pole::real(-1.0); 2]), Err(PlaceError::Uncontrollable(_))));
}

/// Returns the determinant, by elimination with row pivots.
fn determinant<const N: usize>(mut m: Square<N>) -> f64 {
    let mut value = 1.0;
    for k in 0..N {
        let pivot = (k..N).max_by(|i, j| m[*i][k].abs().total_cmp(&m[*j][k].abs())).unwrap();
        if pivot != k {
            m.swap(pivot, k);
            value = -value;
        }
        value *= m[k][k];
        for i in k + 1..N {
            let factor = m[i][k] / m[k][k];
            (k..N).for_each(|j| m[i][j] -= factor * m[k][j]);
        }
    }
    value
}

#[test]
fn poles_come_in_order() {
    let a = diagonal([-3.0, 2.0, -1.0]);
    let found: Vec<f64> = poles(&a).unwrap().iter().map(|pole| pole.re).collect();
    assert_eq!(found, [2.0, -1.0, -3.0]);
    assert_eq!(poles(&[[f64::NAN]]), None);
}

/// A slow mode beside fast ones: `exp(-h)` and what an input makes of it, also in a basis that mixes them.
#[test]
fn slow_modes_keep_their_digits_beside_fast_ones() {
    for fast in [1.0, 30.0, 1e3, 1e6, 1e9, 1e12, 1e15] {
        let stiff = Linearization { a: diagonal([-fast, -1.0]), b: [[fast], [1.0]] };
        let Linearization { a, b } = c2d(&stiff, 1.0).unwrap();
        let slow = libm::exp(-1.0);
        assert!((a[1][1] - slow).abs() < 1e-15 * 4.0 && a[0][1] == 0.0, "{fast:e}: {a:?}");
        assert!((b[1][0] - (1.0 - slow)).abs() < 4e-15, "{fast:e}: {b:?}");
        assert!(
            (a[0][0] - libm::exp(-fast)).abs() < 4e-15 && (b[0][0] - (1.0 - libm::exp(-fast))).abs() < 4e-15
        );
        // x' = y, y' = -fast y - fast x: nearly x' = -x.
        if fast >= 1e3 {
            let coupled = Linearization { a: [[0.0, 1.0], [-fast, -fast]], b: [[0.0], [fast]] };
            let Linearization { a, b } = c2d(&coupled, 1.0).unwrap();
            let root = libm::sqrt(1.0 - 4.0 / fast);
            let rate = -2.0 / (1.0 + root);
            let wanted = libm::exp(rate) * (1.0 + root) / (2.0 * root);
            assert!((a[0][0] - wanted).abs() < 1e-13, "{fast:e}: {} {wanted}", a[0][0]);
            assert!((b[0][0] - (1.0 - wanted)).abs() < 1e-13, "{fast:e}: {b:?} {wanted}");
        }
    }
}

#[test]
fn nothing_is_reached_in_a_model_that_is_no_number() {
    for bad in [f64::NAN, f64::INFINITY] {
        let model = Linearization { a: [[0.0, bad], [0.0, 0.0]], b: [[0.0], [1.0]] };
        let found = controllability(&model, 1e-9);
        assert!(found.rank == 0 && found.modes().is_empty() && found.require().is_err());
        let model = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[bad], [1.0]] };
        assert_eq!(controllability(&model, 1e-9).rank, 0);
    }
}

#[test]
fn units_change_no_feedback() {
    // A cart that carries a pole, in the units of the first line, and in others: of states, of time, of the push.
    let a = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, -0.981, 0.0, 0.0], [0.0, 21.582, 0.0, 0.0]];
    let b = [[0.0], [0.0], [1.0], [-2.0]];
    let (q, r, c) = ([1.0, 10.0, 0.1, 0.1], 0.01, [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]);
    let wanted =
        [Pole { re: -2.0, im: 1.0 }, Pole { re: -2.0, im: -1.0 }, Pole::real(-5.0), Pole::real(-6.0)];
    let gains = |[states, [time, push, ..]]: [[f64; 4]; 2]| {
        let a: Square<4> =
            core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] * states[i] / states[j] / time));
        let b: [[f64; 1]; 4] = core::array::from_fn(|i| [b[i][0] * states[i] / push / time]);
        let linear = Linearization { a, b };
        let q = diagonal(core::array::from_fn(|i| q[i] / (states[i] * states[i])));
        let r = [[r / (push * push)]];
        let poles = wanted.map(|Pole { re, im }| Pole { re: re / time, im: im / time });
        let discrete = c2d(&linear, 0.01 * time).unwrap();
        let rows = [
            lqr(&linear, &q, &r).unwrap().gain[0],
            dlqr(&discrete, &q, &r).unwrap().gain[0],
            place(&linear, &poles).unwrap(),
        ];
        let c = c.map(|row| core::array::from_fn(|j| row[j] / states[j]));
        let noise = diagonal(core::array::from_fn(|i| 1e-3 * states[i] * states[i]));
        let slow = noise.map(|row| row.map(|x| x / time));
        let columns = [
            kalman(&a, &c, &slow, &diagonal([1e-4 * time; 2])).unwrap().gain.map(|row| row.map(|x| x * time)),
            dkalman(&discrete.a, &c, &noise, &diagonal([1e-4; 2])).unwrap().gain,
        ];
        let rows = rows.map(|row| core::array::from_fn::<_, 4, _>(|j| row[j] * states[j] / push));
        (rows, columns.map(|l| core::array::from_fn::<_, 4, _>(|i| l[i].map(|x| x / states[i]))))
    };
    let plain = gains([[1.0; 4]; 2]);
    for units in [
        [[1e9, 1.0, 1e9, 1.0], [1.0; 4]],
        [[1e-9, 1.0, 1e-9, 1.0], [1.0; 4]],
        [[1e12, 1.0, 1.0, 1.0], [1.0, 1e9, 1.0, 1.0]],
        [[1.0, 1.0, 1e-9, 1e-9], [1e9, 1e-12, 1.0, 1.0]],
        [[1.0, 1.0, 1e9, 1e9], [1e-9, 1.0, 1.0, 1.0]],
    ] {
        let found = gains(units);
        for (found, plain) in found.0.as_flattened().iter().zip(plain.0.as_flattened()) {
            assert!((found / plain - 1.0).abs() < 1e-10, "{units:?}: {found} {plain}");
        }
        for (found, plain) in found.1.as_flattened().iter().zip(plain.1.as_flattened()) {
            // The place of the pole and the cart's have little to do with each other.
            let most = plain.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(
                found.iter().zip(plain).all(|(x, y)| (x - y).abs() < 1e-10 * most),
                "{units:?}: {found:?} {plain:?}"
            );
        }
    }
}

#[test]
fn quick_oscillators_and_unlike_inputs_have_feedback() {
    // k_1 = w^2 (sqrt 2 - 1) and k_2 = w (sqrt(1 + 2 (sqrt 2 - 1)) without damping, by the equations of both entries.
    let root = 2_f64.sqrt();
    for w in [1.0, 1e6, 1e9, 1e12_f64] {
        let linear = Linearization { a: [[0.0, 1.0], [-w * w, 0.0]], b: [[0.0], [1.0]] };
        let [[k1, k2]] = lqr(&linear, &diagonal([1.0, 1.0 / (w * w)]), &[[w.powi(-4)]]).unwrap().gain;
        assert!((k1 / (w * w * (root - 1.0)) - 1.0).abs() < 1e-12, "{w:e}: {k1}");
        assert!((k2 / (w * (1.0 + 2.0 * (root - 1.0)).sqrt()) - 1.0).abs() < 1e-12, "{w:e}: {k2}");
    }
    // The second input has a billionth of the effect and of the square root of the weight.
    let linear = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0, 0.0], [1.0, 1e-9]] };
    let found = lqr(&linear, &unit(), &diagonal([1.0, 1e-18])).unwrap().gain;
    let both = lqr(&linear, &unit(), &unit()).unwrap_or_else(|error| panic!("{error}"));
    assert!(
        (found[0][0] - 0.5_f64.sqrt()).abs() < 1e-14 && (found[1][0] * 1e-9 - 0.5_f64.sqrt()).abs() < 1e-14
    );
    assert!((both.gain[0][0] - 1.0).abs() < 1e-14);
    // A weight that no sum of squares has.
    for q in [[[1.0, 2.0], [2.0, 1.0]], [[0.0, 2.0], [2.0, 0.0]]] {
        assert_eq!(lqr(&linear, &q, &unit()), Err(RiccatiError::NotSemidefinite));
    }
    // Of nothing there is nothing to place; and what decays may be left for ever.
    assert_eq!(place(&Linearization::<f64, 0, 1> { a: [], b: [] }, &[]), Ok([]));
    let long = c2d(&Linearization { a: [[-1.0]], b: [[2.0]] }, 1e30).unwrap();
    assert_eq!((long.a, long.b), ([[0.0]], [[2.0]]));
}

/// A light wheel on a spring and a heavy body with drag that is lifted: `J w' = torque - k q`, `M v' = push - v - M g`.
struct Unlike {
    inertia: f64,
    spring: f64,
    mass: f64,
    weight: f64,
}

impl Linearizable<f64, 4, 2> for Unlike {
    fn rates(&self, _t: f64, [q, _, w, v]: &[f64; 4], [torque, push]: &[f64; 2]) -> [f64; 4] {
        [*w, *v, (torque - self.spring * q) / self.inertia, (push - v) / self.mass - self.weight]
    }
    fn linearization(&self, _t: f64, _: &[f64; 4], _: &[f64; 2]) -> Linearization<f64, 4, 2> {
        let mut a = [[0.0; 4]; 4];
        (a[0][2], a[1][3], a[2][0], a[3][3]) = (1.0, 1.0, -self.spring / self.inertia, -1.0 / self.mass);
        Linearization { a, b: [[0.0; 2], [0.0; 2], [1.0 / self.inertia, 0.0], [0.0, 1.0 / self.mass]] }
    }
}

#[test]
fn units_decide_no_equilibrium() {
    let held = |fixed: [bool; 4], inputs| SteadyMotion {
        drifting: [false; 4],
        fixed_states: fixed,
        fixed_inputs: inputs,
    };
    for (inertia, spring, mass) in [
        (1.0, 1.0, 1.0),
        (1e-10, 1e-7, 1e4),
        (1e-14, 1e-9, 1.0),
        (1e10, 1e3, 1e-3),
        (1e20, 1.0, 1e20),
        (1e-20, 1e-19, 1.0),
    ] {
        let system = Unlike { inertia, spring, mass, weight: 9.81 };
        let start = [0.5, 3.0, 0.1, 0.2];
        let both = held([true, true, false, false], [false, false]);
        let (state, [torque, push]) = steady(&system, 0.0, &start, &[0.0, 0.0], &both).unwrap();
        assert_eq!(state, [0.5, 3.0, 0.0, 0.0]);
        assert!((torque / (0.5 * spring) - 1.0).abs() < 1e-14 && (push / (9.81 * mass) - 1.0).abs() < 1e-14);
        // The place of the wheel by its torque; nothing holds the body but its push, and that of the wheel is a family.
        let turned = held([false, true, false, false], [true, false]);
        let (state, _) = steady(&system, 0.0, &start, &[2.0 * spring, 0.0], &turned).unwrap();
        assert!((state[0] - 2.0).abs() < 1e-14 && state[2..] == [0.0, 0.0]);
        let open = held([false, true, false, false], [false, false]);
        assert_eq!(
            steady(&system, 0.0, &start, &[0.0, 0.0], &open),
            Err(SteadyError::Family { dimension: 1 })
        );
        let dropped = held([true, true, false, false], [false, true]);
        let error = steady(&system, 0.0, &start, &[0.0, 0.0], &dropped).unwrap_err();
        assert!(matches!(error, SteadyError::NotFound { residual } if residual > 0.1), "{error}");
    }
    // The weight times sin(pi) is a rounding error. It counts as zero, although no derivative shows its scale.
    let system = Unlike { inertia: 1.0, spring: 0.0, mass: 1.0, weight: 9.81 * core::f64::consts::PI.sin() };
    let none = held([true, true, false, false], [true, true]);
    assert!(steady(&system, 0.0, &[0.0; 4], &[0.0; 2], &none).is_ok());
}

#[test]
fn units_of_combinations_decide_no_leaf() {
    // x = 2 y, told in picometres, and y = 3 z.
    for unit in [1.0, 1e-12, 1e12] {
        let leaf = Leaf {
            coordinates: [0.0; 3],
            velocities: [0.0; 3],
            rows: [[unit, -2.0 * unit, 0.0], [0.0, 1.0, -3.0]],
            quaternions: &[],
            independent: [false, false, true],
            names: &["x", "y", "z"],
        };
        let linear = Linearization { a: [[0.0; 3]; 3], b: [[6.0], [3.0], [1.0]] };
        let reduced =
            leaf.reduce::<3, 1, 1>(&linear, &[0.0; 3]).unwrap_or_else(|error| panic!("{unit:e}: {error}"));
        let lifted: [f64; 3] = reduced.lift(&[1.0]);
        assert!(
            lifted.iter().zip([6.0, 3.0, 1.0]).all(|(x, y)| (x - y).abs() < 1e-14),
            "{unit:e}: {lifted:?}"
        );
    }
}

/// Two rates with one zero, and rounding errors in the derivatives by another state.
struct Doubled;

impl Linearizable<f64, 2, 1> for Doubled {
    fn rates(&self, _t: f64, [x, _]: &[f64; 2], _: &[f64; 1]) -> [f64; 2] {
        [1.0 - x, 2.0 * (1.0 - x)]
    }
    fn linearization(&self, _t: f64, _: &[f64; 2], _: &[f64; 1]) -> Linearization<f64, 2, 1> {
        Linearization { a: [[-1.0, 1e-17], [-2.0, 3e-17]], b: [[0.0]; 2] }
    }
}

#[test]
fn rounding_errors_hold_no_state() {
    let request = SteadyMotion { drifting: [false; 2], fixed_states: [false; 2], fixed_inputs: [true] };
    let found = steady(&Doubled, 0.0, &[0.0, 0.0], &[0.0], &request);
    assert_eq!(found, Err(SteadyError::Family { dimension: 1 }));
}
