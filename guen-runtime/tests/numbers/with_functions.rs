//! Reals with exchanged functions: their errors, their place in duals, and that fused operations are fused.

use f256::f256;
use guen_runtime::steppers::Rk4;
use guen_runtime::{Approx7, Approx13, Dual, Functions, Fused, Lift, Real, WithFunctions, from_fn};

/// Numbers over the range in which the polynomials serve themselves, its ends included, and beyond.
fn arguments() -> impl Iterator<Item = f64> {
    let mut state = 1_u64;
    let even = (0..20_000).map(move |i| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let part = (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        part * [3.2, 100.0, 262_144.0, 1e9][i % 4]
    });
    even.chain([0.0, -0.0, 262_144.0, -262_144.0, 1e300])
}

/// The largest absolute errors against the accurate functions, which err by 1e-16.
fn largest<F: Functions<f64>>() -> (f64, f64) {
    arguments().fold((0.0, 0.0), |(in_sin, in_cos), x| {
        let (sin, cos) = WithFunctions::<f64, F>::new(x).sin_cos();
        let exact = Real::sin_cos(x);
        (f64::max(in_sin, (sin.value - exact.0).abs()), f64::max(in_cos, (cos.value - exact.1).abs()))
    })
}

#[test]
fn polynomials_err_as_stated() {
    let thirteen = largest::<guen_runtime::Approx13Functions>();
    let seven = largest::<guen_runtime::Approx7Functions>();
    println!("Approx13: sin {:.2e}, cos {:.2e}", thirteen.0, thirteen.1);
    println!("Approx7:  sin {:.2e}, cos {:.2e}", seven.0, seven.1);
    assert!(thirteen.0 < 1e-13 && thirteen.1 < 1e-13);
    assert!(seven.0 < 4e-8 && seven.1 < 4e-8);
    // They are what they are said to be, and not the accurate ones.
    assert!(thirteen.1 > 1e-14 && seven.1 > 1e-8);
    assert!(Approx7::new(-0.0).sin().value.is_sign_negative());
    assert!(Approx13::new(f64::INFINITY).sin().value.is_nan());
}

#[test]
fn duals_take_the_exchanged_functions() {
    let x = Dual::<Approx7, 1>::variable(Approx7::new(1.1), 0);
    let (sin, cos) = Approx7::new(1.1).sin_cos();
    assert_eq!(x.sin_cos(), (Dual { value: sin, tangent: [cos] }, Dual { value: cos, tangent: [-sin] }));
    let nested: Dual<Dual<Fused, 2>, 1> = Lift::lift(0.25);
    assert_eq!(nested.value.value, Fused::new(0.25));
}

#[test]
fn fused_operations_round_once() {
    let mut differ = 0;
    for (a, b) in arguments().zip(arguments().skip(1)) {
        let c = -a * b;
        let exact = |x: f64, y: f64, z: f64| f256::from(x) * f256::from(y) + f256::from(z);
        let [fa, fb, fc] = [a, b, c].map(Fused::new);
        for (got, expected) in [
            (fa.times_plus(fb, fc), exact(a, b, c)),
            (fa.times_minus(fb, fc), exact(a, b, -c)),
            (fc.minus_times(fa, fb), exact(-a, b, c)),
        ] {
            // The rounding of a sum of products cancels itself: what is left is exact, or half an ulp off.
            let error = (f256::from(got.value) - expected).abs();
            let half = f256::from(got.value.abs()) * f256::from(f64::EPSILON / 2.0);
            assert!(error <= half, "{a:e} {b:e} {c:e}");
        }
        differ += u32::from(a.times_plus(b, c) != fa.times_plus(fb, fc).value);
    }
    assert!(differ > 10_000, "plain operations round twice");
}

#[test]
fn a_dual_fuses_what_its_real_fuses() {
    let [x, y, z] = [1.0 + f64::EPSILON, 1.0 + f64::EPSILON, -1.0 - 2.0 * f64::EPSILON];
    let dual = |x: f64| Dual::<Fused, 1>::variable(Fused::new(x), 0);
    let sum = dual(x).times_plus(dual(y), dual(z));
    assert_eq!(sum.value.value, f64::EPSILON * f64::EPSILON);
    assert_eq!(sum.tangent[0].value, x + y + 1.0);
    let plain = |x: f64| Dual::<f64, 1>::variable(x, 0);
    for (a, b) in [
        (plain(x).times_plus(plain(y), plain(z)), plain(x) * plain(y) + plain(z)),
        (plain(x).times_minus(plain(y), plain(z)), plain(x) * plain(y) - plain(z)),
        (plain(x).minus_times(plain(y), plain(z)), plain(x) - plain(y) * plain(z)),
    ] {
        assert_eq!(a, b);
    }
}

#[test]
fn steppers_take_reals_with_other_functions() {
    let pendulum = from_fn(|_t: Approx13, &[q, w]: &[Approx13; 2]| [w, -q.sin()]);
    let start = [1.0, 0.0].map(Approx13::new);
    let method = Rk4::new(Approx13::new(0.01));
    let [zero, one] = [0.0, 1.0].map(Approx13::new);
    let done =
        method.integrate(&pendulum, zero, &start, one, |_, _| core::ops::ControlFlow::Continue(())).unwrap();
    let exact = from_fn(|_t: f64, &[q, w]: &[f64; 2]| [w, -Real::sin(q)]);
    let reference = Rk4::new(0.01)
        .integrate(&exact, 0.0, &[1.0, 0.0], 1.0, |_, _| core::ops::ControlFlow::Continue(()))
        .unwrap();
    assert!((done.state[0].value - reference.state[0]).abs() < 1e-13);
}

#[cfg(feature = "std")]
#[test]
fn the_platforms_functions() {
    use guen_runtime::Std;
    for x in [-0.7, 0.3, 0.9_f64] {
        let y = Std::new(x);
        assert_eq!(y.sin_cos(), (Std::new(x.sin()), Std::new(x.cos())));
        assert_eq!((y.tan().value, y.exp().value, y.asin().value), (x.tan(), x.exp(), x.asin()));
        assert_eq!(y.atan2(Std::new(2.0)).value, x.atan2(2.0));
        assert_eq!(Std::new(x as f32).tanh().value, (x as f32).tanh());
    }
}
