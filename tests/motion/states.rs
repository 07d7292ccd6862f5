//! States beside the motion: runs against closed forms and against right-hand sides written by hand.

use guen::lanes::{Backend, LaneTask, Lanes, Width, dispatch_on};
use guen::prelude::*;
use guen::{Dual, Laned, Level, renormalized};
use guen_study::{Digits71, Nodes, recover};

guen::mechanical_system! {
    /// A motor with a flywheel, whose current has an equation of its own.
    pub system Motor {
        constants { J: kg*m^2 > 0, R: Ohm > 0, L: H > 0, k: N*m/A, b: N*m*s >= 0 }
        inputs { voltage: V }
        coordinates { phi: rad }
        parameters { omega = dot(phi); }
        states {
            /// Through the winding.
            dot(current: A) = (voltage - R*current - k*omega)/L;
            dot(charge) = current;
        }
        kinetic_energy = J/2*omega^2;
        forces { k*current - b*omega along omega; }
        outputs { loss = R*current^2; slope = dot(current); }
        provide taylor;
        scene Electric { track current; provide loss, linearization, taylor; }
    }
}

const J: f64 = 0.3;
const R: f64 = 2.0;
const L: f64 = 0.5;
const K: f64 = 0.7;
const B: f64 = 0.1;
const VOLTAGE: f64 = 6.0;

fn prepared() -> motor::Prepared {
    Motor { J, R, L, k: K, b: B }.prepare().unwrap()
}

fn motor() -> motor::Driven {
    prepared().driven(motor::Inputs { voltage: VOLTAGE })
}

/// Speed and current are `steady + sum c_i v_i exp(s_i t)`, with the roots `s_i` of the characteristic polynomial.
fn closed_form(t: f64, [omega, current]: [f64; 2]) -> [f64; 2] {
    let (trace, determinant) = (-B / J - R / L, B / J * R / L + K * K / (J * L));
    let root = (trace * trace / 4.0 - determinant).sqrt();
    let roots = [trace / 2.0 + root, trace / 2.0 - root];
    let steady_current = VOLTAGE * B / (R * B + K * K);
    let steady = [steady_current * K / B, steady_current];
    // Of each mode the current is (s + b/J) J/k of the speed.
    let [p, q] = roots.map(|s| (s + B / J) * J / K);
    let (x, y) = (omega - steady[0], current - steady[1]);
    let (a, c) = ((y - q * x) / (p - q), (p * x - y) / (p - q));
    let (a, c) = (a * (roots[0] * t).exp(), c * (roots[1] * t).exp());
    [steady[0] + a + c, steady[1] + p * a + q * c]
}

#[test]
fn a_motor_runs_as_its_closed_form() {
    assert_eq!(motor::State::NAMES, ["phi", "omega", "current", "charge"]);
    let start = motor::State { omega: 1.0, current: -0.4, ..Default::default() };
    let system = motor();
    for t in [0.0, 0.1, 0.7, 3.0] {
        let expected = closed_form(t, [1.0, -0.4]);
        let near = |end: [f64; 4], tolerance: f64| {
            let off = (end[1] - expected[0]).abs().max((end[2] - expected[1]).abs());
            assert!(off < tolerance, "{t}: {end:?} {expected:?}");
        };
        let go_on = |_: f64, _: &[f64; 4]| ControlFlow::Continue(());
        near(
            Taylor::new(1e-13, 1e-13).integrate(&system, 0.0, &start.into(), t, go_on).unwrap().state,
            1e-11,
        );
        near(
            Dop853::new(1e-12, 1e-12).integrate(&system, 0.0, &start.into(), t, go_on).unwrap().state,
            1e-10,
        );
        near(Radau5::new(1e-11, 1e-11).integrate(&system, 0.0, &start.into(), t, go_on).unwrap().state, 1e-9);
        // The charge is the integral of the current, and J omega + b phi - k charge is constant.
        let end = motor::State::from(
            Dop853::new(1e-12, 1e-12).integrate(&system, 0.0, &start.into(), t, go_on).unwrap().state,
        );
        assert!((J * (end.omega - 1.0) + B * end.phi - K * end.charge).abs() < 1e-10);
    }
}

