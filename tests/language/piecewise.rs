//! Piecewise functions: rates and linearisations on both sides of every switch, in every real.

use guen::mechanical_system;
use guen::steppers::{Dop853, Integration, Outcome};
use guen::{Dual, Real, Simulate, System, maximum, minimum, select};

mechanical_system! {
    /// Forces with every piecewise function, along a coordinate each.
    pub system Steps {
        constants   { k > 0, low = -1, high = 2 }
        inputs      { u }
        coordinates { x, y }
        parameters  { v = dot(x); w = dot(y); }
        kinetic_energy   = (v^2 + w^2)/2;
        potential_energy = k/2*max(0, -x)^2 + min(x*y, y^2/2, 3);
        forces {
            select(v > w, -v, u) + floor(y + 1/2) along v;
            clamp(2*y, low, high)*abs(w) + sign(x - y) along w;
        }
        outputs {
            side = select(x <= 0, vec(x, y), vec(y, 2*x));
            safe = select(x >= 0, sqrt(x), 0);
            least = x.min(y).max(low);
        }
    }
}

/// The forces by hand, and the two accelerations.
fn by_hand(k: f64, u: f64, [x, y, v, w]: [f64; 4]) -> [f64; 2] {
    let stop = if x < 0.0 { -k * x } else { 0.0 };
    let (xy, half) = (x * y, y * y / 2.0);
    let least = xy.min(half).min(3.0);
    let (by_x, by_y) = if least == 3.0 {
        (0.0, 0.0)
    } else if least == xy {
        (y, x)
    } else {
        (0.0, y)
    };
    let drive = if v > w { -v } else { u };
    let limited = (2.0 * y).clamp(-1.0, 2.0);
    [drive + (y + 0.5).floor() + stop - by_x, limited * w.abs() + (x - y).signum() - by_y]
}

/// States on all sides, none on a switch.
fn states() -> impl Iterator<Item = [f64; 4]> {
    let values = [-2.7, -0.6, 0.35, 1.4, 3.1];
    (0..625).map(move |n: usize| {
        let pick = |place: u32, shift: f64| values[n / 5_usize.pow(place) % 5] + shift;
        [pick(0, 0.0), pick(1, 0.013), pick(2, 0.021), pick(3, 0.032)]
    })
}

#[test]
fn every_branch_is_taken_where_it_holds() {
    let (k, u) = (7.0, 0.4);
    let steps = Steps { k, low: -1.0, high: 2.0 }.prepare().unwrap();
    for state in states() {
        let rate = steps.rhs(0.0, &state.into(), &steps::Inputs { u });
        let expected = by_hand(k, u, state);
        assert!((rate.v - expected[0]).abs() < 1e-13 && (rate.w - expected[1]).abs() < 1e-13, "{state:?}");
        let outputs = steps.outputs(0.0, &state.into(), &steps::Inputs { u });
        let [x, y, ..] = state;
        let side = if x <= 0.0 { [x, y, 0.0] } else { [y, 2.0 * x, 0.0] };
        assert_eq!((outputs.side, outputs.least), (side, x.min(y).max(-1.0)));
        // The branch that is not taken is no number for negative `x`.
        assert_eq!(outputs.safe, if x >= 0.0 { x.sqrt() } else { 0.0 });
    }
}

/// The emitted linearisation is that of dual numbers, and of differences.
#[test]
fn slopes_are_those_of_the_branch() {
    let steps = Steps { k: 7.0, low: -1.0, high: 2.0 }.prepare().unwrap();
    let lifted = steps.lift::<Dual<f64, 1>>();
    for state in states() {
        let linear = steps.linearize(0.0, &state.into(), &steps::Inputs { u: 0.4 });
        for j in 0..4 {
            let dual: [Dual<f64, 1>; 4] = core::array::from_fn(|i| {
                if i == j { Dual::variable(state[i], 0) } else { Dual::constant(state[i]) }
            });
            let rates = lifted.rhs(Dual::zero(), &dual.into(), &steps::Inputs { u: Dual::constant(0.4) });
            let rates: [Dual<f64, 1>; 4] = rates.into();
            let moved = |by: f64| {
                let mut state = state;
                state[j] += by;
                let hand = by_hand(7.0, 0.4, state);
                [state[2], state[3], hand[0], hand[1]]
            };
            let (ahead, behind) = (moved(1e-5), moved(-1e-5));
            for i in 0..4 {
                assert!((linear.a[i][j] - rates[i].tangent[0]).abs() < 1e-13, "{state:?}: {i} by {j}");
                let slope = (ahead[i] - behind[i]) / 2e-5;
                assert!((linear.a[i][j] - slope).abs() < 1e-7, "{state:?}: {i} by {j}");
            }
        }
    }
}

