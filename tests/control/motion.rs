//! Accelerations and reactions in outputs, reactions as forces, equations apart, inverse dynamics.

use guen::control::InverseDynamicsError;
use guen::prelude::*;

use crate::jacobians::{Cart, Hoop, ParticlePendulum, cart, numbers};
use crate::vehicles::{robot, small_robot, small_train, train};

guen::mechanical_system! {
    /// A ball on a slope that is tilted by a motor: friction, a moving frame, an IMU and the contact's force.
    pub system Roller {
        constants { m > 0, r > 0, c >= 0, rate }
        inputs { push }
        coordinates { x, y, w, i, j, k }
        let g = 9.81;
        let R = quaternion(w, i, j, k);
        let tilt = rate*sin(t);
        bodies { ball { mass: m, inertia: diag(2/5*m*r^2, 2/5*m*r^2, 2/5*m*r^2), center: vec(x, y, tilt*x), orientation: R } }
        gravity = vec(0, 0, -g);
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
        parameters { spin = angular_velocity(R); }
        constraints {
            roll_x: inner(vec(1, 0, 0), ball.velocity_at(ball.center - vec(0, 0, r))) = 0;
            roll_y: inner(vec(0, 1, 0), ball.velocity_at(ball.center - vec(0, 0, r))) = 0;
        }
        forces { -c*spin along angular_velocity(R); push along dot(x); }
        outputs {
            acceleration = dot(dot(ball.center));
            turning = dot(spin_x);
            jerk_free = dot(x*spin_y + t*dot(y));
            hold = reaction(roll_x);
            slip = dot(roll_y);
            place = ball.center;
        }
    }
}

/// The rates of outputs along the run, by differences in time.
#[test]
fn accelerations_are_rates_along_the_motion() {
    let system = Roller { m: 1.2, r: 0.3, c: 0.05, rate: 0.4 }.prepare().unwrap();
    let inputs = roller::Inputs { push: 0.7 };
    let mut s = numbers::<9>(2);
    let norm = s[2..6].iter().map(|q| q * q).sum::<f64>().sqrt();
    s[2..6].iter_mut().for_each(|q| *q /= norm);
    let t = 0.4;
    let driven = system.driven(inputs);
    let at = |time: f64| {
        let end = Integration::new(&driven, t, &s).run(&Dop853::new(1e-13, 1e-13), time);
        roller::State::from(end.unwrap().state)
    };
    let h = 1e-4;
    let (before, after) = (at(t - h), at(t + h));
    let rate = |f: &dyn Fn(f64, &roller::State) -> f64| (f(t + h, &after) - f(t - h, &before)) / (2.0 * h);
    let outputs = system.outputs(t, &s.into(), &inputs);
    // dz/dt = d(tilt x)/dt
    let vx = |t: f64, s: &roller::State| system.velocities(t, s).x;
    let vy = |t: f64, s: &roller::State| system.velocities(t, s).y;
    let vz = |t: f64, s: &roller::State| 0.4 * (t.sin() * system.velocities(t, s).x + t.cos() * s.x);
    for (found, expected) in outputs.acceleration.into_iter().zip([rate(&vx), rate(&vy), rate(&vz)]) {
        assert!((found - expected).abs() < 1e-6, "{found} and {expected}");
    }
    assert!((outputs.turning - rate(&|_, s| s.spin_x)).abs() < 1e-6);
    let mixed = rate(&|t, s| s.x * s.spin_y + t * system.velocities(t, s).y);
    assert!((outputs.jerk_free - mixed).abs() < 1e-6, "{} and {mixed}", outputs.jerk_free);
    assert_eq!(outputs.slip, 0.0);
    assert!((outputs.hold - system.reactions(t, &s.into(), &inputs).roll_x).abs() < 1e-13);
    // The derivatives of outputs know that accelerations depend on the state.
    let linear = system.linearize_outputs(t, &s.into(), &inputs);
    for j in 0..9 {
        let moved = |by: f64| {
            let mut s = s;
            s[j] += by;
            system.outputs(t, &s.into(), &inputs)
        };
        let (above, below) = (moved(1e-5), moved(-1e-5));
        let slope = (above.turning - below.turning) / 2e-5;
        assert!((linear.c[3][j] - slope).abs() < 1e-7, "{} and {slope}", linear.c[3][j]);
    }
    assert!(linear.d[0][0] != 0.0);
}