#[test]
fn states_have_units_names_and_outputs() {
    const { assert!(!motor::CONSERVATIVE) };
    assert_eq!(motor::REPORT.lines("States"), ["current: A: Through the winding.", "charge: s*A"]);
    assert_eq!(
        motor::REPORT.lines("Rates of the states"),
        ["current' = -(k*omega - voltage + R*current)/L", "charge' = current",]
    );
    let state = motor::State { omega: 2.0, current: 3.0, ..Default::default() };
    let system = prepared();
    let outputs = system.outputs(0.0, &state, &motor::Inputs { voltage: VOLTAGE });
    assert!((outputs.loss - R * 9.0).abs() < 1e-14);
    assert!((outputs.slope - (VOLTAGE - 3.0 * R - 2.0 * K) / L).abs() < 1e-13);
    // The power of the forces changes the mechanical energy, which knows no current.
    let power = system.power(0.0, &state, &motor::Inputs { voltage: VOLTAGE });
    assert!((power - (K * 3.0 - B * 2.0) * 2.0).abs() < 1e-14);
    assert!((system.energy(0.0, &state) - J * 2.0).abs() < 1e-14);
    let mut text = Vec::new();
    let motion = motor().simulate(&state, 0.0..1.0).unwrap();
    guen_study::Export::sampled(&motion, 0.5).write_csv(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    assert_eq!(text.lines().next(), Some("t [s],phi [rad],omega [1/s],current [A],charge [s*A]"), "{text}");
}

#[test]
fn velocities_say_nothing_of_states() {
    let system = prepared();
    let (x, w) = (motor::Coordinates { phi: 0.4 }, motor::Coordinates { phi: 2.5 });
    let (state, residuals) = motor::State::from_velocities(&system, 0.0, &x, &w);
    assert_eq!(<[f64; 4]>::from(state), [0.4, 2.5, 0.0, 0.0]);
    let []: [f64; 0] = residuals;
}

#[test]
fn a_scene_keeps_what_acts_on_its_states() {
    assert_eq!(motor::electric::State::NAMES, ["omega", "current"]);
    let scene = motor::Electric { J, R, L, k: K, b: B }.prepare().unwrap();
    let scene = scene.driven(motor::electric::Inputs { voltage: VOLTAGE });
    let start = motor::State { omega: 1.0, current: -0.4, ..Default::default() };
    let nodes = Nodes::new(&[0.0, 0.5, 1.0, 2.0]).unwrap();
    let run = |tolerance: f64| {
        let mut states = Vec::new();
        Integration::new(&scene, 0.0, &scene.project(&start.into()))
            .sample(nodes.times(), &mut |_, _, state| states.push(*state))
            .run(&Dop853::new(tolerance, tolerance), 2.0)
            .unwrap();
        states
    };
    // Angle and charge are integrals of what is kept.
    let recovered = recover(&scene, &motor(), &nodes, &run(1e-12), &run(1e-9), &start.into()).unwrap();
    let end = motor::State::from(*recovered.states.last().unwrap());
    let [omega, current] = closed_form(2.0, [1.0, -0.4]);
    assert!((end.omega - omega).abs() < 1e-10 && (end.current - current).abs() < 1e-10);
    assert!((J * (omega - 1.0) + B * end.phi - K * end.charge).abs() < 1e-6, "{end:?}");
    assert!(end.charge.abs() > 0.1);
}

guen::mechanical_system! {
    /// A rolling pendulum under a controller: a filter sees the acceleration of its bob, and an integrator the error of its angle.
    pub system Loop {
        constants { m > 0, M > 0, l > 0, tau > 0, kp, ki, c >= 0, g = 9.81 }
        inputs { wanted }
        coordinates { x, q }
        let bob = vec(x + l*sin(q), -l*cos(q));
        parameters { v = dot(x); w = dot(q); }
        // A state may stand above its section.
        let push = kp*(q - wanted) + ki*error + seen/5;
        states {
            dot(error) = q - wanted;
            dot(seen) = (dot(w) - seen)/tau;
            dot(worn) = push^2*sin(worn);
        }
        particles { M at vec(x, 0); m at bob; }
        gravity = vec(0, -g);
        forces { push - c*v along v; -dot(error)*worn along w; }
        outputs { effort = push; jerk = dot(seen); }
        provide taylor, carried;
        scene Filter { track seen; provide carried, linearization; }
    }
}

/// `m, M, l, tau, kp, ki, c, g`.
const VALUES: [f64; 8] = [0.4, 1.1, 0.8, 0.3, -6.0, -1.5, 0.2, 9.81];

fn system<R: Real>() -> r#loop::Prepared<R> {
    let [m, cart, l, tau, kp, ki, c, g] = VALUES.map(R::from_f64);
    Loop { m, M: cart, l, tau, kp, ki, c, g }.prepare().unwrap()
}

