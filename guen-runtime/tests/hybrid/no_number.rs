//! Functions of a declaration that cease to be numbers: the run ends there with its motion, after what has happened before.

use guen_runtime::Lift;
use guen_runtime::hybrid::{
    Conditions, Element, FreeMotion, HybridCause, HybridSystem, Signal, TransitionKind,
};

use crate::bodies::Parts;

/// Which of the functions of a falling point has a root of what becomes negative.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rooted {
    Gap,
    Condition,
    Switch,
    Reset,
}

/// A point that falls from a height of one beside a floor, a switch and a reset.
#[derive(Clone, Copy, Debug)]
struct Falling {
    rooted: Rooted,
    /// The height at which the root ends.
    ends: f64,
    /// The number that is subtracted from the root.
    less: f64,
}

impl Falling {
    fn value<R: Lift<f64>>(&self, of: Rooted, x: R, other: f64) -> R {
        match of == self.rooted {
            true => (x - R::lift(self.ends)).sqrt() - R::lift(self.less),
            false => R::lift(other),
        }
    }
}

impl HybridSystem<2, 1, 1, 2> for Falling {
    const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0).with_condition()];
    const SIGNALS: [Signal; 2] = [Signal::switch("light"), Signal::reset_falling("racket")];
    const COORDINATES: usize = 1;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 2], _: &[R; 2], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
        let mut parts = Parts::<R, 1, 1, 1>::nothing().masses([R::one()]);
        parts.forces = [R::lift(-10.0)];
        parts.rows = [[R::one()]];
        parts.gaps = [match self.rooted {
            Rooted::Condition => x[0] - R::lift(0.4),
            _ => self.value(Rooted::Gap, x[0], 1.0),
        }];
        parts.free_motion(x)
    }

    fn conditions<R: Lift<f64>>(&self, _t: R, x: &[R; 2], _: &[R; 2]) -> Conditions<R, 1> {
        Conditions { when: [self.value(Rooted::Condition, x[0], 1.0)], release: [R::zero()] }
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, x: &[R; 2]) -> [R; 2] {
        [self.value(Rooted::Switch, x[0], 1.0), self.value(Rooted::Reset, x[0], 1.0)]
    }

    fn reset<R: Lift<f64>>(&self, _signal: usize, _t: R, x: &[R; 2], _: &[R; 2]) -> [R; 2] {
        [R::one() + x[0], x[1]]
    }
}

#[test]
fn what_is_no_number_is_told_with_its_name() {
    for (rooted, name) in [
        (Rooted::Gap, "floor"),
        (Rooted::Condition, "floor"),
        (Rooted::Switch, "light"),
        (Rooted::Reset, "racket"),
    ] {
        // Without a zero before.
        let system = Falling { rooted, ends: 0.5, less: -0.1 };
        let error = system.simulate(&[1.0, 0.0], 0.0..2.0).unwrap_err();
        assert_eq!(error.error.cause, HybridCause::NoNumber { function: name }, "{rooted:?}");
        let motion = error.trajectory;
        let (t, x) = (motion.end_time(), motion.end()[0]);
        assert!(x <= 0.5 && (x - (1.0 - 5.0 * t * t)).abs() < 1e-7, "{rooted:?}: {t} {x}");
        assert!(error.error.cause.to_string().contains(name));
        // From the start.
        let system = Falling { rooted, ends: 2.0, less: 0.1 };
        let found = system.simulate(&[1.0, 0.0], 0.0..0.1);
        match rooted {
            // Nobody asks for it where nothing touches.
            Rooted::Condition => assert!(found.is_ok()),
            _ => assert_eq!(
                found.unwrap_err().error.cause,
                HybridCause::NoNumber { function: name },
                "{rooted:?}"
            ),
        }
    }
}

#[test]
fn a_zero_shortly_before_counts() {
    // At a height of 0.51 the root is a tenth.
    let at = f64::sqrt(2.0 * 0.49 / 10.0);
    for (rooted, kind) in [
        (Rooted::Gap, TransitionKind::Impact),
        (Rooted::Switch, TransitionKind::Switched),
        (Rooted::Reset, TransitionKind::Reset),
    ] {
        let system = Falling { rooted, ends: 0.5, less: 0.1 };
        let found = system.simulate(&[1.0, 0.0], 0.0..0.45);
        let motion = match found {
            Ok(motion) => motion,
            Err(error) => *error.trajectory,
        };
        let first = motion.transitions()[0];
        assert!(first.kind == kind && (first.t - at).abs() < 1e-9, "{rooted:?}: {first:?}");
    }
}
