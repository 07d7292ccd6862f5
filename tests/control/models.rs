//! Discrete models, steady motions and controllability.

use guen::control::{DiscreteError, FlowMap, SteadyError, ZeroOrderHold, controllability};
use guen::prelude::*;

use crate::jacobians::{Cart, Hoop, Sled, cart, hoop, sled};
use crate::vehicles::{robot, small_robot};

fn pole_cart() -> cart::Prepared {
    Cart { M: 2.0, m: 0.6, l: 0.5, I: 0.05.into(), c: 0.1, g: 9.81 }.prepare().unwrap()
}

/// The linear model over a period, against its own integration in small steps.
#[test]
fn the_frozen_pair_solves_the_linear_model() {
    let (system, inputs) = (pole_cart(), cart::Inputs { push: 1.0, wind: 0.5 });
    let state = cart::State { x: 0.1, phi: 2.0, v: 0.4, omega: -3.0 };
    let linear = system.linearize(0.0, &state, &inputs);
    let rates: [f64; 4] = system.rhs(0.0, &state, &inputs).into();
    for h in [0.01, 2.0] {
        let pair = ZeroOrderHold::new(&linear, &rates, h).unwrap();
        let (ds, du) = ([0.1, -0.2, 0.3, 0.05], [0.7, -0.4]);
        let model = from_fn(|_t: f64, s: &[f64; 4]| {
            std::array::from_fn(|i| {
                let free: f64 = (0..4).map(|j| linear.a[i][j] * s[j]).sum();
                rates[i] + free + (0..2).map(|j| linear.b[i][j] * du[j]).sum::<f64>()
            })
        });
        let end = Integration::new(&model, 0.0, &ds).run(&Dop853::new(1e-13, 1e-13), h).unwrap();
        for i in 0..4 {
            let free: f64 = (0..4).map(|j| pair.phi[i][j] * ds[j]).sum();
            let found = pair.offset[i] + free + (0..2).map(|j| pair.gamma[i][j] * du[j]).sum::<f64>();
            assert!(
                (found - end.state[i]).abs() < 1e-9 * (1.0 + end.state[i].abs()),
                "{found} {}",
                end.state[i]
            );
        }
    }
    let broken = [f64::NAN; 4];
    assert_eq!(ZeroOrderHold::new(&linear, &broken, 0.1), Err(DiscreteError::NotFinite));
}

/// The Jacobian of the flow against differences of it, and its state against the stepper, bit for bit.
#[test]
fn the_flow_and_its_derivatives() {
    let (system, inputs) = (pole_cart(), cart::Inputs { push: 1.0, wind: 0.5 });
    let (state, u): ([f64; 4], [f64; 2]) = ([0.1, 2.0, 0.4, -3.0], inputs.into());
    let (h, steps) = (0.08, 4);
    let flow = FlowMap::new(&system, 0.2, &state, &u, h, steps).unwrap();
    let next = |s: &[f64; 4], u: &[f64; 2]| {
        let driven = system.driven((*u).into());
        (0..steps)
            .fold(*s, |s, k| guen::steppers::rk4::step(&driven, 0.2 + f64::from(k) * (h / 4.0), &s, h / 4.0))
    };
    assert_eq!(flow.next, next(&state, &u));
    let e = 1e-6;
    for j in 0..6 {
        let moved = |by: f64| {
            let (mut s, mut v) = (state, u);
            if j < 4 {
                s[j] += by
            } else {
                v[j - 4] += by
            }
            next(&s, &v)
        };
        let (above, below) = (moved(e), moved(-e));
        for i in 0..4 {
            let expected = (above[i] - below[i]) / (2.0 * e);
            let found = if j < 4 { flow.phi[i][j] } else { flow.gamma[i][j - 4] };
            assert!((found - expected).abs() < 1e-8, "({i}, {j}): {found} and {expected}");
        }
    }
    assert_eq!(FlowMap::new(&system, 0.0, &state, &u, h, 0), Err(DiscreteError::NoSteps));
    // To first order in the period both models are one; they differ in the second.
    let rates: [f64; 4] = system.rhs(0.2, &state.into(), &inputs).into();
    let linear = system.linearize(0.2, &state.into(), &inputs);
    let difference = |h: f64| {
        let frozen = ZeroOrderHold::new(&linear, &rates, h).unwrap();
        let flow = FlowMap::new(&system, 0.2, &state, &u, h, 1).unwrap();
        (frozen.phi[3][1] - flow.phi[3][1]).abs()
    };
    let order = (difference(0.02) / difference(0.01)).log2();
    assert!((order - 2.0).abs() < 0.2, "{order}");
}

