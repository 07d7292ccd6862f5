//! The list of what is measured: each system with its constants, its counterpart by hand, and its states.

use guen::{Cost, Real, System};

use crate::random::Random;
use crate::{by_hand, systems};

/// A system to measure, its state of `N` entries.
pub trait Subject<const N: usize> {
    /// How it is called in tables and on command lines.
    const NAME: &'static str;
    /// The operations of one evaluation.
    const COST: Cost;
    /// The operations of its preparation.
    const PREPARE_COST: Cost;
    /// Its declaration.
    const DECLARATION: &'static str;
    /// The constants: names and exact values.
    const CONSTANTS: &'static [(&'static str, (i64, i64))];

    /// What the macro made of the declaration.
    fn declared<R: Real>() -> impl System<R, N>;

    /// The smallest program that we could write by hand.
    fn by_hand<R: Real>() -> impl System<R, N>;

    /// Shows all programs written by hand, the smallest first.
    fn all_by_hand(visitor: &mut impl ByHand<N>);

    /// A state as it occurs.
    fn state(random: &mut Random) -> [f64; N];

    /// A state close to where the equations, or terms of them, are singular.
    fn near_singular(random: &mut Random) -> [f64; N];
}

/// Somebody who looks at all programs of one system that were written by hand.
pub trait ByHand<const N: usize> {
    /// Looks at one; the note says how it does it, where there are several.
    fn program(&mut self, note: &str, program: impl System<f64, N>);
}

/// Somebody who looks at all subjects.
pub trait Visitor {
    /// Looks at one.
    fn visit<S: Subject<N>, const N: usize>(&mut self, subject: S);
}

macro_rules! subjects {
    ($(
        $name:literal: $subject:ident, $module:ident $system:ident $text:ident [$size:literal]
            { $($constant:ident = $num:literal / $den:literal),* }
            by $hand:expr, |$values:ident| $arguments:expr;
            $(or $note:literal by $other:expr;)*
            states { $($place:expr => $range:expr),* }
            near $($index:literal at $where:expr),*;
    )*) => {
        $(
            #[doc = concat!("The subject `", $name, "`.")]
            #[derive(Clone, Copy, Debug)]
            pub struct $subject;

            impl $subject {
                fn system<R: Real>() -> systems::$system<R> {
                    systems::$system { $($constant: R::from_ratio($num, $den)),* }
                }
            }

            impl Subject<$size> for $subject {
                const NAME: &'static str = $name;
                const COST: Cost = systems::$module::COST;
                const PREPARE_COST: Cost = systems::$module::PREPARE_COST;
                const DECLARATION: &'static str = systems::$text;
                const CONSTANTS: &'static [(&'static str, (i64, i64))] =
                    &[$((stringify!($constant), ($num, $den))),*];

                fn declared<R: Real>() -> impl System<R, $size> {
                    match Self::system::<R>().prepare() {
                        Ok(prepared) => prepared,
                        Err(_) => panic!("the constants of {} are in order", $name),
                    }
                }

                fn by_hand<R: Real>() -> impl System<R, $size> {
                    let $values = Self::system::<R>();
                    $hand($arguments)
                }

                fn all_by_hand(visitor: &mut impl ByHand<$size>) {
                    visitor.program("", Self::by_hand::<f64>());
                    $(
                        let $values = Self::system::<f64>();
                        visitor.program($note, $other($arguments));
                    )*
                }

                fn state(random: &mut Random) -> [f64; $size] {
                    let mut state = [0.0; $size];
                    $(for place in places(&state, $place) {
                        let (low, high) = $range;
                        state[place] = random.between(low, high);
                    })*
                    state
                }

                fn near_singular(random: &mut Random) -> [f64; $size] {
                    let mut state = Self::state(random);
                    $(state[$index] = $where + random.magnitude(1e-7, 1e-1);)*
                    state
                }
            }
        )*

        /// Shows all subjects to a visitor, the paper's first.
        pub fn visit_all(visitor: &mut impl Visitor) {
            $(visitor.visit($subject);)*
        }
    };
}

