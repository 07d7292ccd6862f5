//! Piecewise functions in systems with contacts: their branches are held within a mode and change at located times, against closed forms.

use guen::hybrid::{HybridCause, TransitionKind};
use guen::mechanical_system;
use guen::prelude::*;

mechanical_system! {
    /// A ball that falls on a spring, and through it on a floor. Gravity is 1 in all of these.
    pub system Buffer {
        constants { k = 4, h = 1/2, e = 1/2 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = z;
        forces { k*max(0, h - z) along v; }
        contacts { floor: gap = z + 10, restitution = e; }
    }
}

mechanical_system! {
    /// The same with the spring as an energy, whose slope has a kink.
    pub system BufferEnergy {
        constants { k = 4, h = 1/2 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = z + k/2*max(0, h - z)^2;
        contacts { floor: gap = z + 10; }
    }
}

mechanical_system! {
    /// A ball with quadratic drag.
    pub system Drag {
        constants { c = 1/2, e = 1/2 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = z;
        forces { -c*abs(v)*v along v; }
        contacts { floor: gap = z, restitution = e; }
    }
}

mechanical_system! {
    /// A ball with a parachute that opens on its way down alone.
    pub system Parachute {
        constants { e = 1/2 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = z;
        switches { rises: v; }
        forces { 1/2*(1 - rises) along v; }
        contacts { floor: gap = z, restitution = e; }
    }
}

mechanical_system! {
    /// A block that slides from one floor to another one; its friction also depends on the speed.
    pub system TwoFloors {
        constants { b = 0 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = 1/2*(u^2 + w^2);
        potential_energy = z;
        contacts { floor: gap = z, slip = u, friction = select(x >= 1, 1/4, 1/2) + b*max(0, 1/2 - speed); }
    }
}

mechanical_system! {
    /// A force towards the origin, of one size.
    pub system Towards {
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = 1/2*v^2;
        forces { -2*sign(x) along v; 0.5*t along v; }
        contacts { wall: gap = x + 3; }
    }
}

/// Half of the time that a ball with the speed `v` spends in the spring, and the depth to which it goes.
fn in_the_spring(k: f64, v: f64) -> (f64, f64) {
    let omega = k.sqrt();
    // About the place where the spring carries the ball, 1/k below its end.
    let (a, b) = (1.0 / k, -v / omega);
    let angle = std::f64::consts::PI - b.abs().atan2(a);
    (angle / omega, a.hypot(b) + a)
}

#[test]
fn a_branch_changes_where_its_function_vanishes() {
    let (k, h, height) = (4.0, 0.5, 2.5_f64);
    let v = (2.0 * (height - h)).sqrt();
    let (half, depth) = in_the_spring(k, v);
    let start = buffer::State { z: height, v: 0.0 };
    let motion =
        Buffer::default().prepare().unwrap().simulation(&start).tolerance(1e-12).run(0.0..9.0).unwrap();
    let times: Vec<f64> = motion.transitions().iter().map(|transition| transition.t).collect();
    let expected = [v, v + 2.0 * half, 3.0 * v + 2.0 * half];
    assert_eq!(times.len(), 3, "{:?}", motion.transitions());
    for (found, expected) in times.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-11, "{found} {expected}");
    }
    assert!(motion.transitions().iter().all(|transition| transition.kind == TransitionKind::Switched));
    assert!((motion.at(v + half).z - (h - depth)).abs() < 1e-11 && motion.at(v + half).v.abs() < 1e-10);
    // As an energy, by another method, and with Taylor series of one mode.
    let start = buffer_energy::State { z: height, v: 0.0 };
    let system = BufferEnergy::default().prepare().unwrap();
    let motion = system.simulation(&start).method(Tsit5::new(1e-11, 1e-11)).run(0.0..9.0).unwrap();
    assert_eq!(motion.transitions().len(), 3);
    assert!((motion.transitions()[2].t - expected[2]).abs() < 1e-8);
}

#[test]
fn in_a_mode_by_itself_branches_follow_the_state() {
    let system = Buffer::default().prepare().unwrap();
    let free = system.in_mode(buffer::Mode { floor: buffer::Floor::Open });
    let start = buffer::State { z: 2.5, v: 0.0 };
    let done = Integration::new(&free, 0.0, &start.into()).run(&Dop853::new(1e-12, 1e-12), 9.0).unwrap();
    let through = system.simulation(&start).tolerance(1e-12).run(0.0..9.0).unwrap().end();
    assert_eq!(done.statistics.switches, 3);
    assert!((done.state[0] - through.z).abs() < 1e-10 && (done.state[1] - through.v).abs() < 1e-10);
    assert_eq!(free.rhs(0.0, &[0.25, 0.0])[1], 0.0);
}

#[test]
fn an_impact_changes_the_branches_of_velocities() {
    let (c, height) = (0.5_f64, 3.0_f64);
    let start = drag::State { z: height, v: 0.0 };
    let system = Drag::default().prepare().unwrap();
    let motion = system.simulation(&start).tolerance(1e-12).run(0.0..3.8).unwrap();
    let kinds: Vec<_> = motion.transitions().iter().map(|transition| transition.kind).collect();
    // From the floor it rises with drag downwards, and falls with drag upwards.
    assert_eq!(kinds, [TransitionKind::Impact, TransitionKind::Switched]);
    let speed = ((1.0 - (-2.0 * c * height).exp()) / c).sqrt();
    let (impact, top) = (&motion.transitions()[0], &motion.transitions()[1]);
    assert!((impact.state_before[1] + speed).abs() < 1e-11);
    let back = 0.5 * speed;
    let rises = (1.0 + c * back * back).ln() / (2.0 * c);
    assert!((top.state_after[0] - rises).abs() < 1e-11, "{} {rises}", top.state_after[0]);
    assert!((top.t - impact.t - (c.sqrt() * back).atan() / c.sqrt()).abs() < 1e-11);
}

#[test]
fn an_impact_changes_switches_of_velocities() {
    let start = parachute::State { z: 1.0, v: 0.0 };
    let system = Parachute::default().prepare().unwrap();
    let motion = system.simulation(&start).tolerance(1e-12).run(0.0..3.5).unwrap();
    // Down with half of gravity, up with all of it.
    let transitions = motion.transitions();
    assert!((transitions[0].t - 2.0).abs() < 1e-11 && (transitions[0].state_before[1] + 1.0).abs() < 1e-11);
    assert!((transitions[1].t - 2.5).abs() < 1e-11 && (transitions[1].state_after[0] - 0.125).abs() < 1e-11);
}

#[test]
fn a_coefficient_of_friction_has_branches() {
    let system = TwoFloors::default().prepare().unwrap();
    let start = two_floors::State { u: 1.25_f64.sqrt(), ..Default::default() };
    let motion = system.simulation(&start).tolerance(1e-12).run(0.0..4.0).unwrap();
    // With 1/2 over the distance 1, then with 1/4: it stops at 1 + (1/4)/(1/2).
    assert!((motion.end().x - 1.5).abs() < 1e-11, "{:?}", motion.end());
    let kinds: Vec<_> = motion.transitions().iter().map(|transition| transition.kind).collect();
    assert_eq!(kinds, [TransitionKind::Switched, TransitionKind::Sticks]);
    // More friction below a speed of 1/2: u' = -1/2 - (1/2 - u) = u - 1.
    let system = TwoFloors { b: 1.0 }.prepare().unwrap();
    let start = two_floors::State { x: -9.0, u: 1.0, ..Default::default() };
    let motion = system.simulation(&start).tolerance(1e-12).run(0.0..4.0).unwrap();
    let transitions = motion.transitions();
    assert!((transitions[0].t - 1.0).abs() < 1e-11, "{transitions:?}");
    assert!((transitions[1].t - 1.0 - 2.0_f64.ln()).abs() < 1e-11);
}

#[test]
fn a_sign_stays_zero_until_the_motion_leaves_it() {
    let system = Towards::default().prepare().unwrap();
    // The force grows from zero: it first leaves the origin, and the size of the other one is above it.
    let error = system.simulate(&towards::State::default(), 0.0..1.0).unwrap_err().error;
    assert!(matches!(error.cause, HybridCause::Chattering { .. }), "{error}");
    let start = towards::State { x: 1.0, v: 0.0 };
    let motion = system.simulation(&start).tolerance(1e-12).run(0.0..1.0).unwrap();
    assert!((motion.at(0.5).x - (1.0 - 0.25 + 0.5_f64.powi(3) / 12.0)).abs() < 1e-12);
}
