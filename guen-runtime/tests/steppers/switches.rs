//! Right-hand sides that change their formula: methods that choose their steps locate the change, so that errors follow the
//! tolerance as on smooth systems; others count it.

use guen_runtime::steppers::{Cause, Dop853, Integration, Outcome, Radau5, Rk4, Tsit5};
use guen_runtime::{Differentiable, Dual, Real, System, maximum};

/// An oscillator between two springs that begin at a distance: free in between.
#[derive(Clone, Copy)]
struct Gap;

impl<R: Real> System<R, 2> for Gap {
    fn rhs(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        let one = R::one();
        let stiffness = R::from_ratio(400, 1);
        let push = maximum(-one - x, R::zero()) - maximum(x - one, R::zero());
        [v, stiffness * push]
    }

    fn switches(&self, _t: R, &[x, _]: &[R; 2], values: &mut [R]) -> usize {
        values[0] = x + R::one();
        values[1] = x - R::one();
        2
    }
}

/// The place of the gap's motion that begins at zero with speed one: two seconds between the springs, `pi/20` in each.
fn in_gap(t: f64) -> [f64; 2] {
    let contact = core::f64::consts::PI / 20.0;
    let half = 2.0 + contact;
    let turns = ((t + 1.0) / half).floor();
    let within = (t + 1.0) % half;
    let side = if turns % 2.0 == 0.0 { 1.0 } else { -1.0 };
    let [x, v] = if within < 2.0 {
        [within - 1.0, 1.0]
    } else {
        let phase = 20.0 * (within - 2.0);
        [1.0 + phase.sin() / 20.0, phase.cos()]
    };
    [side * x, side * v]
}

/// A mass on a spring with dry friction, `x'' = -x - f sign(v)`.
#[derive(Clone, Copy)]
struct Friction(f64);

impl<R: Real> System<R, 2> for Friction {
    fn rhs(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x - R::from_f64(self.0) * v.sign()]
    }

    fn switches(&self, _t: R, &[_, v]: &[R; 2], values: &mut [R]) -> usize {
        values[0] = v;
        1
    }
}

/// From rest at `a`: half a turn about the point where spring and friction balance, then about the opposite one.
fn with_friction(f: f64, a: f64, t: f64) -> [f64; 2] {
    let (mut start, mut left) = (a, t);
    while left > core::f64::consts::PI {
        let balance = f * start.signum();
        start = 2.0 * balance - start;
        left -= core::f64::consts::PI;
    }
    let balance = f * start.signum();
    let size = start - balance;
    [balance + size * left.cos(), -size * left.sin()]
}

fn off(found: [f64; 2], expected: [f64; 2]) -> f64 {
    (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs())
}

#[test]
fn errors_follow_the_tolerance_over_switches() {
    let start = with_friction(0.3, 5.0, 0.25);
    for exponent in [4, 6, 8, 10, 12] {
        let tolerance = 10.0_f64.powi(-exponent);
        let mut errors = Vec::new();
        macro_rules! with {
            ($method:expr) => {{
                let method = $method;
                let done = Integration::new(&Gap, 0.0, &[0.0, 1.0]).run(&method, 10.0).unwrap();
                errors.push(off(done.state, in_gap(10.0)));
                assert_eq!((done.statistics.switches, done.statistics.switches_passed), (10, 0));
                let friction = Integration::new(&Friction(0.3), 0.25, &start).run(&method, 15.0).unwrap();
                errors.push(off(friction.state, with_friction(0.3, 5.0, 15.0)));
                assert_eq!(friction.statistics.switches, 4);
            }};
        }
        with!(Dop853::new(tolerance, tolerance));
        with!(Tsit5::new(tolerance, tolerance));
        for error in &errors {
            assert!(*error < 300.0 * tolerance, "{tolerance}: {errors:?}");
        }
    }
}

#[test]
fn implicit_methods_locate_switches() {
    let method = Radau5::new(1e-8, 1e-8);
    let done = Integration::new(&Gap, 0.0, &[0.0, 1.0]).run(&method, 10.0).unwrap();
    assert!(off(done.state, in_gap(10.0)) < 1e-5, "{done:?}");
}

impl Differentiable<f64, 2> for Gap {
    fn jacobian(&self, _t: f64, &[x, _]: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [if x.abs() > 1.0 { -400.0 } else { 0.0 }, 0.0]]
    }

    fn along(&self, t: f64, state: &[f64; 2], _dt: f64, dx: &[f64; 2]) -> [f64; 2] {
        let [[_, one], [slope, _]] = self.jacobian(t, state);
        [one * dx[1], slope * dx[0]]
    }
}

