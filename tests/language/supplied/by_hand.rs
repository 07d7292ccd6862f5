//! Right-hand sides by hand: a motor whose torque is a table, with states and inputs, and a spring in a table under units.

use guen::Table;
use guen::prelude::*;

guen::mechanical_system! {
    /// A motor with a torque curve turns a wheel; its heat is a state.
    pub system Motor {
        constants   { J: kg*m^2 > 0, c: N*m*s >= 0, cooling: Hz > 0 }
        functions   { torque(speed); loss(speed, load); }
        inputs      { throttle: 1 }
        coordinates { phi: rad }
        parameters  { omega = dot(phi); }
        kinetic_energy = J/2*omega^2;
        forces      { throttle*torque(omega) - c*omega along omega; }
        states      { dot(heat: J) = loss(omega, throttle) - cooling*heat; }
    }
}

#[test]
fn a_torque_curve_in_a_table_drives_a_motor() {
    // At 150 the curve lies between (100, 1.8) and (200, 0.5), with slopes that are harmonic means of the chords.
    let points = [(0.0, 2.0), (100.0, 1.8), (200.0, 0.5), (250.0, 0.0)];
    let torque = Table::monotone(points).unwrap();
    let motor = Motor { J: 0.5, c: 0.001, cooling: 0.1, torque, loss: 40.0 }.prepare().unwrap();
    let state = motor::State { phi: 0.0, omega: 150.0, heat: 30.0 };
    let rate = motor.rhs(0.0, &state, &motor::Inputs { throttle: 0.5 });
    let chords = [-0.2 / 100.0, -1.3 / 100.0, -0.5 / 50.0];
    // Equal intervals give the harmonic mean; behind it weights are 2*50 + 100 and 50 + 2*100.
    let slope = 2.0 / (1.0 / chords[0] + 1.0 / chords[1]);
    let next = (200.0 + 250.0) / (200.0 / chords[1] + 250.0 / chords[2]);
    let middle = 0.5 * (1.8 + 0.5) + 100.0 / 8.0 * (slope - next);
    let expected = (0.5 * middle - 0.001 * 150.0) / 0.5;
    assert!((rate.omega - expected).abs() < 1e-12, "{} {expected}", rate.omega);
    assert_eq!((rate.phi, rate.heat), (150.0, 40.0 - 0.1 * 30.0));
}

guen::mechanical_system! {
    /// A cart on a spring whose force is measured, and whose energy is not known.
    pub system Cart {
        constants   { m > 0 }
        functions   { spring(x); mass(s); }
        coordinates { x }
        parameters  { u = dot(x); }
        particles   { m + mass(2) at vec(x, 0); mass(x) at vec(0, x); }
        forces      { -spring(x) along u; }
    }
}

#[test]
fn masses_may_be_functions_of_the_program() {
    // T = (m + mass(2) + mass(x)) u^2/2: M u' + mass'(x) u^2/2 = -spring(x).
    let mass = Table::new([(0.0, 1.0), (1.0, 2.0), (2.0, 1.0)]).unwrap();
    let spring = Table::new([(-1.0, -3.0), (1.0, 3.0)]).unwrap();
    let cart = Cart { m: 2.0, spring, mass }.prepare().unwrap();
    let (x, u) = (0.5, 0.8);
    // 1 + (3/2 x - x^3/2)
    let (at, slope) = (1.0 + 1.5 * x - 0.5 * x * x * x, 1.5 - 1.5 * x * x);
    let expected = (-3.0 * x - 0.5 * slope * u * u) / (2.0 + 1.0 + at);
    let rate = cart.rhs(0.0, &cart::State { x, u }).u;
    assert!((rate - expected).abs() < 1e-14, "{rate} {expected}");
    let [first, second] = guen::Bodies::bodies(&cart, 0.0, &[x, u]);
    assert!(first.mass.is_none() && second.mass.is_none() && second.center.unwrap()[1] == x);
}
