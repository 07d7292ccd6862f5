//! Controllers of systems with states beside the motion: equilibria, controllability, leaves and inverse dynamics.

use guen::control::{Component, InverseDynamicsError, controllability, poles};

guen::mechanical_system! {
    /// A pendulum that a motor holds, and a cart that follows on a wire.
    pub system Held {
        constants { m > 0, l > 0, R > 0, L > 0, k > 0, g = 9.81 }
        inputs { voltage, push }
        coordinates { phi, x, y }
        holonomic { wire: y = x/2; }
        parameters { omega = dot(phi); v = dot(x); }
        states { dot(current) = (voltage - R*current - k*omega)/L; }
        kinetic_energy = m/2*l^2*omega^2 + m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = -m*g*l*cos(phi) + x^2/2;
        forces { k*current along omega; push - current along v; }
    }
}

const R: f64 = 2.0;
const L: f64 = 0.5;
const K: f64 = 3.0;

fn held() -> held::Prepared {
    Held { m: 1.0, l: 0.5, R, L, k: K, g: 9.81 }.prepare().unwrap()
}

/// The voltage that holds an angle is the resistance times the current whose torque is the weight's.
#[test]
fn an_equilibrium_finds_currents_and_voltages() {
    let guess = held::State { phi: 0.4, ..Default::default() };
    let (state, inputs) = held().equilibrium(0.0, &guess, &Default::default(), &["phi", "push"]).unwrap();
    let current = 9.81 * 0.5 * 0.4_f64.sin() / K;
    assert!((state.current - current).abs() < 1e-12 && (inputs.voltage - R * current).abs() < 1e-12);
    // The cart is pulled against its spring.
    assert!((state.x + current).abs() < 1e-12 && (state.y - state.x / 2.0).abs() < 1e-12, "{state:?}");
}

#[test]
fn a_reduced_model_has_the_states_last() {
    let state = held::State::default();
    let reduced = held().reduce(0.0, &state, &Default::default(), &["phi", "x"]).unwrap();
    assert_eq!(reduced.names, ["phi", "x", "omega", "v", "current"]);
    assert_eq!(reduced.components[4], Component::Parameter(2));
    assert_eq!(reduced.linear.a[4], [0.0, 0.0, -K / L, 0.0, -R / L]);
    assert_eq!(reduced.linear.b[4], [1.0 / L, 0.0]);
    assert_eq!(reduced.linear.a[2], [-9.81 / 0.5, 0.0, 0.0, 0.0, K / 0.25]);
    // The voltage alone moves everything, by way of the current.
    let by_voltage =
        guen::Linearization { a: reduced.linear.a, b: reduced.linear.b.map(|[voltage, _]| [voltage]) };
    assert_eq!(controllability(&by_voltage, 1e-9).rank, 5);
    assert!(poles(&reduced.linear.a).unwrap().len() == 5);
}

/// A voltage changes no acceleration at once: the current does, which the state tells.
#[test]
fn inverse_dynamics_are_at_the_given_states() {
    let state = held::State { phi: 0.3, omega: 0.2, current: 1.5, ..Default::default() };
    let reachable = K * 1.5 - 9.81 * 0.5 * 0.3_f64.sin();
    let wanted = held::State { omega: reachable / 0.25, v: 0.0, current: 77.0, ..Default::default() };
    let found = held().inverse_dynamics(0.0, &state, &wanted).unwrap();
    assert!((found.push - 1.5).abs() < 1e-12 && found.voltage == 0.0);
    let other = held::State { omega: 0.0, ..wanted };
    let refused = held().inverse_dynamics(0.0, &state, &other);
    assert!(matches!(refused, Err(InverseDynamicsError::OutOfReach { rank: 1, .. })), "{refused:?}");
}

/// Mass matrix, weight and forces know the state as a number.
#[test]
fn the_equations_apart_take_the_states_as_they_are() {
    let state = held::State { phi: 0.3, current: 1.5, ..Default::default() };
    let form = held().mass_form(0.0, &state, &Default::default());
    assert!((form.bias[0] - (9.81 * 0.5 * 0.3_f64.sin() - K * 1.5)).abs() < 1e-13);
    assert!((form.bias[1] - 1.5).abs() < 1e-13 && form.input == [[0.0, 0.0], [0.0, 1.0]]);
    let apart = held().coriolis_and_gravity(0.0, &state);
    assert!((apart[0] - 9.81 * 0.5 * 0.3_f64.sin()).abs() < 1e-13 && apart[1].abs() < 1e-13);
    let rates = held().rhs(0.0, &state, &Default::default());
    assert!((form.mass[0][0] * rates.omega + form.bias[0]).abs() < 1e-13);
}