/// What is not a number stays so, in every real.
#[test]
fn nothing_is_chosen_by_what_is_not_a_number() {
    fn check<R: Real>() {
        let (nan, one, two) = (R::from_f64(f64::NAN), R::one(), R::from_ratio(2, 1));
        let chosen = [
            select(nan, one, two),
            minimum(nan, one),
            minimum(one, nan),
            maximum(nan, one),
            maximum(one, nan),
        ];
        assert!(chosen.iter().all(|x| x.to_f64().is_nan()), "{chosen:?}");
        assert_eq!(
            [minimum(one, two), minimum(two, one), maximum(one, two), maximum(two, one)],
            [one, one, two, two]
        );
        let half = R::from_ratio(1, 2);
        assert_eq!([half.floor(), (-half).floor(), two.floor()], [R::zero(), -one, two]);
        assert_eq!([select(R::zero(), one, two), select(-half, one, two)], [one, two]);
    }
    check::<f64>();
    check::<f32>();
    check::<Dual<f64, 2>>();
    check::<guen::PowerSeries<f64>>();
    check::<guen::RunningError<f64>>();
    check::<guen::Fused<f64>>();
}

/// Lanes choose each by itself, with the bits of one number.
#[test]
fn lanes_choose_each_by_itself() {
    use guen::lanes::{LaneTask, Lanes, Width, dispatch};
    struct Rates([[f64; 4]; 8]);
    impl LaneTask for Rates {
        type Output = [[f64; 4]; 8];
        fn run<L: Lanes>(self) -> Self::Output {
            let steps = Steps { k: 7.0, low: -1.0, high: 2.0 }.prepare().unwrap();
            let steps = steps.lift::<L>();
            let mut found = [[0.0; 4]; 8];
            for first in (0..8).step_by(L::COUNT) {
                let state: [L; 4] = core::array::from_fn(|i| L::from_fn(|lane| self.0[first + lane][i]));
                let inputs = steps::Inputs { u: L::from_f64(0.4) };
                let rates: [L; 4] = steps.rhs(L::zero(), &state.into(), &inputs).into();
                for lane in 0..L::COUNT {
                    found[first + lane] = rates.map(|rate| rate.lane(lane));
                }
            }
            found
        }
    }
    let all: Vec<[f64; 4]> = states().collect();
    for states in all.chunks_exact(8) {
        let states: [[f64; 4]; 8] = states.try_into().unwrap();
        let alone = dispatch(Width::One, Rates(states));
        for width in [Width::Four, Width::Eight] {
            assert_eq!(dispatch(width, Rates(states)), alone);
        }
    }
}

mechanical_system! {
    /// A mass on a belt, between a spring and a stop, with everything that a scene and a carried form pass on.
    pub system Belt {
        constants   { m > 0, k > 0, stop > 0, friction >= 0, belt, wall > 0 }
        inputs      { push }
        coordinates { x, q }
        parameters  { v = dot(x); w = dot(q); }
        kinetic_energy   = m/2*v^2 + w^2/2;
        potential_energy = k/2*x^2 + stop/2*max(0, x - wall)^2 - cos(q);
        forces { friction*sign(belt - v) + push along v; }
        outputs { beyond = max(0, x - wall); never = select(q >= 0, 1, 0); }
        provide carried;
        scene Swing { track q; }
        scene Slide { track x; }
    }
}

fn belt() -> Belt {
    Belt { m: 2.0, k: 3.0, stop: 50.0, friction: 0.7, belt: 0.25, wall: 0.8 }
}

/// Each function of the rates, once, in the words of the declaration; what outputs alone use is none.
#[test]
fn switching_functions_have_names() {
    assert_eq!(belt::SWITCHES, ["wall - x", "v - belt"]);
    assert_eq!(<belt::Driven as Simulate<f64, 4>>::SWITCHES, belt::SWITCHES);
    assert_eq!(belt::slide::SWITCHES, belt::SWITCHES);
    assert!(<belt::swing::Prepared as Simulate<f64, 2>>::SWITCHES.is_empty());
    let driven = belt().prepare().unwrap().driven(belt::Inputs { push: 0.4 });
    let mut values = [0.0; 8];
    let state = [1.0, 0.1, 0.5, 0.2];
    assert_eq!(System::switches(&driven, 0.0, &state, &mut values), 2);
    assert!((values[0] + 0.2).abs() < 1e-15 && (values[1] - 0.25).abs() < 1e-15, "{values:?}");
}

