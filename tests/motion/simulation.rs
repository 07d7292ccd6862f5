//! Simulations: what they return agrees with an integration of the same method, and with what is known of the motion.

use guen::prelude::*;
use guen::steppers::{Direction, Guard};
use guen::{ConstantsError, Trigger, projected};

hoop!(guen::mechanical_system);

// By the prelude's name.
mechanical_system! {
    pub system Lift {
        constants { m > 0, g = 9.81 }
        inputs { force }
        coordinates { z }
        parameters { w = dot(z); }
        kinetic_energy = m/2*w^2;
        potential_energy = m*g*z;
        forces { force along w; }
        outputs { power = force*w; place = vec(0, 1, z); }
        provide taylor;
    }
}

mechanical_system! {
    /// A point on a circle, in Cartesian coordinates.
    pub system Circle {
        constants { m > 0, l > 0, g = 9.81 }
        inputs { push }
        coordinates { x, y }
        particles { m at vec(x, y); }
        gravity = vec(0, -g);
        parameters { omega = (x*dot(y) - y*dot(x))/l^2; }
        holonomic { rod: x^2 + y^2 = l^2; }
        forces { push along omega; }
        provide taylor;
    }
}

fn prepared() -> Result<hoop::Prepared, ConstantsError> {
    Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()
}

const START: hoop::State = hoop::State {
    theta: 1.2,
    psi: 0.3,
    phi: 0.0,
    xi: 0.0,
    eta: 0.0,
    zeta: 0.932_039_085_967_226_3,
    eta1: 0.1,
    eta2: 0.4,
    eta3: 5.0,
};

fn entries(state: hoop::State) -> [f64; 9] {
    state.into()
}

#[test]
fn a_trajectory_is_the_motion_of_an_integration() {
    let hoop = prepared().unwrap();
    let motion = hoop.simulate(&START, 0.0..6.0).unwrap();
    let times = [0.0, 0.017, 1.3, 2.5, 5.9999, 6.0];
    let mut samples = Vec::new();
    let done = Integration::new(&hoop, 0.0, &entries(START))
        .sample(&times, &mut |_, _, x| samples.push(*x))
        .run(&Dop853::new(1e-9, 1e-9), 6.0)
        .unwrap();
    assert_eq!(entries(motion.end()), done.state);
    for (t, sample) in times.into_iter().zip(samples) {
        assert_eq!(entries(motion.at(t)), sample, "t = {t}");
    }
    assert_eq!((motion.start(), motion.start_time(), motion.end_time()), (START, 0.0, 6.0));
    // Every step, from the start to the end, in order.
    let steps: Vec<f64> = motion.times().collect();
    assert_eq!(steps.len() as u64, done.statistics.accepted + 1);
    assert!(steps[0] == 0.0 && steps.last() == Some(&6.0) && steps.is_sorted());
    let quality = motion.statistics();
    assert_eq!(quality.work.accepted, done.statistics.accepted);
    assert!(quality.energy.is_some_and(|drift| drift > 0.0 && drift < 1e-8), "{quality:?}");
    let energies: Vec<f64> = motion.energy().map(|(_, energy)| energy).collect();
    assert!((energies[0] - energies[steps.len() - 1]).abs() < 1e-7);
}

#[test]
fn times_outside_count_as_the_ends_and_nan_stays() {
    let hoop = prepared().unwrap();
    let motion = hoop.simulate(&START, 0.0..1.0).unwrap();
    assert_eq!((motion.at(-1.0), motion.at(f64::INFINITY)), (START, motion.end()));
    assert!(entries(motion.at(f64::NAN)).iter().all(|x| x.is_nan()));
}

#[test]
fn samples_have_both_ends_once() {
    let hoop = prepared().unwrap();
    let motion = hoop.simulate(&START, 0.0..0.9).unwrap();
    let times = |dt: f64| motion.sample(dt).map(|(t, _)| t).collect::<Vec<f64>>();
    // 0.9/0.3 and 0.9/0.1 are not whole in binary.
    assert_eq!(times(0.3), [0.0, 0.3, 0.6, 0.9]);
    assert_eq!((times(0.1).len(), times(0.4).len(), times(5.0).len()), (10, 4, 2));
    for nonsense in [0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(times(nonsense), [0.0, 0.9], "{nonsense}");
    }
    let still = hoop.simulate(&START, 2.0..2.0).unwrap();
    assert_eq!((still.iter().count(), still.sample(0.1).count(), still.at(2.0)), (1, 1, START));
}

