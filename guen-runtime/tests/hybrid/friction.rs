//! Friction: more at rest than in motion, in space, on moving ground; modes that are excluded, runs that are refused.

use core::ops::ControlFlow;

use guen_runtime::Lift;
use guen_runtime::hybrid::{
    Element, ElementState, FreeMotion, Hybrid, HybridCause, HybridSystem, Mode, Signal, Transition,
    TransitionKind,
};
use guen_runtime::steppers::{Dop853, Taylor};

use crate::bodies::Parts;

fn dop853() -> Dop853<f64> {
    Dop853::new(1e-11, 1e-11)
}

/// A block of mass one on a rough plane under a force `pull t` along `x`.
#[derive(Clone, Copy, Debug)]
pub struct Pulled {
    pub friction: f64,
    pub stiction: f64,
    /// Whether the mode with slip is excluded.
    pub sticks_only: bool,
}

impl HybridSystem<4, 2, 1, 0> for Pulled {
    const ELEMENTS: [Element; 1] = [Element::rough("ground", 0, &[1])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 2;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, t: R, x: &[R; 4], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 4, 2, 1> {
        let (zero, one) = (R::zero(), R::one());
        let mut parts = Parts::<R, 2, 2, 1>::nothing().masses([one; 2]);
        parts.forces = [t, R::lift(-10.0)];
        parts.rows = [[zero, one], [one, zero]];
        parts.gaps = [x[1]];
        (parts.friction, parts.stiction) = ([R::lift(self.friction)], [R::lift(self.stiction)]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 4]) -> [R; 0] {
        []
    }

    fn allows(&self, mode: &Mode<1>) -> bool {
        !(self.sticks_only && mode.0[0].slips())
    }
}

#[test]
fn stiction_holds_longer_than_friction() {
    // It holds to 5, and slips with t - 3 then.
    let block = Pulled { friction: 0.3, stiction: 0.5, sticks_only: false };
    let mut told = Vec::new();
    let done = Hybrid::new(&block, 0.0, &[0.0; 4])
        .transitions(&mut |tr: &Transition<Mode<1>, 4, 2, 1>| {
            told.push((tr.t, tr.kind));
            ControlFlow::Continue(())
        })
        .run(&dop853(), 6.0)
        .unwrap();
    let [(t, TransitionKind::Slips)] = told[..] else { panic!("{told:?}") };
    assert!((t - 5.0).abs() < 1e-11);
    // From 2 to 3 in a unit of time.
    assert!((done.state[2] - 2.5).abs() < 1e-10, "{:?}", done.state);
    // At rest between both the block holds: more modes than one would go on.
    let done = Hybrid::new(&block, 4.0, &[0.0; 4]).run(&dop853(), 4.5).unwrap();
    assert_eq!(done.mode, Mode([ElementState::Stick]));
}

#[test]
fn an_excluded_mode_ends_a_run_with_its_name() {
    let block = Pulled { friction: 0.3, stiction: 0.3, sticks_only: true };
    let error = Hybrid::new(&block, 0.0, &[0.0; 4]).run(&dop853(), 6.0).unwrap_err();
    assert_eq!(error.cause, HybridCause::Excluded { mode: Mode([ElementState::SlipForward]) });
    assert!((error.t - 3.0).abs() < 1e-11 && error.mode == Mode([ElementState::Stick]));
    let text = error.to_string();
    assert!(
        text.ends_with("in the mode (stick): the motion goes on in the mode (slip+), which is excluded"),
        "{text}"
    );
}

#[test]
fn runs_refuse_what_makes_no_sense() {
    let block = Pulled { friction: 0.3, stiction: 0.3, sticks_only: false };
    for (end, start) in [(-1.0, 0.0), (f64::NAN, 0.0), (1.0, f64::INFINITY)] {
        assert!(Hybrid::new(&block, 0.0, &[start, 0.0, 0.0, 0.0]).run(&dop853(), end).is_err());
    }
    let visit = &mut |_: usize, _: f64, _: &[f64; 4], _: &Mode<1>| {};
    assert!(Hybrid::new(&block, 0.0, &[0.0; 4]).sample(&[0.5, 0.2], visit).run(&dop853(), 1.0).is_err());
    let limited = Hybrid::new(&block, 0.0, &[0.0; 4]).max_transitions(0).run(&dop853(), 4.0).unwrap_err();
    assert_eq!(limited.cause, HybridCause::TooManyTransitions { limit: 0 });
}

/// A billiard ball: its centre, then velocity and spin, on a cloth and before a cushion at `x = 2`.
#[derive(Clone, Copy, Debug)]
struct Ball {
    friction: f64,
    radius: f64,
}

impl HybridSystem<9, 4, 2, 0> for Ball {
    const ELEMENTS: [Element; 2] = [Element::rough("cloth", 0, &[1, 2]), Element::smooth("cushion", 3)];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(2 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 9], _: &[R; 0], _: &[R; 2]) -> FreeMotion<R, 9, 4, 2> {
        let (zero, one, a) = (R::zero(), R::one(), R::lift(self.radius));
        let inverse = R::from_ratio(5, 2) / (a * a);
        // The slip of the lowest point: v + omega x (-a e_z).
        let rows = [
            [zero, zero, one, zero, zero, zero],
            [one, zero, zero, zero, -a, zero],
            [zero, one, zero, a, zero, zero],
            [-one, zero, zero, zero, zero, zero],
        ];
        let masses = [one, one, one, inverse, inverse, inverse];
        let forces = [zero, zero, R::lift(-9.81), zero, zero, zero];
        let velocities: [R; 6] = core::array::from_fn(|i| x[3 + i]);
        let dot = |p: &[R; 6], q: &[R; 6]| p.iter().zip(q).fold(zero, |sum, (p, q)| sum + *p * *q);
        let scaled = |p: &[R; 6]| -> [R; 6] { core::array::from_fn(|i| p[i] * masses[i]) };
        let responses = rows.map(|row| scaled(&row));
        let state = |upper: [R; 3], lower: [R; 6]| -> [R; 9] {
            core::array::from_fn(|i| if i < 3 { upper[i] } else { lower[i - 3] })
        };
        FreeMotion {
            rates: state([x[3], x[4], x[5]], forces),
            gaps: [x[2] - a, R::lift(2.0) - x[0]],
            row_rates: rows.map(|row| dot(&row, &velocities)),
            biases: rows.map(|row| dot(&row, &forces)),
            delassus: rows.map(|row| responses.map(|response| dot(&row, &response))),
            responses: responses.map(|response| state([zero; 3], response)),
            friction: [R::lift(self.friction), zero],
            stiction: [R::lift(self.friction), zero],
            limits: [zero; 2],
        }
    }

