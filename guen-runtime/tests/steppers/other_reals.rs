//! Every method in other reals: single precision, and 71 digits, where errors show the digits of the coefficients.

use core::ops::ControlFlow;

use f256::f256;
use guen_runtime::prelude::*;
use guen_runtime::steppers::Method;
use guen_runtime::{Equations, Generic, generic};

/// A number of 237 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Long(f256);

crate::wrapper::operators!(Long);

/// What the problems below need; they have sines and cosines and nothing else.
macro_rules! not_needed {
    ($($method:ident)*) => {
        $(fn $method(self) -> Self {
            unreachable!("no problem of this file needs it")
        })*
    };
}

impl Real for Long {
    fn from_ratio(num: i64, den: i64) -> Self {
        Self(f256::from(num) / f256::from(den))
    }
    fn from_f64(value: f64) -> Self {
        Self(f256::from(value))
    }
    fn to_f64(self) -> f64 {
        // Correctly rounded enough: the leading 17 digits, as text.
        format!("{:.17e}", self.0).parse().unwrap()
    }
    fn pi() -> Self {
        Self(::f256::consts::PI)
    }
    fn epsilon() -> Self {
        Self(f256::EPSILON)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn atan2(self, _: Self) -> Self {
        unreachable!("no problem of this file needs it")
    }
    fn root(self, _: u32) -> Self {
        unreachable!("no problem of this file needs it")
    }
    not_needed!(asin acos atan sinh cosh tanh exp ln sign);
}

/// `x' = x cos t`, `y' = -y x` with `x = exp(sin t)`: not linear, and smooth. `y` has no closed form.
struct Driven;

impl Equations<2> for Driven {
    fn rates<R: Real>(&self, t: R, &[x, y]: &[R; 2]) -> [R; 2] {
        [x * t.cos(), -(y * x)]
    }
}

type Problem = Generic<Driven>;

/// The end at `t = 1/2` in long arithmetic.
fn end<M: Method<Long, Problem, 2>>(method: &M) -> [Long; 2] {
    let one = Long::one();
    Integration::new(&generic(Driven), Long::zero(), &[one, one])
        .run(method, Long::from_ratio(1, 2))
        .unwrap()
        .state
}

fn off(a: &[Long; 2], b: &[Long; 2]) -> f64 {
    (a[0] - b[0]).to_f64().abs().max((a[1] - b[1]).to_f64().abs())
}

#[test]
fn orders_hold_far_below_the_precision_of_doubles() {
    fn check<M: Method<Long, Problem, 2>>(name: &str, order: f64, steps: i64, method: impl Fn(Long) -> M) {
        let at = |steps: i64| end(&method(Long::from_ratio(1, 2 * steps)));
        let (coarse, middle, fine) = (at(steps), at(2 * steps), at(4 * steps));
        let (first, second) = (off(&coarse, &middle), off(&middle, &fine));
        let measured = (first / second).log2();
        println!("{name}: order {measured:.2}, differences {first:.1e} and {second:.1e}");
        assert!((measured - order).abs() < 0.3, "{name}: {measured}");
    }
    check("RK4", 4.0, 16, Rk4::new);
    check("RK8", 8.0, 16, Rk8::new);
    check("Gauss 4", 4.0, 8, Gauss4::new);
    check("Gauss 6", 6.0, 8, Gauss6::new);
}

#[test]
fn dop853_is_right_to_the_digits_of_its_coefficients() {
    // DOP853's decimals fulfil their sums to 27 digits; x = exp(sin t) is known.
    let exact = Long(f256::exp(&Long::from_ratio(1, 2).sin().0));
    let rk8 = end(&Rk8::new(Long::from_ratio(1, 1000)))[0];
    let dop853 = end(&Dop853::new(1e-25, 1e-25))[0];
    let (rk8, dop853) = ((rk8 - exact).abs().to_f64(), (dop853 - exact).abs().to_f64());
    println!("RK8 {rk8:.1e}, DOP853 {dop853:.1e}");
    assert!(rk8 < 1e-26 && dop853 < 1e-23);
    // And where the coefficients end they differ: the bound above is not for nothing.
    assert!(rk8 > 1e-33);
}

#[test]
fn single_precision_reaches_its_own_accuracy_with_every_method() {
    /// `x'' = -x`
    struct Oscillator;
    impl Equations<2> for Oscillator {
        fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
            [v, -x]
        }
    }
    fn check<M: Method<f32, Generic<Oscillator>, 2>>(name: &str, method: &M) {
        let mut steps = 0;
        let mut observe = |_: f32, _: &[f32; 2]| {
            steps += 1;
            ControlFlow::Continue(())
        };
        let done = Integration::new(&generic(Oscillator), 0.0, &[0.0, 1.0])
            .observe(&mut observe)
            .run(method, 5.0)
            .unwrap();
        let off = (done.state[0] - 5.0_f32.sin()).abs();
        println!("{name}: {off:.1e} in {steps} steps");
        assert!(off < 2e-5, "{name}: {off:e}");
    }
    check("RK4", &Rk4::new(0.05));
    check("RK8", &Rk8::new(0.5));
    check("DOP853", &Dop853::new(1e-6, 1e-6));
    check("Tsit5", &Tsit5::new(1e-6, 1e-6));
    check("Gauss 4", &Gauss4::new(0.05));
    check("Gauss 6", &Gauss6::new(0.25));
    check("Radau 5", &Radau5::new(1e-5, 1e-5));
}