/// Runs backwards come back to the start.
#[test]
fn switches_are_located_backwards() {
    let method = Dop853::new(1e-12, 1e-12);
    let there = Integration::new(&Gap, 0.0, &[0.0, 1.0]).run(&method, 10.0).unwrap();
    let back = Integration::new(&Gap, 10.0, &there.state).run(&method, 0.0).unwrap();
    assert!(off(back.state, [0.0, 1.0]) < 1e-9 && back.statistics.switches == 10, "{back:?}");
}

/// Samples and events beside a switch are those of the motion.
#[test]
fn samples_lie_on_the_motion() {
    let times: Vec<f64> = (0..200).map(|k| 0.05 * f64::from(k)).collect();
    let mut worst = 0.0_f64;
    let slow = |_t: f64, &[x, v]: &[f64; 2]| v - 0.5 * x;
    let mut events = Vec::new();
    let mut visit = |k: usize, _t: f64, state: &[f64; 2]| worst = worst.max(off(*state, in_gap(times[k])));
    Integration::new(&Gap, 0.0, &[0.0, 1.0])
        .sample(&times, &mut visit)
        .events([guen_runtime::steppers::Event::new(&slow)], &mut |event| {
            events.push(off(event.state, in_gap(event.time)));
            core::ops::ControlFlow::Continue(())
        })
        .run(&Dop853::new(1e-11, 1e-11), 9.99)
        .unwrap();
    assert!(worst < 1e-8, "{worst}");
    assert!(events.len() == 5 && events.iter().all(|error| *error < 1e-8), "{events:?}");
}

/// Friction that stops is no motion of these equations: spring and friction lead back from both sides.
#[test]
fn sliding_is_an_error_with_the_switch() {
    let start = [0.8, 0.0];
    // At `pi` it has come to `2 f - 0.8 = -0.2`, where the spring is weaker than friction.
    let found =
        Integration::new(&Friction(0.3), 0.0, &[start[0], -1e-9]).run(&Dop853::new(1e-10, 1e-10), 10.0);
    let error = found.unwrap_err();
    let Cause::Sliding { found, switch: 0 } = error.cause else { panic!("{error}") };
    assert!((found - core::f64::consts::PI).abs() < 1e-6, "{error}");
    assert!((error.state[0] + 0.2).abs() < 1e-6 && error.to_string().contains("contacts"), "{error}");
    // At rest from the start, and with as much friction as the spring: neither moves.
    let at_rest = Integration::new(&Friction(0.3), 0.0, &[0.1, 0.0]).run(&Dop853::new(1e-10, 1e-10), 10.0);
    assert!(matches!(at_rest.unwrap_err().cause, Cause::Sliding { switch: 0, .. }));
    // A stronger spring than friction moves from rest.
    let start =
        Integration::new(&Friction(0.3), 0.0, &[5.0, 0.0]).run(&Dop853::new(1e-10, 1e-10), 3.0).unwrap();
    assert!(off(start.state, with_friction(0.3, 5.0, 3.0)) < 1e-8, "{start:?}");
}

#[test]
fn fixed_steps_count_what_they_pass() {
    let done = Integration::new(&Gap, 0.0, &[0.0, 1.0]).run(&Rk4::new(0.01), 10.0).unwrap();
    assert_eq!((done.statistics.switches, done.statistics.switches_passed), (0, 10));
    assert_eq!(done.outcome, Outcome::Arrived);
    let error = off(done.state, in_gap(10.0));
    assert!(error > 1e-9 && error < 1e-2, "{error}");
}

/// Derivatives by the start go through switches of rates that are continuous.
#[test]
fn duals_go_over_kinks() {
    let along = |x: f64| {
        let state = [Dual::<f64, 1> { value: x, tangent: [1.0] }, Dual::constant(1.0)];
        Integration::new(&Gap, Dual::zero(), &state)
            .run(&Dop853::new(1e-11, 1e-11), Dual::constant(7.0))
            .unwrap()
            .state
    };
    let run =
        |x: f64| Integration::new(&Gap, 0.0, &[x, 1.0]).run(&Dop853::new(1e-12, 1e-12), 7.0).unwrap().state;
    let (dual, ahead, behind) = (along(0.1), run(0.1 + 1e-4), run(0.1 - 1e-4));
    for i in 0..2 {
        assert!((dual[i].tangent[0] - (ahead[i] - behind[i]) / 2e-4).abs() < 1e-5, "{dual:?}");
    }
}