/// Derived by hand: a cart and a pendulum, `M a + bias = forces`.
fn by_hand<R: Real>([_, q, v, w, error, seen, worn]: [R; 7], wanted: R) -> [R; 7] {
    let [m, cart, l, tau, kp, ki, c, g] = VALUES.map(R::from_f64);
    let (s, cos) = q.sin_cos();
    let push = kp * (q - wanted) + ki * error + seen / R::from_f64(5.0);
    let off = q - wanted;
    // (M + m) x'' + m l c q'' = m l s w^2 + push - c v;  m l c x'' + m l^2 q'' = -m g l s - off worn
    let (a, b, d) = (cart + m, m * l * cos, m * l * l);
    let (f, h) = (m * l * s * w * w + push - c * v, -(m * g * l * s) - off * worn);
    let determinant = a * d - b * b;
    let (ax, aq) = ((d * f - b * h) / determinant, (a * h - b * f) / determinant);
    [v, w, ax, aq, off, (aq - seen) / tau, push * push * worn.sin()]
}

fn states() -> impl Iterator<Item = [f64; 7]> {
    (0..20).map(|k| std::array::from_fn(|i| ((k * 7 + i + 1) as f64 * 0.754_877).fract() * 2.0 - 1.0))
}

fn near(found: &[f64], expected: &[f64], tolerance: f64) {
    let size = expected.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance * size, "{found:?} and {expected:?}");
    }
}

#[test]
fn a_loop_of_filters_is_what_is_written_by_hand() {
    let inputs = r#loop::Inputs { wanted: 0.3 };
    let driven = system::<f64>().driven(inputs);
    let carried = system::<f64>().carried().unwrap();
    for state in states() {
        near(&driven.rhs(0.0, &state), &by_hand(state, 0.3), 1e-13);
        // Without a call, and in duals.
        let all = carried.carry(0.0, &state.into());
        let rates = r#loop::State::from(carried.rhs(0.0, &all, &inputs));
        near(&<[f64; 7]>::from(rates), &by_hand(state, 0.3), 1e-13);
        let jacobian = system::<f64>().linearize(0.0, &state.into(), &inputs);
        let lifted: [Dual<f64, 8>; 7] = std::array::from_fn(|j| Dual::variable(state[j], j));
        let slopes = by_hand(lifted, Dual::variable(0.3, 7)).map(|rate| rate.tangent);
        for ((a, b), slopes) in jacobian.a.iter().zip(&jacobian.b).zip(&slopes) {
            near(a, &slopes[..7], 1e-12);
            near(b, &slopes[7..], 1e-12);
        }
        let outputs = system::<f64>().outputs(0.0, &state.into(), &inputs);
        near(&[outputs.jerk], &[by_hand(state, 0.3)[5]], 1e-13);
    }
}