    fn restitutions(&self) -> [f64; 2] {
        [0.0, 0.8]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 9]) -> [R; 0] {
        []
    }
}

#[test]
fn a_billiard_ball_slides_rolls_and_banks() {
    let (mu, a, g) = (0.2, 0.03, 9.81);
    let ball = Ball { friction: mu, radius: a };
    // Velocity and spin; the slip is v + omega x (-a e_z).
    let (v, spin) = ([1.0, 0.5], [20.0, 30.0, 5.0]);
    let start = [0.0, 0.0, a, v[0], v[1], 0.0, spin[0], spin[1], spin[2]];
    let slip = [v[0] - a * spin[1], v[1] + a * spin[0]];
    let size = f64::hypot(slip[0], slip[1]);
    let rolls = 2.0 * size / (7.0 * mu * g);
    let end = [v[0] - 2.0 / 7.0 * slip[0], v[1] - 2.0 / 7.0 * slip[1]];
    for exact in [false, true] {
        let mut told = Vec::new();
        let mut receive = |tr: &Transition<Mode<2>, 9, 4, 2>| {
            told.push(*tr);
            ControlFlow::Continue(())
        };
        let hybrid = Hybrid::new(&ball, 0.0, &start).transitions(&mut receive);
        let done =
            if exact { hybrid.run(&Taylor::new(1e-14, 1e-14), 4.0) } else { hybrid.run(&dop853(), 4.0) };
        done.unwrap();
        assert_eq!(told[0].kind, TransitionKind::Sticks, "{told:?}");
        assert_eq!(told[0].after.0[0], ElementState::Stick);
        assert!((told[0].t - rolls).abs() < 1e-11, "{} {rolls}", told[0].t);
        for k in 0..2 {
            assert!((told[0].state_after[3 + k] - end[k]).abs() < 1e-10, "{:?} {end:?}", told[0].state_after);
        }
        // At the cushion the velocity turns, the spin stays: it slides again, and rolls back.
        assert_eq!(told[1].kind, TransitionKind::Impact, "{told:?}");
        assert_eq!(told[1].after.0, [ElementState::Slip, ElementState::Open]);
        assert!((told[1].state_after[3] + 0.8 * end[0]).abs() < 1e-10);
        assert!((told[1].state_after[7] - end[0] / a).abs() < 1e-8);
        assert_eq!(told[2].kind, TransitionKind::Sticks);
        let slip = 1.8 * end[0];
        assert!((told[2].t - told[1].t - 2.0 * slip / (7.0 * mu * g)).abs() < 1e-10);
        assert_eq!(told.len(), 3);
    }
}

/// A puck on a plane under a horizontal force that turns and grows: at rest to the cone.
#[derive(Clone, Copy, Debug)]
struct Dragged;

impl HybridSystem<6, 3, 1, 0> for Dragged {
    const ELEMENTS: [Element; 1] = [Element::rough("plane", 0, &[1, 2])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, t: R, x: &[R; 6], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 6, 3, 1> {
        let (zero, one) = (R::zero(), R::one());
        let mut parts = Parts::<R, 3, 3, 1>::nothing().masses([one; 3]);
        let (sin, cos) = t.sin_cos();
        parts.forces = [t * cos, t * sin, R::lift(-10.0)];
        parts.rows = [[zero, zero, one], [one, zero, zero], [zero, one, zero]];
        parts.gaps = [x[2]];
        (parts.friction, parts.stiction) = ([R::lift(0.1)], [R::lift(0.1)]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

#[test]
fn spatial_slip_begins_against_the_reaction_that_held_it() {
    // The force reaches the cone at t = 1, in the direction one.
    let mut told = Vec::new();
    let done = Hybrid::new(&Dragged, 0.0, &[0.0; 6])
        .transitions(&mut |tr: &Transition<Mode<1>, 6, 3, 1>| {
            told.push((tr.t, tr.kind));
            ControlFlow::Continue(())
        })
        .run(&dop853(), 1.01)
        .unwrap();
    let [(t, TransitionKind::Slips)] = told[..] else { panic!("{told:?}") };
    assert!((t - 1.0).abs() < 1e-11);
    // Next to rest the direction follows the force so quickly that an explicit method makes small steps.
    assert!(done.work.accepted < 20_000, "{:?}", done.work);
    // The slip grows like the square of the time, along the force.
    let s = 0.01_f64;
    let [x, y] = [done.state[3], done.state[4]];
    assert!((f64::hypot(x, y) - 0.5 * s * s).abs() < 1e-2 * s * s, "{x} {y}");
    assert!((f64::atan2(y, x) - 1.0).abs() < 2.0 * s, "{}", f64::atan2(y, x));
}