#[test]
fn equilibria_of_a_cart() {
    let system = pole_cart();
    let guess = cart::State { x: 0.3, phi: 2.9, v: 0.2, omega: 0.4 };
    // Upright, wherever the cart is, without a push; the wind is fixed to a breeze.
    let breeze = cart::Inputs { push: 0.0, wind: 0.5 };
    let (state, inputs) = system.equilibrium(0.0, &guess, &breeze, &["x", "wind"]).unwrap();
    assert_eq!((state.x, state.v, inputs.wind), (0.3, 0.0, 0.5));
    assert!(state.omega.abs() < 1e-15, "{}", state.omega);
    // The wind pushes cart and pole alike: the push holds against both, and the pole leans.
    assert!((inputs.push + 0.5).abs() < 1e-12, "{inputs:?}");
    let rates: [f64; 4] = system.rhs(0.0, &state, &inputs).into();
    assert!(rates.iter().all(|rate| rate.abs() < 1e-12), "{rates:?}");
    assert!((state.phi.tan() - 0.5 / (0.6 * 9.81)).abs() < 1e-12 && state.phi > 3.0, "{}", state.phi);
    // Without a word on the place and the wind there is a family.
    assert_eq!(system.equilibrium(0.0, &guess, &breeze, &[]), Err(SteadyError::Family { dimension: 2 }));
    // A pole that leans by a given angle and no wind: none.
    let fixed = ["x", "phi", "wind"];
    let found = system.equilibrium(0.0, &cart::State { phi: 2.0, ..guess }, &Default::default(), &fixed);
    assert!(matches!(found, Err(SteadyError::NotFound { residual }) if residual > 0.1), "{found:?}");
    assert_eq!(
        system.equilibrium(0.0, &guess, &breeze, &["speed"]),
        Err(SteadyError::UnknownName { name: "speed" })
    );
}

/// A rolling hoop's circle: tilt and rolling are chosen, the turning follows; then it does go in a circle.
#[test]
fn the_circle_of_a_hoop() {
    let system = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let guess = hoop::State { theta: 1.2, eta2: 0.5, eta3: 4.0, ..Default::default() };
    let drifting = ["psi", "phi", "xi", "eta", "zeta"];
    let found = system.steady_motion(0.0, &guess, &drifting, &["theta"]);
    assert_eq!(found, Err(SteadyError::Family { dimension: 1 }));
    let state = system.steady_motion(0.0, &guess, &drifting, &["theta", "eta3"]).unwrap();
    assert!(
        state.eta1 == 0.0 && state.eta2.abs() > 0.1 && state.theta == 1.2 && state.eta3 == 4.0,
        "{state:?}"
    );
    // A cot(theta) eta2^2 - (C + a^2) eta2 eta3 = a g cos(theta), from (3.6).
    let left = 0.4 / 1.2_f64.tan() * state.eta2 * state.eta2 - (0.6 + 0.49) * state.eta2 * 4.0;
    assert!((left - 0.7 * 9.81 * 1.2_f64.cos()).abs() < 1e-12, "{left}");
    // One turn of psi later it is where it was.
    let turn = 2.0 * std::f64::consts::PI / system.velocities(0.0, &state).psi.abs();
    let end = Integration::new(&system, 0.0, &state.into()).run(&Dop853::new(1e-12, 1e-12), turn).unwrap();
    let end = hoop::State::from(end.state);
    assert!(end.xi.abs() < 1e-8 && end.eta.abs() < 1e-8 && (end.theta - 1.2).abs() < 1e-8, "{end:?}");
}

guen::mechanical_system! {
    /// A car with a trailer whose coordinate is the angle at the hitch, with rolling resistance.
    pub system Hitched {
        constants { m > 0, J > 0, base > 0, d > 0, c > 0 }
        inputs { thrust, steering_torque }
        coordinates { x, y, heading, hitch, steering }
        let rear = vec(x, y);
        let ahead = vec(cos(heading), sin(heading));
        let left = vec(-sin(heading), cos(heading));
        let tongue = vec(cos(heading + hitch), sin(heading + hitch));
        let across = vec(-sin(heading + hitch), cos(heading + hitch));
        let trailer = rear - d*tongue;
        parameters { speed = inner(dot(rear), ahead); steer = dot(steering); }
        constraints {
            rear_grip: inner(dot(rear), left) = 0;
            front_grip: inner(dot(rear + base*ahead), cos(steering)*left - sin(steering)*ahead) = 0;
            trailer_grip: inner(dot(trailer), across) = 0;
        }
        particles { m at rear + base/2*ahead; m/2 at trailer; }
        kinetic_energy = J/2*(dot(heading)^2 + dot(steering)^2 + dot(heading + hitch)^2);
        forces { thrust - c*speed along speed; steering_torque along steer; }
    }
}