/// The entries of a state that a range is about.
trait Places {
    fn of(self, size: usize) -> core::ops::Range<usize>;
}

impl Places for core::ops::Range<usize> {
    fn of(self, _: usize) -> core::ops::Range<usize> {
        self
    }
}

impl Places for core::ops::RangeFull {
    fn of(self, size: usize) -> core::ops::Range<usize> {
        0..size
    }
}

fn places(state: &[f64], places: impl Places) -> core::ops::Range<usize> {
    places.of(state.len())
}

const QUARTER: f64 = core::f64::consts::FRAC_PI_2;

subjects! {
    "hoop": Hoop, hoop Hoop HOOP_TEXT [9] { a = 1/2, A = 1/8, C = 1/4, g = 981/100 }
        by by_hand::hoop, |c| [c.a, c.A, c.C, c.g];
        states { .. => (-2.0, 2.0), 0..1 => (0.3, 2.8) }
        near 0 at 0.0;
    "hoop-body": BodyHoop, body_hoop BodyHoop BODYHOOP_TEXT [9] { a = 1/2, A = 1/8, C = 1/4, g = 981/100 }
        by by_hand::hoop, |c| [c.a, c.A, c.C, c.g];
        states { .. => (-2.0, 2.0), 0..1 => (0.3, 2.8) }
        near 0 at 0.0;
    "hoop-rates": RateHoop, rate_hoop RateHoop RATEHOOP_TEXT [9] { a = 1/2, A = 1/8, C = 1/4, g = 981/100 }
        by by_hand::rate_hoop, |c| [c.a, c.A, c.C, c.g];
        states { .. => (-2.0, 2.0), 0..1 => (0.3, 2.8) }
        near 0 at 0.0;
    "sled": Sled, sled Sled SLED_TEXT [5] { m = 3/2, alpha = 1/4, beta = 1/8, k = 1/2, incline = 1/5, g = 981/100 }
        by by_hand::sled, |c| [c.alpha, c.beta, c.k, c.g * c.incline.sin()];
        states { .. => (-3.0, 3.0) }
        near 0 at QUARTER;
    "appell": Appell, appell Appell APPELL_TEXT [9] { a = 1/2, A = 1/8, C = 1/4, g = 981/100 }
        by by_hand::appell, |c| [c.a, c.A, c.C, c.g];
        states { .. => (-2.0, 2.0), 0..1 => (0.3, 2.8) }
        near 0 at 0.0;
    "turntable": Turntable, even_turntable EvenTurntable TURNTABLE_TEXT [8] { m = 3/2, a = 1/4, Omega = 7/5 }
        by by_hand::turntable, |c| [c.a, c.Omega];
        states { .. => (-2.0, 2.0), 3..4 => (0.3, 2.8) }
        near 3 at 0.0;
    "top": EulerTop, euler_top EulerTop EULERTOP_TEXT [6] { I1 = 1/1, I2 = 3/2, I3 = 2/1 }
        by by_hand::euler_top, |c| [c.I1, c.I2, c.I3];
        states { .. => (-2.0, 2.0), 1..2 => (0.3, 2.8) }
        near 1 at 0.0;
    "car1": Car1, car1 Car1 CAR1_TEXT [7] { m = 3/1, J = 2/1, I = 1/10, l = 2/1, M = 1/1, K = 1/2, d = 3/2 }
        by by_hand::car, |c| [c.m, c.J, c.I, c.l, c.M, c.K, c.d];
        states { .. => (-2.0, 2.0), 3..4 => (-1.0, 1.0) }
        near 3 at QUARTER;
    "car2": Car2, car2 Car2 CAR2_TEXT [8] { m = 3/1, J = 2/1, I = 1/10, l = 2/1, M = 1/1, K = 1/2, d = 3/2 }
        by by_hand::car, |c| [c.m, c.J, c.I, c.l, c.M, c.K, c.d];
        states { .. => (-2.0, 2.0), 3..4 => (-1.0, 1.0) }
        near 3 at QUARTER;
    "car3": Car3, car3 Car3 CAR3_TEXT [9] { m = 3/1, J = 2/1, I = 1/10, l = 2/1, M = 1/1, K = 1/2, d = 3/2 }
        by by_hand::car, |c| [c.m, c.J, c.I, c.l, c.M, c.K, c.d];
        states { .. => (-2.0, 2.0), 3..4 => (-1.0, 1.0) }
        near 3 at QUARTER;
    "chain2": Chain2, chain2 Chain2 CHAIN2_TEXT [4] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::chain_by_tensions::<R, 2, 4>, |c| [c.l, c.g];
        or "matrix" by by_hand::chain_by_elimination::<f64, 2, 4>;
        states { .. => (-2.0, 2.0) }
        near 0 at 0.0, 1 at 0.0;
    "chain5": Chain5, chain5 Chain5 CHAIN5_TEXT [10] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::chain_by_tensions::<R, 5, 10>, |c| [c.l, c.g];
        or "matrix" by by_hand::chain_by_elimination::<f64, 5, 10>;
        states { .. => (-2.0, 2.0) }
        near 0 at 0.0, 1 at 0.0, 2 at 0.0, 3 at 0.0, 4 at 0.0;
    "chain10": Chain10, chain10 Chain10 CHAIN10_TEXT [20] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::chain_by_tensions::<R, 10, 20>, |c| [c.l, c.g];
        or "matrix" by by_hand::chain_by_elimination::<f64, 10, 20>;
        states { .. => (-2.0, 2.0) }
        near 0 at 0.0, 1 at 0.0, 2 at 0.0, 3 at 0.0, 4 at 0.0, 5 at 0.0, 6 at 0.0, 7 at 0.0, 8 at 0.0, 9 at 0.0;
    "chain20": Chain20, chain20 Chain20 CHAIN20_TEXT [40] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::chain_by_tensions::<R, 20, 40>, |c| [c.l, c.g];
        or "matrix" by by_hand::chain_by_elimination::<f64, 20, 40>;
        states { .. => (-2.0, 2.0) }
        near 0 at 0.0, 1 at 0.0, 2 at 0.0, 3 at 0.0, 4 at 0.0;
    "joints2": Joints2, joints2 Joints2 JOINTS2_TEXT [4] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::joints::<R, 2, 4>, |c| [c.l, c.g];
        states { .. => (-2.0, 2.0) }
        near 1 at 0.0;
    "joints5": Joints5, joints5 Joints5 JOINTS5_TEXT [10] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::joints::<R, 5, 10>, |c| [c.l, c.g];
        states { .. => (-2.0, 2.0) }
        near 1 at 0.0, 2 at 0.0, 3 at 0.0, 4 at 0.0;
    "joints10": Joints10, joints10 Joints10 JOINTS10_TEXT [20] { m = 3/2, l = 1/2, g = 981/100 }
        by by_hand::joints::<R, 10, 20>, |c| [c.l, c.g];
        states { .. => (-2.0, 2.0) }
        near 1 at 0.0, 2 at 0.0, 3 at 0.0, 4 at 0.0, 5 at 0.0, 6 at 0.0, 7 at 0.0, 8 at 0.0, 9 at 0.0;
    "arm3": Arm3, arm3 Arm3 ARM3_TEXT [6]
        { m = 3/2, l = 1/2, A = 1/10, B = 1/5, C = 1/4, D = 1/40, g = 981/100 }
        by |c| by_hand::arm([2, 1, 0], c), |c| [c.m, c.l, c.A, c.B, c.C, c.D, c.g];
        states { .. => (-2.0, 2.0) }
        near 1 at 0.0;
    "arm6": Arm6, arm6 Arm6 ARM6_TEXT [12]
        { m = 3/2, l = 1/2, A = 1/10, B = 1/5, C = 1/4, D = 1/40, g = 981/100 }
        by |c| by_hand::arm([2, 1, 1, 0, 1, 0], c), |c| [c.m, c.l, c.A, c.B, c.C, c.D, c.g];
        states { .. => (-2.0, 2.0) }
        near 1 at 0.0, 4 at 0.0;
}