/// Seventy-one digits agree with the hand's to what a double says of the state.
#[test]
fn other_reals_have_the_same_rates() {
    let driven = system::<Digits71>().driven(r#loop::Inputs { wanted: Digits71::from_f64(0.3) });
    let mut narrow = 0.0_f64;
    for state in states() {
        let wide = state.map(Digits71::from_f64);
        let rates = driven.rhs(Digits71::zero(), &wide);
        let expected = by_hand(wide, Digits71::from_f64(0.3));
        for (a, b) in rates.into_iter().zip(expected) {
            assert!((a - b).abs().to_f64() < 1e-60 * (1.0 + b.abs().to_f64()));
            narrow = narrow.max(b.abs().to_f64());
        }
    }
    assert!(narrow > 0.1);
}

struct InLanes;

impl LaneTask for InLanes {
    type Output = ();

    fn run<L: Lanes>(self) {
        let driven = system::<f64>().driven(r#loop::Inputs { wanted: 0.3 });
        let states: Vec<[f64; 7]> = states().take(L::COUNT).collect();
        let gathered = <r#loop::Driven as Laned<7>>::gather::<L>(|_| &driven);
        let state: [L; 7] = std::array::from_fn(|k| L::from_fn(|lane| states[lane][k]));
        let rates = gathered.rhs(L::from_f64(0.0), &state);
        for (lane, state) in states.iter().enumerate() {
            assert_eq!(rates.map(|rate| rate.lane(lane)), driven.rhs(0.0, state), "to the bit");
        }
    }
}

#[test]
fn lanes_have_the_same_bits() {
    for width in [Width::Four, Width::Eight] {
        dispatch_on(Backend::best(), width, InLanes);
    }
}

#[test]
fn methods_agree_along_a_run() {
    let driven = system::<f64>().driven(r#loop::Inputs { wanted: 0.1 });
    let start = [0.0, 0.4, 0.0, 0.0, 0.0, 0.0, 0.2];
    let go_on = |_: f64, _: &[f64; 7]| ControlFlow::Continue(());
    let hand = guen::from_fn(|_t: f64, x: &[f64; 7]| by_hand(*x, 0.1));
    let reference = Dop853::new(1e-13, 1e-13).integrate(&hand, 0.0, &start, 3.0, go_on).unwrap().state;
    near(
        &Taylor::new(1e-13, 1e-13).integrate(&driven, 0.0, &start, 3.0, go_on).unwrap().state,
        &reference,
        1e-10,
    );
    near(
        &Dop853::new(1e-12, 1e-12).integrate(&driven, 0.0, &start, 3.0, go_on).unwrap().state,
        &reference,
        1e-9,
    );
    near(&Gauss6::new(0.01).integrate(&driven, 0.0, &start, 3.0, go_on).unwrap().state, &reference, 1e-7);
    let carried = system::<f64>().carried().unwrap();
    let all = carried.carry(0.0, &start.into());
    let carried = renormalized(carried.driven(r#loop::Inputs { wanted: 0.1 }));
    let end = Dop853::new(1e-12, 1e-12)
        .integrate(&carried, 0.0, &all.into(), 3.0, |_, _| ControlFlow::Continue(()))
        .unwrap();
    let end = r#loop::State::from(r#loop::carried::State::from(end.state));
    near(&<[f64; 7]>::from(end), &reference, 1e-9);
}

guen::mechanical_system! {
    /// A mass behind a chain of filters.
    pub system Ladder {
        count n = 4;
        constants   { m > 0, k > 0, tau[n] > 0 = 0.1 }
        coordinates { x }
        parameters  { v = dot(x); }
        states {
            dot(z[0]) = (x - z[0])/tau[0];
            for i in 1..n { dot(z[i]) = (z[i-1] - z[i])/tau[i]; }
        }
        kinetic_energy = m/2*v^2;
        forces  { -k*z[n-1] - v along v; }
        provide taylor;
        scene Filters { track z; provide taylor; }
    }
}

/// In Rust the states of a loop are an array.
#[test]
fn states_of_a_loop_are_an_array() {
    let ladder = Ladder { m: 1.0, k: 2.0, tau: [0.1, 0.2, 0.3, 0.4] }.prepare().unwrap();
    let state = ladder::State { x: 1.0, z: [0.5, 0.25, 0.0, -1.0], ..Default::default() };
    assert_eq!(ladder::State::NAMES, ["x", "v", "z[0]", "z[1]", "z[2]", "z[3]"]);
    let rates = ladder.rhs(0.0, &state);
    near(&rates.z, &[(1.0 - 0.5) / 0.1, (0.5 - 0.25) / 0.2, (0.25 - 0.0) / 0.3, (0.0 + 1.0) / 0.4], 1e-14);
    near(&[rates.v], &[2.0], 1e-15);
    assert_eq!(ladder.linearize(0.0, &state).a[5], [0.0, 0.0, 0.0, 0.0, 1.0 / 0.4, -1.0 / 0.4]);
}