/// A car with a trailer that turns steadily: the hitch angle and the thrust follow from steering and speed.
#[test]
fn a_turning_car() {
    let (base, d, c) = (2.5, 3.0, 40.0);
    let system = Hitched { m: 900.0, J: 1200.0, base, d, c }.prepare().unwrap();
    let guess = hitched::State { hitch: -0.2, steering: 0.3, speed: 4.0, ..Default::default() };
    let drifting = ["x", "y", "heading"];
    let none = hitched::Inputs::default();
    let open = system.steady_motion(0.0, &guess, &none, &drifting, &[]);
    assert_eq!(open, Err(SteadyError::Family { dimension: 2 }));
    let (state, inputs) =
        system.steady_motion(0.0, &guess, &none, &drifting, &["steering", "speed"]).unwrap();
    let rates = system.rhs(0.0, &state, &inputs);
    assert!([rates.hitch, rates.steering, rates.speed, rates.steer].iter().all(|rate| rate.abs() < 1e-10));
    assert!((state.steering, state.speed) == (0.3, 4.0) && state.steer.abs() < 1e-15);
    // The trailer's axle points to the centre of the turn: d = R sin(-hitch) with R = base/tan(steering).
    let radius = base / 0.3_f64.tan();
    assert!((state.hitch.sin() + d / radius).abs() < 1e-12, "{}", state.hitch);
    assert!((rates.heading - 4.0 / radius).abs() < 1e-12 && inputs.thrust > 100.0, "{inputs:?}");
    // A hitch too long for so tight a turn.
    let tight = hitched::State { steering: 0.9, ..guess };
    let found = system.steady_motion(0.0, &tight, &none, &drifting, &["steering", "speed"]);
    assert!(matches!(found, Err(SteadyError::NotFound { .. })), "{found:?}");
}

/// At rest a nonholonomic system has modes that no input reaches, although its brackets reach every place.
#[test]
fn what_inputs_reach() {
    let system = small_robot();
    let upright = robot::State::default();
    let reduced =
        system.reduce(0.0, &upright, &Default::default(), &["x", "y", "heading", "tilt", "left"]).unwrap();
    let found = controllability(&reduced.linear, 1e-9);
    // Sideways it cannot go; and the left wheel is bound to x and heading to first order.
    assert_eq!((found.rank, found.zero_modes), (6, 2));
    assert!(found.modes().iter().any(|mode| mode[1].abs() > 1e-6));
    let error = found.require().unwrap_err();
    assert!(error.to_string().contains("nonholonomic"), "{error}");
    assert_eq!(*robot::GROWTH.last().unwrap(), 5);
    // In motion the sideways place is reached through the heading.
    let (state, inputs) = system
        .steady_motion(
            0.0,
            &robot::State { speed: 1.0, ..upright },
            &Default::default(),
            &["x", "y", "heading", "left", "right"],
            &["speed", "turn"],
        )
        .unwrap();
    let moving = system.reduce(0.0, &state, &inputs, &["x", "y", "heading", "tilt", "left"]).unwrap();
    assert_eq!(controllability(&moving.linear, 1e-9).rank, 7);

    // The sled on a slope has no inputs at all: nothing is reached, and every conserved direction is found.
    let sled = Sled { m: 1.3, alpha: 0.2, beta: 0.1, k: 0.5, incline: 0.0, g: 9.81 }.prepare().unwrap();
    let linear = sled.linearize(0.0, &sled::State::default());
    let found = controllability(&linear, 1e-9);
    assert_eq!((found.rank, found.zero_modes), (0, 3));
}

mod on_constraints {
    use super::*;
    use guen::mechanical_system;

    mechanical_system! {
        /// A pendulum in Cartesian coordinates, pushed to the side.
        pub system Hanging {
            constants { m > 0 = 2, l > 0 = 1.5, g = 9.81 }
            inputs { push }
            coordinates { x, y }
            holonomic { rod: x^2 + y^2 = l^2; }
            parameters { w = (x*dot(y) - y*dot(x))/l^2; }
            particles { m at vec(x, y); }
            forces { push along dot(x); }
            gravity = vec(0, -g);
        }
    }