/// A rate that is positive for a short while: `x' = max(0, w^2 - (t - 1/2)^2)`.
#[derive(Clone, Copy)]
struct Blip(f64);

impl System<f64, 1> for Blip {
    fn rhs(&self, t: f64, _: &[f64; 1]) -> [f64; 1] {
        [(self.0 - (t - 0.5).powi(2)).max(0.0)]
    }

    fn switches(&self, t: f64, _: &[f64; 1], values: &mut [f64]) -> usize {
        values[0] = self.0 - (t - 0.5).powi(2);
        1
    }
}

#[test]
fn two_changes_within_one_step_are_found() {
    for w in [0.1_f64, 1e-2, 1e-3, 1e-5] {
        let blip = Blip(w * w);
        for (start, end) in [(0.0, 1.7), (1.3, -0.4)] {
            let run = Integration::new(&blip, start, &[0.0]);
            let done = run.run(&Dop853::new(1e-12, 1e-12), end).unwrap();
            let exact = (end - start).signum() * 4.0 / 3.0 * w.powi(3);
            assert_eq!(done.statistics.switches, 2, "{w}");
            assert!((done.state[0] - exact).abs() < 1e-14 * w, "{w}: {} {exact}", done.state[0]);
            let run = Integration::new(&blip, start, &[0.0]);
            let done = run.run(&Tsit5::new(1e-9, 1e-9), end).unwrap();
            assert_eq!(done.statistics.switches, 2, "{w}");
        }
    }
    // What only comes near changes nothing.
    let done = Integration::new(&Blip(-1e-9), 0.0, &[0.0]).run(&Dop853::new(1e-12, 1e-12), 1.7).unwrap();
    assert_eq!((done.statistics.switches, done.state[0]), (0, 0.0));
}

/// A force that pulses while the body coasts: on where `cos(w t)` is above 0.95, a tenth of each period.
#[derive(Clone, Copy)]
struct Pulses(f64);

impl System<f64, 2> for Pulses {
    fn rhs(&self, t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
        [v, if (self.0 * t).cos() >= 0.95 { 1.0 } else { 0.0 }]
    }

    fn switches(&self, t: f64, _: &[f64; 2], values: &mut [f64]) -> usize {
        values[0] = (self.0 * t).cos() - 0.95;
        1
    }
}

#[test]
fn swings_within_a_step_are_followed() {
    let width = 0.95_f64.acos();
    for w in [1.0, 5.0, 20.0, 100.0, 1000.0] {
        let pulses = Pulses(w);
        let period = 2.0 * core::f64::consts::PI / w;
        let (periods, exact) = (9.7, 19.0 * width / w);
        for start in [0.0, 100.0 * period] {
            macro_rules! with {
                ($method:expr, $accuracy:expr) => {{
                    let run = Integration::new(&pulses, start, &[0.0, 0.0]);
                    let done = run.run(&$method, start + periods * period).unwrap();
                    let off = (done.state[1] - exact).abs() / exact;
                    let switches = done.statistics.switches;
                    assert!(
                        off < $accuracy && switches == 19,
                        "{w} from {start}: off by {off:e}, {switches}"
                    );
                }};
            }
            with!(Dop853::new(1e-9, 1e-9), 1e-8);
            with!(Tsit5::new(1e-9, 1e-9), 1e-8);
            with!(Tsit5::new(1e-6, 1e-6), 1e-5);
            with!(Dop853::new(1e-4, 1e-4), 1e-3);
        }
    }
}

/// Steps that were made again to end at a switch are trials, and no steps of the motion.
#[test]
fn steps_made_again_at_switches_are_rejected_ones() {
    for (start, end) in [(0.0, 10.0), (10.0, 0.0)] {
        let mut shown = 0;
        let mut observe = |_t: f64, _: &[f64; 2]| {
            shown += 1;
            core::ops::ControlFlow::Continue(())
        };
        let run = Integration::new(&Gap, start, &in_gap(start)).observe(&mut observe);
        let work = run.run(&Dop853::new(1e-9, 1e-9), end).unwrap().statistics;
        assert_eq!((work.accepted, work.switches), (shown, 10));
        assert!(work.rejected > 20, "{work:?}");
    }
}
/// A ball on a floor of springs.
#[derive(Clone, Copy)]
struct Floor;

impl System<f64, 2> for Floor {
    fn rhs(&self, _t: f64, &[z, v]: &[f64; 2]) -> [f64; 2] {
        [v, -9.81 + 1000.0 * (-z).max(0.0)]
    }