#[test]
fn a_run_goes_on_and_back() {
    let hoop = prepared().unwrap();
    let there = hoop.simulation(&START).tolerance(1e-12).run(0.0..3.0).unwrap();
    let back = hoop.simulation(&there.end()).tolerance(1e-12).run(3.0..0.0).unwrap();
    assert!(back.times().is_sorted_by(|a, b| a > b));
    for t in [0.0, 0.4, 1.7, 3.0] {
        for (a, b) in entries(there.at(t)).into_iter().zip(entries(back.at(t))) {
            assert!((a - b).abs() < 1e-8, "{t}: {a} {b}");
        }
    }
    assert_eq!(back.sample(1.0).map(|(t, _)| t).collect::<Vec<_>>(), [3.0, 2.0, 1.0, 0.0]);
    assert_eq!(back.sample(-1.0).count(), 4);
}

#[test]
fn every_method_serves() {
    let hoop = prepared().unwrap();
    let exact = hoop.simulation(&START).tolerance(1e-12).run(0.0..1.0).unwrap();
    macro_rules! check {
        ($($method:expr, $tolerance:expr;)*) => {$(
            let motion = hoop.simulation(&START).method($method).run(0.0..1.0).unwrap();
            for t in [0.123, 0.5, 0.77, 1.0] {
                for (a, b) in entries(exact.at(t)).into_iter().zip(entries(motion.at(t))) {
                    assert!((a - b).abs() < $tolerance, "{} at {t}: {a} {b}", stringify!($method));
                }
            }
        )*};
    }
    check! {
        Rk4::new(0.01), 1e-5; Rk8::new(0.05), 1e-8; Tsit5::new(1e-9, 1e-9), 1e-6;
        Radau5::new(1e-9, 1e-9), 1e-5; Gauss6::new(0.02), 1e-5;
    }
}

#[test]
fn events_end_a_run_and_are_kept() {
    let hoop = prepared().unwrap();
    let motion = hoop
        .simulation(&START)
        .events([
            Trigger::new(|_, state: &hoop::State| state.phi - 2.0).terminal(),
            Trigger::new(|t, _: &hoop::State| t - 0.1).direction(Direction::Rising),
        ])
        .run(0.0..100.0)
        .unwrap();
    assert!((motion.end().phi - 2.0).abs() < 1e-12);
    assert_eq!(motion.outcome(), Some(Outcome::Event(0)));
    assert_eq!(motion.events().iter().map(|event| event.index).collect::<Vec<_>>(), [1, 0]);
    assert_eq!(motion.events()[1].state, motion.end());
    let same = hoop.simulation(&START).stop_at(|_, state| state.phi - 2.0).run(0.0..100.0).unwrap();
    assert_eq!((same.end_time(), same.times().last()), (motion.end_time(), Some(motion.end_time())));
    assert!(same.times().all(|t| t <= same.end_time()));
}