/// The motion of `Belt` by hand, phase after phase, with the formula of each.
#[test]
fn tolerances_hold_over_the_switches_of_a_declaration() {
    let driven = belt().prepare().unwrap().driven(belt::Inputs { push: 0.4 });
    let start = belt::State { x: -2.0, q: 0.3, v: 0.0, w: 0.0 };
    // The reference runs each phase with the branches as they are, from event to event.
    let reference = {
        let (mut time, mut state, mut phases) = (0.0, [-2.0_f64, 0.0], 0);
        let (mut slip, mut contact) = (1.0, false);
        loop {
            let rates = move |_t: f64, &[x, v]: &[f64; 2]| {
                let stop = if contact { 50.0 * (x - 0.8) } else { 0.0 };
                [v, (0.4 + 0.7 * slip - 3.0 * x - stop) / 2.0]
            };
            let phase = guen::from_fn(rates);
            let (speed, wall) = (|_t: f64, x: &[f64; 2]| x[1] - 0.25, |_t: f64, x: &[f64; 2]| x[0] - 0.8);
            let events =
                [guen::steppers::Event::new(&speed).terminal(), guen::steppers::Event::new(&wall).terminal()];
            let mut seen = |_: &guen::steppers::Occurrence<f64, 2>| core::ops::ControlFlow::Continue(());
            let done = Integration::new(&phase, time, &state)
                .events(events, &mut seen)
                .run(&Dop853::new(1e-14, 1e-14), 6.0);
            let done = done.unwrap();
            (time, state) = (done.time, done.state);
            match done.outcome {
                Outcome::Event(0) => slip = -slip,
                Outcome::Event(_) => contact = !contact,
                _ => {}
            }
            if time == 6.0 {
                assert!(phases > 4, "{phases}");
                break state;
            }
            phases += 1;
        }
    };
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let method = Dop853::new(tolerance, tolerance);
        let done = Integration::new(&driven, 0.0, &start.into()).run(&method, 6.0).unwrap();
        let error = (done.state[0] - reference[0]).abs().max((done.state[2] - reference[1]).abs());
        assert!(error < 200.0 * tolerance && done.statistics.switches > 4, "{tolerance}: {error}");
        // The carried form has the same switches.
        let carried = belt().prepare().unwrap().carried().unwrap();
        let lifted = start.carried(&carried, 0.0);
        let carried = carried.driven(belt::Inputs { push: 0.4 });
        let done = Integration::new(&carried, 0.0, &lifted.into()).run(&method, 6.0).unwrap();
        let error = (done.state[0] - reference[0]).abs().max((done.state[2] - reference[1]).abs());
        assert!(error < 200.0 * tolerance, "carried, {tolerance}: {error}");
    }
}

/// A block that comes to rest on the belt has no motion by these rates: the error says so in the words of the declaration.
#[test]
fn a_block_that_sticks_is_told_of() {
    let belt = Belt { k: 0.1, friction: 3.0, ..belt() }.prepare().unwrap().driven(belt::Inputs { push: 0.0 });
    let start = belt::State { x: 0.1, q: 0.3, v: -0.5, w: 0.0 };
    let error = belt.simulate(&start, 0.0..6.0).unwrap_err().to_string();
    assert!(error.contains("`v - belt` = 0") && error.contains("`contacts`"), "{error}");
}

mechanical_system! {
    /// A body that a force pushes for a hundredth of a second, after fifty without one.
    system PushedOnce {
        constants { m = 1, from = 50, w = 1/100 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { select((t - from)*(from + w - t) >= 0, 1, 0) along v; }
    }
}

/// The sign of a polynomial of the time is uncertain around its zeros, and no motion slides there.
#[test]
fn a_switch_of_time_alone_does_not_slide() {
    let body = PushedOnce::default().prepare().unwrap();
    for v in [0.0, 1.0] {
        let motion = body.simulate(&pushed_once::State { x: 0.0, v }, 0.0..100.0).unwrap();
        assert!((motion.end().v - v - 0.01).abs() < 1e-6, "{:?}", motion.end());
    }
}