    fn switches(&self, _t: f64, &[z, _]: &[f64; 2], values: &mut [f64]) -> usize {
        values[0] = z;
        1
    }
}
/// Every step moves the time, also the last ones before a switch.
#[test]
fn no_step_of_a_search_stands_still() {
    for (tolerance, end) in [(1e-9, 20.0), (1e-6, 20.0), (1e-12, -20.0), (1e-4, -20.0)] {
        let mut times = vec![0.0];
        let mut observe = |t: f64, _: &[f64; 2]| {
            times.push(t);
            core::ops::ControlFlow::Continue(())
        };
        let run = Integration::new(&Floor, 0.0, &[0.5, 0.0]).observe(&mut observe);
        let done = run.run(&Dop853::new(tolerance, tolerance), end).unwrap();
        assert!(done.statistics.switches > 20);
        let moves = |pair: &[f64]| (pair[1] - pair[0]) * end > 0.0;
        assert!(times.windows(2).all(moves), "{tolerance}");
    }
}

/// A force for a short while `w` from a time on, whose switch has errors as of a long polynomial: its sign is uncertain around its zeros.
#[derive(Clone, Copy)]
struct Late(f64, f64);

impl Late {
    fn outside(self, t: f64) -> f64 {
        let Self(from, w) = self;
        (t - from) * (t - from - w) + 1e-12 * (1e14 * t).sin()
    }
}

impl System<f64, 2> for Late {
    fn rhs(&self, t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
        [v, if self.outside(t) <= 0.0 { 1.0 } else { 0.0 }]
    }

    fn switches(&self, t: f64, _: &[f64; 2], values: &mut [f64]) -> usize {
        values[0] = self.outside(t);
        1
    }
}

#[test]
fn a_switch_of_time_alone_does_not_slide() {
    for from in [50.0, 33.3, 71.9, 12.7, 90.1] {
        for w in [0.01, 0.003, 0.02, 0.05] {
            for (start, end) in [(0.0, 100.0), (100.0, 0.0)] {
                let late = Late(from, w);
                let run = Integration::new(&late, start, &[0.0, 1.0]);
                let done = run.run(&Dop853::new(1e-9, 1e-9), end).unwrap();
                let gained = (done.state[1] - 1.0).abs();
                assert!((gained - w).abs() < 1e-6, "{from} {w} {start}: {gained}");
            }
        }
    }
}

/// A switch that swings with the motion and never comes to zero, which counts how often it is asked.
struct Watching {
    asked: core::cell::Cell<u64>,
}

impl<R: Real> System<R, 2> for Watching {
    fn rhs(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x]
    }

    fn switches(&self, t: R, &[x, v]: &[R; 2], values: &mut [R]) -> usize {
        self.asked.set(self.asked.get() + 1);
        values[0] = R::from_ratio(21, 20) + x * v + (t * R::from_ratio(1, 2)).sin() * R::from_ratio(1, 2);
        1
    }
}

/// At late times, and in single precision, the roundings of the time say nothing of a swing.
#[test]
fn roundings_of_the_time_are_no_swings() {
    fn looks<R: guen_runtime::Ordered>(start: R, end: R) -> f64 {
        let watching = Watching { asked: core::cell::Cell::new(0) };
        let run = Integration::new(&watching, start, &[R::one(), R::zero()]);
        let done = run.run(&Dop853::<R>::new(1e-5, 1e-5), end).unwrap();
        watching.asked.get() as f64 / done.statistics.accepted as f64
    }
    for start in [0.0, 1e3, 1.7e9, 1e12] {
        let asked = looks(start, start + 50.0);
        assert!(asked < 7.2, "{start:e}: {asked}");
    }
    for start in [0.0_f32, 1e3] {
        let asked = looks(start, start + 50.0);
        assert!(asked < 7.2, "{start:e}: {asked}");
    }
}

/// Pulses are found at late times, too.
#[test]
fn swings_are_followed_at_late_times() {
    for (w, start) in [(100.0, 1.7e9), (1.0, 1.7e9), (20.0, 1e6)] {
        let pulses = Pulses(w);
        let done = Integration::new(&pulses, start, &[0.0, 0.0]);
        let done = done.run(&Dop853::new(1e-5, 1e-5), start + 200.0 / w).unwrap();
        // Some thirty-two periods, a tenth of the time.
        let mean = done.state[1] / (200.0 / w);
        assert!((mean - 0.1011).abs() < 0.004, "{w} {start:e}: {mean}");
        assert!((63..=64).contains(&done.statistics.switches), "{}", done.statistics.switches);
    }
}