/// The contact's force on a robot's wheel, and what the chassis feels, by Newton's second law for the whole, at every
/// step of a run.
#[test]
fn newton_and_euler_along_a_run() {
    let system = small_robot();
    let inputs = robot::Inputs { left_torque: 1.3, right_torque: 0.4 };
    let start = robot::State { tilt: 0.3, speed: 0.5, turn: 1.0, fall: -0.2, ..Default::default() };
    let driven = system.driven(inputs);
    let mut steps = 0;
    let mut check = |t: f64, s: &[f64; 9]| {
        let state = robot::State::from(*s);
        let outputs = system.outputs(t, &state, &inputs);
        let reactions = system.reactions(t, &state, &inputs);
        let rates = system.rhs(t, &state, &inputs);
        for (found, expected) in outputs.grip.iter().zip(reactions.rolling()) {
            assert!((found - expected).abs() < 1e-11, "{found} and {expected}");
        }
        assert!((outputs.pitching - rates.fall).abs() < 1e-12);
        let (sin, cos) = state.heading.sin_cos();
        let (m, mw, h, b) = (10.0, 1.0, 0.5, 0.3);
        // Along the heading and across it: the axle, the chassis, the wheels, all by hand.
        let axle = [rates.speed, state.speed * state.turn];
        let (st, ct) = state.tilt.sin_cos();
        // The chassis' centre is at h sin(tilt) ahead of the axle, in a frame that turns.
        let ahead = h * st;
        let ahead_rate = h * ct * state.fall;
        let ahead_rate2 = h * (ct * rates.fall - st * state.fall * state.fall);
        let chassis = [
            axle[0] + ahead_rate2 - ahead * state.turn * state.turn,
            axle[1] + 2.0 * ahead_rate * state.turn + ahead * rates.turn,
        ];
        let felt = [cos * chassis[0] - sin * chassis[1], sin * chassis[0] + cos * chassis[1]];
        for (found, expected) in outputs.felt.iter().zip(felt) {
            assert!((found - expected).abs() < 1e-10 * (1.0 + expected.abs()), "{found} and {expected}");
        }
        // Both contacts along the heading accelerate everything; across only `rolling` can push.
        let total = [m * chassis[0] + 2.0 * mw * axle[0], m * chassis[1] + 2.0 * mw * axle[1]];
        let grip =
            [cos * outputs.grip[0] + sin * outputs.grip[1], -sin * outputs.grip[0] + cos * outputs.grip[1]];
        let forward = grip[0] + reactions.other_rolling;
        assert!((forward - total[0]).abs() < 1e-10 * (1.0 + total[0].abs()), "{forward} and {}", total[0]);
        assert!((grip[1] - total[1]).abs() < 1e-10 * (1.0 + total[1].abs()), "{} and {}", grip[1], total[1]);
        // About the vertical through the axle's middle: m ahead (a across) with the moments of inertia, and the wheels'.
        let (a, c, i) = (0.5, 0.2, 0.003);
        let about = a * st * st + c * ct * ct + 2.0 * (i + mw * b * b);
        let change = 2.0 * (a - c) * st * ct * state.fall;
        let moment = about * rates.turn + change * state.turn + m * ahead * chassis[1];
        let lever = b * (reactions.other_rolling - grip[0]);
        assert!((lever - moment).abs() < 1e-10 * (1.0 + moment.abs()), "{lever} and {moment}");
        steps += 1;
    };
    check(0.0, &start.into());
    Rk4::new(0.002)
        .integrate(&driven, 0.0, &start.into(), 0.8, |t, s| {
            check(t, s);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert!(steps > 300);
}

/// A rod's tension along the arc, and the covector of all reactions: `R = lambda grad f`.
#[test]
fn the_covector_of_a_rod() {
    let (m, l, g) = (1.3, 0.8, 9.81);
    let system = ParticlePendulum { m, l, g }.prepare().unwrap();
    let start = crate::jacobians::particle_pendulum::State { x: 0.8, y: 0.0, omega: 2.0 };
    Rk4::new(0.001)
        .integrate(&system, 0.0, &start.into(), 3.0, |t, s| {
            let state = crate::jacobians::particle_pendulum::State::from(*s);
            let force = system.reaction_covector(t, &state);
            // Towards the centre: m l omega^2 - m g y/l.
            let tension = m * l * state.omega * state.omega - m * g * state.y / l;
            let expected = [-tension * state.x / l, -tension * state.y / l];
            assert!((force.x - expected[0]).abs() < 1e-10 * (1.0 + tension.abs()));
            assert!((force.y - expected[1]).abs() < 1e-10 * (1.0 + tension.abs()));
            ControlFlow::Continue(())
        })
        .unwrap();
    // With all constraints: the covector is the force that makes Newton's law hold for the hoop's centre.
    let hoop = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let mut s = numbers::<9>(3);
    s[0] += 1.5;
    let state = s.into();
    let covector = hoop.reaction_covector(0.0, &state);
    let reactions = hoop.reactions(0.0, &state);
    assert_eq!((covector.xi, covector.eta, covector.zeta), (reactions.eta4, reactions.eta5, reactions.eta6));
    // The hoop's centre has unit mass: xi'' = R_xi; its weight is in the force function of the tilt.
    let h = 1e-5;
    let near = |by: f64| {
        let step = guen::steppers::rk4::step(&hoop, 0.0, &s, by);
        hoop.velocities(0.0, &step.into()).xi
    };
    assert!(((near(h) - near(-h)) / (2.0 * h) - covector.xi).abs() < 1e-7);
}

#[test]
fn equations_apart() {
    let system = Cart { M: 2.0, m: 0.6, l: 0.5, I: 0.05.into(), c: 0.1, g: 9.81 }.prepare().unwrap();
    let state = cart::State::from(numbers::<4>(5));
    let inputs = cart::Inputs { push: 0.7, wind: -0.3 };
    let form = system.mass_form(0.4, &state, &inputs);
    let (sin, cos) = state.phi.sin_cos();
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14 * (1.0 + b.abs()), "{a} and {b}");
    close(form.mass[0][0], 2.6);
    close(form.mass[0][1], 0.3 * cos);
    close(form.mass[1][0], 0.3 * cos);
    close(form.mass[1][1], 0.6 * 0.25 + 0.05);
    close(form.bias[0], -0.3 * sin * state.omega * state.omega);
    close(form.bias[1], 0.1 * state.omega + 0.3 * 9.81 * sin);
    let decay = (-0.4_f64).exp();
    close(form.input[0][0], 1.0);
    close(form.input[0][1], decay);
    close(form.input[1][0], 0.0);
    close(form.input[1][1], decay * 0.5 * cos);
}

#[test]
fn inputs_for_given_accelerations() {
    let system = small_train();
    let state = train::State::from(numbers::<8>(4));
    let wanted = train::State { speed: 0.7, steer: -1.3, ..Default::default() };
    let inputs = system.inverse_dynamics(0.0, &state, &wanted).unwrap();
    let found = system.rhs(0.0, &state, &inputs);
    assert!((found.speed - 0.7).abs() < 1e-12 && (found.steer + 1.3).abs() < 1e-12, "{found:?}");

    // Two torques cannot set three accelerations; those that the motion has by itself they can.
    let robot = small_robot();
    let state = robot::State { tilt: 0.2, ..Default::default() };
    let wanted = robot::State { speed: 1.0, turn: 0.5, fall: 0.0, ..Default::default() };
    let found = robot.inverse_dynamics(0.0, &state, &wanted);
    assert!(matches!(found, Err(InverseDynamicsError::OutOfReach { rank: 2, .. })), "{found:?}");
    let given = robot::Inputs { left_torque: 0.7, right_torque: -0.4 };
    let rates = robot.rhs(0.0, &state, &given);
    let found = robot.inverse_dynamics(0.0, &state, &rates).unwrap();
    assert!((found.left_torque - 0.7).abs() < 1e-10 && (found.right_torque + 0.4).abs() < 1e-10, "{found:?}");
}

guen::mechanical_system! {
    /// A mass driven by a propeller: thrust is quadratic in the speed of rotation.
    pub system Propeller {
        constants { m > 0, k > 0 }
        inputs { rpm }
        coordinates { z }
        parameters { climb = dot(z); }
        kinetic_energy = m/2*climb^2;
        forces { k*rpm*abs(rpm) + rpm - m*9.81 along climb; }
    }
}

/// Forces that are not affine in the inputs: Newton's method on them.
#[test]
fn inputs_that_are_not_affine() {
    let system = Propeller { m: 2.0, k: 0.5 }.prepare().unwrap();
    let wanted = propeller::State { climb: 1.5, ..Default::default() };
    let inputs = system.inverse_dynamics(0.0, &Default::default(), &wanted).unwrap();
    assert!((system.rhs(0.0, &Default::default(), &inputs).climb - 1.5).abs() < 1e-12, "{inputs:?}");
    let form = system.mass_form(0.0, &Default::default(), &inputs);
    assert!((form.mass[0][0] * 1.5 + form.bias[0] - form.input[0][0] * inputs.rpm).abs() < 1e-12);
}

guen::mechanical_system! {
    /// A mass that is pulled by a spring whose other end is moved sideways.
    pub system Sideways {
        inputs { u }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = 1/2*v^2;
        forces { sqrt(1 + u^2) along v; }
    }
}

#[test]
fn a_force_that_does_not_change_at_zero() {
    let system = Sideways::default().prepare().unwrap();
    let given = sideways::Inputs { u: 0.5 };
    let rates = system.rhs(0.0, &Default::default(), &given);
    let found = system.inverse_dynamics(0.0, &Default::default(), &rates).unwrap();
    assert!((found.u.abs() - 0.5).abs() < 1e-12, "{found:?}");
    let start = sideways::Inputs { u: -1.0 };
    let found = system.inverse_dynamics_from(0.0, &Default::default(), &rates, &start).unwrap();
    assert!((found.u + 0.5).abs() < 1e-12, "{found:?}");
    // It pushes with one at least: that is not shown.
    let wanted = sideways::State { v: 0.5, ..Default::default() };
    let refused = system.inverse_dynamics(0.0, &Default::default(), &wanted).unwrap_err();
    assert!(matches!(refused, InverseDynamicsError::NotFound { starts: 17, .. }), "{refused:?}");
    assert!(refused.to_string().contains("another start may do"), "{refused}");
}

guen::mechanical_system! {
    /// Limits from constants, from numbers, and none.
    pub system Limited {
        constants { strong > 0, weak = 0 }
        inputs { motor in -strong..2*strong, brake in weak..1.5, free }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2/2;
        forces { motor - brake*v + free along v; }
    }
}

#[test]
fn inputs_have_limits() {
    let system = Limited::new(4.0).prepare().unwrap();
    let (lower, upper) = system.limits();
    assert_eq!((lower.motor, lower.brake, lower.free), (-4.0, 0.0, f64::NEG_INFINITY));
    assert_eq!((upper.motor, upper.brake, upper.free), (8.0, 1.5, f64::INFINITY));
    let clamped = system.clamped(&limited::Inputs { motor: 9.0, brake: -0.1, free: 1e9 });
    assert_eq!((clamped.motor, clamped.brake, clamped.free), (8.0, 0.0, 1e9));
    assert!(system.clamped(&limited::Inputs { motor: f64::NAN, ..Default::default() }).motor.is_nan());
    let crossed = Limited { strong: 4.0, weak: 2.0 }.prepare().unwrap_err();
    assert_eq!(crossed, guen::ConstantsError::Limits { input: "brake", lower: 2.0, upper: 1.5 });
}
