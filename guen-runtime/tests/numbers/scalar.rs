//! A scalar with nothing but the required methods: what the provided ones do, and that steppers accept it.

use core::ops::ControlFlow;

use guen_runtime::steppers::{Dop853, Rk4};
use guen_runtime::{Lift, Real, from_fn};

#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Plain(f64);

crate::wrapper::operators!(Plain);

macro_rules! forward {
    ($($method:ident)*) => {
        $(fn $method(self) -> Self {
            Self(Real::$method(self.0))
        })*
    };
}

impl Real for Plain {
    fn from_ratio(num: i64, den: i64) -> Self {
        Self(Real::from_ratio(num, den))
    }
    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn pi() -> Self {
        Self(Real::pi())
    }
    fn epsilon() -> Self {
        Self(Real::epsilon())
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.0);
        (Self(sin), Self(cos))
    }
    fn atan2(self, x: Self) -> Self {
        Self(Real::atan2(self.0, x.0))
    }
    fn root(self, q: u32) -> Self {
        Self(Real::root(self.0, q))
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    forward!(asin acos atan sinh cosh tanh exp ln sqrt abs sign);
}

impl Lift<Plain> for Plain {
    fn lift(base: Plain) -> Plain {
        base
    }
}

#[test]
fn provided_methods_agree_with_those_of_floats() {
    for x in [-1.9, 0.3, 2.2] {
        assert_eq!(Plain(x).sin().0, Real::sin(x));
        assert_eq!(Plain(x).cos().0, Real::cos(x));
        assert!((Plain(x).tan().0 / Real::tan(x) - 1.0).abs() < 4.0 * f64::EPSILON);
        assert!((Plain(x).cot().0 / Real::cot(x) - 1.0).abs() < 4.0 * f64::EPSILON);
        assert_eq!(Plain(x).recip().0, 1.0 / x);
        assert_eq!(Plain(x).powi(7).0, Real::powi(x, 7));
    }
    assert_eq!((Plain::zero().0, Plain::one().0), (0.0, 1.0));
}

#[test]
fn provided_parts_agree_with_those_of_floats() {
    let numbers: [&[(i64, i32)]; 7] = [
        &[],
        &[(7_747_209_898_635_537, -163), (7_344_971_895_625_565_100, -228)],
        &[(1 << 62, 961)],
        &[((1 << 53) - 1, 971)],
        &[(-3, -1000), (1, -1074)],
        &[(1 << 62, -1130)],
        &[(0, 5000), (12, 0)],
    ];
    for parts in numbers {
        assert_eq!(Plain::from_parts(parts).0, f64::from_parts(parts), "{parts:?}");
    }
}

#[test]
fn steppers_accept_any_real() {
    let growth = from_fn(|_t: Plain, &[x]: &[Plain; 1]| [x]);
    let [t0, t1] = [Plain(0.0), Plain(1.0)];
    let go_on = |_: Plain, _: &[Plain; 1]| ControlFlow::Continue(());
    let done = Dop853::new(1e-12, 1e-12).integrate(&growth, t0, &[Plain(1.0)], t1, go_on).unwrap();
    assert!((done.state[0].0 - std::f64::consts::E).abs() < 1e-11);
    let done = Rk4::new(Plain(0.001)).integrate(&growth, t0, &[Plain(1.0)], t1, go_on).unwrap();
    assert!((done.state[0].0 - std::f64::consts::E).abs() < 1e-12);
    assert_eq!(done.statistics.accepted, 1000);
}