#[test]
fn held_inputs_and_an_observer() {
    let lift = Lift::new(2.0).prepare().unwrap();
    let start = lift::State { z: 1.0, w: 0.0 };
    let lifted = lift.driven(lift::Inputs { force: 2.0 * (9.81 + 0.5) });
    let motion = lifted.simulate(&start, 0.0..4.0).unwrap();
    assert!((motion.end().z - 5.0).abs() < 1e-9);
    let series = lifted.simulation(&start).method(Taylor::new(1e-12, 1e-12)).run(0.0..4.0).unwrap();
    assert!((series.at(2.0).z - 2.0).abs() < 1e-12);
    let outcome = lifted
        .simulation(&start)
        .method(Rk4::new(0.5))
        .observe(|t, _| if t >= 2.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        .run(0.0..4.0)
        .unwrap();
    assert_eq!((outcome.end_time(), outcome.outcome()), (2.0, Some(Outcome::Stopped)));
}

#[test]
fn an_error_has_the_motion_until_then() {
    let hoop = prepared().unwrap();
    // A hoop that falls flat meets the edge of its chart.
    let falling = hoop::State { eta1: 0.0, eta2: 0.0, eta3: 0.0, ..START };
    let error = hoop.simulate(&falling, 0.0..10.0).unwrap_err();
    let motion = &error.trajectory;
    assert!(error.time > 0.5 && motion.end_time() == error.time && motion.outcome().is_none(), "{error:?}");
    assert!(motion.times().all(|t| t <= error.time));
    assert!(motion.iter().all(|(_, state)| state.theta > 0.0 && state.theta < 1.3));
    assert!(error.to_string().starts_with("simulation stopped at t = "), "{error}");
}

#[test]
fn inputs_are_functions_of_time_and_state() {
    let lift = Lift::new(2.0).prepare().unwrap();
    let start = lift::State { z: 1.0, w: 0.0 };
    // Gravity is carried, and a spring of one newton per metre is added: x'' = -x/2.
    let law = |_t: f64, state: &lift::State| lift::Inputs { force: 2.0 * 9.81 - state.z };
    let held_up = lift.with_inputs(law);
    let motion = held_up.simulate(&start, 0.0..5.0).unwrap();
    for (t, state) in motion.sample(0.7) {
        assert!((state.z - (t * 0.5_f64.sqrt()).cos()).abs() < 1e-7, "{t}");
    }
    assert_eq!(held_up.inputs(0.0, &start).force, 2.0 * 9.81 - 1.0);
    // Where inputs are constant it is the system with inputs that are held, to the bit.
    let inputs = lift::Inputs { force: 7.0 };
    let (one, other) = (lift.driven(inputs), lift.with_inputs(|_, _: &lift::State| inputs));
    let end = |motion: Result<lift::State, Cause>| motion.unwrap();
    let one = end(one.simulate(&start, 0.0..3.0).map(|motion| motion.end()).map_err(|error| error.cause));
    let other = end(other.simulate(&start, 0.0..3.0).map(|motion| motion.end()).map_err(|error| error.cause));
    assert_eq!(one, other);
}

#[test]
fn messages_name_what_vanishes_and_what_is_off() {
    let hoop = prepared().unwrap();
    // At the edge of its chart from the start: that, and not only "not finite".
    let flat = hoop::State { theta: 0.0, zeta: 0.0, ..START };
    let error = hoop.simulate(&flat, 0.0..1.0).unwrap_err();
    assert!(matches!(error.cause, Cause::ChartSingularity { function: 0, .. }), "{error}");
    let named = format!("`{}` must not vanish", hoop::DOMAIN[0]);
    assert!(error.to_string().contains(&named), "{error}");
    // So does `main` that returns it.
    assert!(format!("{error:?}").contains(&named), "{error:?}");
    let error = Integration::new(&hoop, 0.0, &entries(flat)).run(&Rk4::new(0.01), 1.0).unwrap_err();
    assert!(error.named(&hoop).to_string().contains(&named), "{}", error.named(&hoop));
    assert!(error.to_string().contains("function 0"), "{error}");
    // A step that is far too long for the spin.
    let fast = hoop::State { eta3: 60.0, ..START };
    let guard = Guard { energy: f64::INFINITY, approach: f64::INFINITY, ..Guard::default() };
    let run = hoop.simulation(&fast).method(Rk4::new(0.05)).guard(guard).run(0.0..1.0);
    let error = run.unwrap_err();
    assert!(matches!(error.cause, Cause::Step { .. }), "{error}");
    assert!(
        hoop::State::NAMES.iter().any(|name| error.to_string().contains(&format!("`{name}` is off"))),
        "{error}"
    );
}

#[test]
fn constraints_on_positions_hold_to_rounding() {
    let circle = Circle::new(1.0, 1.0).prepare().unwrap();
    let start = circle::State { x: 0.6, y: -0.8, omega: 2.0 };
    let pushed = circle.driven(circle::Inputs { push: 0.3 });
    fn worst<P: guen::steppers::Interpolant<f64, 3>, S>(motion: &Trajectory<S, 3, f64, P>) -> f64
    where
        S: Simulate<f64, 3, State = circle::State>,
    {
        let gaps = motion.sample(0.03).map(|(_, s)| (s.x * s.x + s.y * s.y - 1.0).abs());
        gaps.fold(motion.statistics().residual, f64::max)
    }
    let motion = pushed.simulate(&start, 0.0..6.0).unwrap();
    assert!(worst(&motion) < 1e-15, "{}", worst(&motion));
    // It is the motion of the projected system, to the bit; without that, constraints drift with the error of the method.
    let wrapped = projected(pushed).simulate(&start, 0.0..6.0).unwrap();
    assert!(motion.iter().eq(wrapped.iter()));
    let drifting = pushed.simulation(&start).without_projection().run(0.0..6.0).unwrap();
    assert!(worst(&drifting) > 1e-11 && worst(&drifting) < 1e-7, "{}", worst(&drifting));
    assert!((motion.end().omega - drifting.end().omega).abs() < 1e-6);
    macro_rules! check {
        ($($method:expr;)*) => {$(
            let motion = pushed.simulation(&start).method($method).run(0.0..1.0).unwrap();
            assert!(worst(&motion) < 1e-15, "{} {}", stringify!($method), worst(&motion));
        )*};
    }
    check! { Rk4::new(0.02); Tsit5::new(1e-7, 1e-7); Gauss6::new(0.05); Radau5::new(1e-7, 1e-7); Taylor::new(1e-9, 1e-9); }
    let law = |_: f64, state: &circle::State| circle::Inputs { push: -state.omega };
    let braked = circle.simulation(&start).inputs(law).run(0.0..6.0).unwrap();
    let sampled = circle.simulation(&start).hold(0.1, law).run(0.0..6.0).unwrap();
    assert!(worst(&braked) < 1e-15 && worst(&sampled) < 1e-15);
}

mechanical_system! {
    /// A body in water, whose drag changes its formula where it turns round.
    system Dragged {
        inputs { push }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
        forces { push - v*abs(v)/2 along v; }
    }
}

/// A step that ends at a switch, or is tried again because of one, is not the controller's: it is asked at its own times, once each.
#[test]
fn a_held_controller_keeps_its_times_over_switches() {
    let dragged = Dragged.prepare().unwrap();
    let start = dragged::State { x: 0.0, v: 0.3 };
    let push = |t: f64| dragged::Inputs { push: if t < 1.5 { -t - 0.5 } else { 4.0 } };
    // The expected end: one run for each period, with its constant push.
    let mut expected = start;
    for k in 0..3 {
        let t = f64::from(k);
        let driven = dragged.driven(push(t));
        expected = driven.simulation(&expected).tolerance(1e-12).run(t..t + 1.0).unwrap().end();
    }
    macro_rules! check {
        ($($method:expr;)*) => {$(
            let mut asked = Vec::new();
            let run = dragged.simulation(&start).hold(1.0, |t, _| {
                asked.push(t);
                push(t)
            });
            let motion = run.method($method).run(0.0..3.0).unwrap();
            assert_eq!(motion.statistics().work.switches, 2, "{}", stringify!($method));
            let end = motion.end();
            let error = f64::max((end.x - expected.x).abs(), (end.v - expected.v).abs());
            assert!(error < 1e-7, "{}: {end:?} instead of {expected:?}", stringify!($method));
            // Steps that were tried in vain are not kept.
            assert!(motion.times().is_sorted_by(|a, b| a < b), "{:?}", motion.times().collect::<Vec<_>>());
            drop(motion);
            assert_eq!(asked, [0.0, 1.0, 2.0], "{}", stringify!($method));
        )*};
    }
    check! { Dop853::new(1e-10, 1e-10); Tsit5::new(1e-9, 1e-9); Radau5::new(1e-9, 1e-9); }
}

#[test]
fn memory_is_bounded() {
    let hoop = prepared().unwrap();
    let error = hoop.simulation(&START).memory(20_000).run(0.0..60.0).unwrap_err();
    assert!(matches!(error.cause, Cause::Memory { limit: 20_000 }), "{error}");
    let steps = error.trajectory.times().count();
    assert!((20..40).contains(&steps), "{steps}");
    assert_eq!(error.trajectory.end_time(), error.time);
    // A guard with other limits still stands beside it.
    let guard = Guard { energy: 1e-18, ..Guard::default() };
    let error = hoop.simulation(&START).guard(guard).run(0.0..60.0).unwrap_err();
    assert!(matches!(error.cause, Cause::Energy { .. }), "{error}");
}
