//! Lanes against plain `f64`: the same bits from every operation, in every backend that this processor has.

use guen_runtime::lanes::{Backend, LaneTask, Lanes, Mask, Width, dispatch_on};
use guen_runtime::{Approx7, Approx13, Dual, Fused, Lift, Real};

/// Numbers of every kind: even, tiny, huge, next to multiples of `pi/2`, special.
fn numbers() -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut draw = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut numbers = Vec::new();
    // Miri is some thousand times as slow, and no number is special to it: it looks at memory.
    let count = if cfg!(miri) { 15 } else { 400 };
    for n in 0..count {
        numbers.push(20.0 * draw() - 10.0);
        numbers.push((draw() - 0.5) * (600.0 * draw() - 300.0).exp2());
        numbers.push(f64::from(n * 331) * std::f64::consts::FRAC_PI_2);
        numbers.push(524_288.0 * (draw() - 0.5));
    }
    let limit = 262_144.0_f64;
    let special =
        [0.0, 1.0, limit, limit.next_up(), 1e300, f64::MIN_POSITIVE, 5e-324, f64::INFINITY, f64::NAN];
    // Between ordinary ones, so that they share registers; an odd number apart, so that they come into every lane.
    let apart = (numbers.len() / (2 * special.len()) - 1) | 1;
    for (i, x) in special.into_iter().enumerate() {
        numbers[2 * i * apart] = x;
        numbers[(2 * i + 1) * apart] = -x;
    }
    numbers
}

/// Everything that a real can do with three numbers, as numbers.
fn everything<R: Real>(a: R, b: R, c: R) -> Vec<R> {
    let (sin, cos) = a.sin_cos();
    let (first, second) = R::sin_cos_pair(b, c);
    let mut assigned = a;
    assigned += b;
    assigned *= c;
    assigned -= b;
    assigned /= c;
    vec![
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        assigned,
        sin,
        cos,
        first.0,
        first.1,
        second.0,
        second.1,
        a.sin(),
        a.cos(),
        a.tan(),
        a.cot(),
        a.asin(),
        a.acos(),
        a.atan(),
        a.atan2(b),
        a.sinh(),
        a.cosh(),
        a.tanh(),
        a.exp(),
        a.ln(),
        a.sqrt(),
        a.root(2),
        a.root(3),
        a.root(7),
        a.abs(),
        a.sign(),
        a.powi(3),
        a.powi(-2),
        a.recip(),
        a.times_plus(b, c),
        a.times_minus(b, c),
        a.minus_times(b, c),
        a.where_above(b, c, a),
        R::each_alone(|alone| alone(b) - alone(c)),
        R::from_ratio(1, 3),
        R::from_parts(&[(3, -1)]),
        R::from_f64(0.1),
        R::pi(),
        R::epsilon(),
        R::zero(),
        R::one(),
        R::default(),
    ]
}

fn same(lane: f64, number: f64) -> bool {
    lane.to_bits() == number.to_bits() || (lane.is_nan() && number.is_nan())
}

/// Compares what lanes give with what numbers give, where `wrap` and `wrap_lanes` make the real in question.
fn compare<L: Lanes, R: Real, T: Real>(
    wrap: impl Fn(f64) -> R,
    number: impl Fn(R) -> f64,
    wrap_lanes: impl Fn(L) -> T,
    lanes: impl Fn(T) -> L,
) {
    let numbers = numbers();
    let others = |shift: usize, i: usize| numbers[(i + shift) % numbers.len()];
    for first in (0..numbers.len() - L::COUNT).step_by(L::COUNT) {
        let group = |shift: usize| wrap_lanes(L::from_fn(|lane| others(shift, first + lane)));
        let got = everything(group(0), group(501), group(77));
        for lane in 0..L::COUNT {
            let one = |shift: usize| wrap(others(shift, first + lane));
            let expected = everything(one(0), one(501), one(77));
            for (k, (got, expected)) in got.iter().zip(expected).enumerate() {
                let (got, expected) = (lanes(*got).lane(lane), number(expected));
                let x = others(0, first + lane);
                assert!(same(got, expected), "operation {k} of {x:e} in lane {lane}: {got:e} {expected:e}");
            }
        }
    }
}

struct Bits;

impl LaneTask for Bits {
    type Output = usize;

    fn run<L: Lanes>(self) -> usize {
        compare::<L, f64, L>(|x| x, |x| x, |x| x, |x| x);
        compare::<L, _, _>(Approx13::new, |x| x.value, Approx13::new, |x| x.value);
        compare::<L, _, _>(Approx7::new, |x| x.value, Approx7::new, |x| x.value);
        compare::<L, _, _>(Fused::new, |x| x.value, Fused::new, |x| x.value);
        compare::<L, Dual<f64, 1>, Dual<L, 1>>(
            |x| Dual { value: x, tangent: [1.5] },
            |x| x.tangent[0],
            |x| Dual { value: x, tangent: [L::from_f64(1.5)] },
            |x| x.tangent[0],
        );
        L::COUNT
    }
}

#[test]
fn every_operation_gives_the_bits_of_numbers() {
    // Miri is slow, and what falls back to arrays there is what was just seen.
    let again = |backend: &Backend| !cfg!(miri) || backend.is_available();
    for backend in Backend::ALL.into_iter().filter(again) {
        for width in [Width::One, Width::Four, Width::Eight] {
            // One that is not available falls back to arrays, which is right, too.
            assert_eq!(dispatch_on(backend, width, Bits), width.lanes());
        }
        println!("{backend:?}: {}", if backend.is_available() { "tested" } else { "not on this processor" });
    }
    assert!(Backend::best().is_available());
}

struct Properties;

impl LaneTask for Properties {
    type Output = ();

    fn run<L: Lanes>(self) {
        let numbers = L::from_fn(|i| i as f64);
        assert_eq!(numbers.to_f64(), 0.0);
        assert!(numbers == L::from_fn(|i| i as f64) && numbers != L::from_fn(|_| 0.5));
        assert_eq!(numbers.finite(), Mask::all(L::COUNT));
        assert!(numbers.is_finite());
        for bad in 0..L::COUNT {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let spoilt = L::from_fn(|i| if i == bad { value } else { i as f64 });
                assert!(!spoilt.is_finite());
                assert_eq!(Mask::all(L::COUNT) - spoilt.finite(), Mask::from_bits(1 << bad));
                // The neighbours do not notice.
                let sine = spoilt.sin();
                for i in (0..L::COUNT).filter(|i| *i != bad) {
                    assert_eq!(sine.lane(i), Real::sin(i as f64));
                }
            }
        }
        let lifted: Dual<L, 2> = Lift::lift(2.5);
        assert_eq!(lifted.value, L::from_f64(2.5));
        let shown = format!("{:?}", L::from_f64(1.5));
        assert_eq!(shown.matches("1.5").count(), L::COUNT);
    }
}

#[test]
fn lanes_are_told_apart() {
    for backend in Backend::ALL {
        for width in [Width::One, Width::Four, Width::Eight] {
            dispatch_on(backend, width, Properties);
        }
    }
}

#[test]
fn masks_are_sets() {
    assert_eq!(Mask::all(0), Mask::default());
    assert_eq!(Mask::all(32).bits(), u32::MAX);
    let mask = Mask::from_bits(0b1010);
    assert_eq!(mask.lanes().collect::<Vec<_>>(), [1, 3]);
    assert_eq!(mask & Mask::all(2), Mask::from_bits(0b10));
    assert!(!mask.contains(0) && mask.contains(3) && !mask.contains(40));
}