    mechanical_system! {
        /// Four bars of which the first one stands, hanging from it.
        pub system FourBar {
            constants { m > 0 = 1, a > 0 = 1, b > 0 = 2, c > 0 = 1.5, d > 0 = 2, g = 9.81 }
            coordinates { p, q, r }
            let A = a*vec(cos(p), sin(p));
            let B = A + b*vec(cos(q), sin(q));
            let C = vec(d, 0) + c*vec(cos(r), sin(r));
            holonomic {
                level: B.x - C.x = 0;
                upright: B.y - C.y = 0;
            }
            particles { m at A; m at (A + B)/2; m at B; }
            gravity = vec(0, -g);
        }
    }

    mechanical_system! {
        /// A bead on a line that moves away.
        pub system Moved {
            constants { v = 1 }
            coordinates { x, y }
            holonomic { line: x - v*t = 0; }
            kinetic_energy = (dot(x)^2 + dot(y)^2)/2;
            potential_energy = y^2/2;
        }
    }

    #[test]
    fn a_pendulum_in_two_coordinates_hangs_at_one_place() {
        let pendulum = Hanging::default().prepare().unwrap();
        for (push, guess) in [(0.0, [0.6, -0.8]), (5.0, [0.1, -3.0]), (-20.0, [-1.0, -1.0])] {
            let state = hanging::State { x: guess[0], y: guess[1], w: 0.1 };
            let (found, _) = pendulum.equilibrium(0.0, &state, &hanging::Inputs { push }, &["push"]).unwrap();
            let pull = f64::hypot(push, 2.0 * 9.81);
            let expected = [1.5 * push / pull, -1.5 * 2.0 * 9.81 / pull, 0.0];
            for (found, expected) in <[f64; 3]>::from(found).iter().zip(expected) {
                assert!((found - expected).abs() < 1e-13, "{found} {expected}");
            }
        }
        // Every place is held by some push, so that one has to be chosen.
        let guess = hanging::State { x: 0.9, y: -1.3, w: 0.0 };
        let none = hanging::Inputs { push: 0.0 };
        assert_eq!(pendulum.equilibrium(0.0, &guess, &none, &[]), Err(SteadyError::Family { dimension: 1 }));
        let (found, held) = pendulum.equilibrium(0.0, &guess, &none, &["x"]).unwrap();
        assert!(found.x == 0.9 && (found.y + 1.2).abs() < 1e-13);
        assert!((held.push - 2.0 * 9.81 * 0.9 / 1.2).abs() < 1e-11, "{held:?}");
        // There is none outside of the circle.
        let outside = hanging::State { x: 1.6, ..guess };
        let found = pendulum.equilibrium(0.0, &outside, &none, &["x"]);
        assert!(matches!(found, Err(SteadyError::NotFound { .. })), "{found:?}");
    }

    #[test]
    fn a_closed_chain_hangs_where_its_energy_is_least() {
        let bars = FourBar::default().prepare().unwrap();
        let guess = four_bar::State { p: -0.5, q: -0.3, r: -1.5, ..Default::default() };
        let found = bars.equilibrium(0.0, &guess, &[]).unwrap();
        let rest = bars.residuals(0.0, &found);
        assert!(rest.level.abs() < 1e-12 && rest.upright.abs() < 1e-12, "{found:?} {rest:?}");
        let rates: [f64; 4] = bars.rhs(0.0, &found).into();
        assert!(rates.iter().all(|rate| rate.abs() < 1e-11), "{rates:?}");
        // Beside it, on the constraints, the potential energy is larger or smaller on both sides.
        let energy = |p: f64| {
            let beside = four_bar::Coordinates { p, ..found.coordinates() };
            let beside = bars.consistent(0.0, &beside, &["p"]).unwrap();
            -bars.force_function(0.0, &four_bar::State { p, q: beside.q, r: beside.r, ..found })
        };
        let [before, at, behind] = [-1e-3, 0.0, 1e-3].map(|step| energy(found.p + step));
        assert!(
            (before - at) * (behind - at) > 0.0 && (before - behind).abs() < 1e-7,
            "{before} {at} {behind}"
        );
    }

    #[test]
    fn what_constraints_move_does_not_rest() {
        let bead = Moved::default().prepare().unwrap();
        let guess = moved::State { x: 0.3, y: 0.5, ..Default::default() };
        let found = bead.equilibrium(0.3, &guess, &[]);
        assert!(matches!(found, Err(SteadyError::NotFound { residual }) if residual >= 0.9), "{found:?}");
    }
}
