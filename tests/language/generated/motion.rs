//! What a prepared system computes at a state, against formulas written by hand and against differences.

use guen::prelude::*;

cart!(guen::mechanical_system);
hoop!(guen::mechanical_system);
particle_pendulum!(guen::mechanical_system);

const STATE: cart::State = cart::State { x: 0.3, phi: 0.7, v: -0.4, omega: 1.3 };
const INPUTS: cart::Inputs = cart::Inputs { push: 1.7, wind: -0.6 };

fn heavy_cart() -> cart::Prepared {
    Cart::new(2.0, 0.6).prepare().unwrap()
}

/// Lagrange's equations of the cart, solved by hand.
#[allow(non_snake_case, reason = "the constants have their names from the declaration")]
fn expected_rates(t: f64, s: &cart::State, u: &cart::Inputs) -> [f64; 4] {
    let Cart { M, m, l, c, g, .. } = heavy_cart().constants();
    let I = m * l * l / 3.0;
    let (sin, cos) = s.phi.sin_cos();
    let (a, b, d) = (M + m, m * l * cos, m * l * l + I);
    let wind = u.wind * (-t).exp();
    let along_x = u.push + wind + m * l * sin * s.omega * s.omega;
    let along_phi = -c * s.omega + wind * l * cos - m * g * l * sin;
    let determinant = a * d - b * b;
    [s.v, s.omega, (d * along_x - b * along_phi) / determinant, (a * along_phi - b * along_x) / determinant]
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-13 * (1.0 + expected.abs()), "{found} and {expected}");
}

#[test]
fn rates_with_inputs() {
    let cart = heavy_cart();
    for t in [0.0, 0.8] {
        let rates: [f64; 4] = cart.rhs(t, &STATE, &INPUTS).into();
        for (found, expected) in rates.iter().zip(expected_rates(t, &STATE, &INPUTS)) {
            assert_near(*found, expected);
        }
        assert_eq!(cart.driven(INPUTS).rhs(t, &STATE.into()), rates);
    }
    // An input that did nothing would pass unseen above.
    let idle = cart::Inputs { push: 0.0, ..INPUTS };
    assert_ne!(cart.rhs(0.0, &STATE, &idle).v, cart.rhs(0.0, &STATE, &INPUTS).v);
}

#[test]
fn energies_and_momenta() {
    let cart = heavy_cart();
    let Cart { M, m, l, g, .. } = cart.constants();
    let inertia = m * l * l / 3.0;
    let cos = STATE.phi.cos();
    let kinetic = 0.5 * (M + m) * STATE.v * STATE.v
        + m * l * cos * STATE.v * STATE.omega
        + 0.5 * (m * l * l + inertia) * STATE.omega * STATE.omega;
    assert_near(cart.kinetic_energy(0.0, &STATE), kinetic);
    assert_near(cart.force_function(0.0, &STATE), m * g * l * cos);
    assert_near(cart.energy(0.0, &STATE), kinetic - m * g * l * cos);
    assert_near(Monitored::energy(&cart.driven(INPUTS), 0.0, &STATE.into()), kinetic - m * g * l * cos);
    let momenta = cart.momenta(0.0, &STATE);
    assert_near(momenta.v, (M + m) * STATE.v + m * l * cos * STATE.omega);
    assert_near(momenta.omega, m * l * cos * STATE.v + (m * l * l + inertia) * STATE.omega);
}

/// (2.8): the momenta of the constraints too, by their formulas for the hoop.
#[test]
fn momenta_of_constraints() {
    let (a, across, along) = (0.8, 0.5, 1.1);
    let hoop = Hoop::new(a, across, along).prepare().unwrap();
    let s = hoop::State { theta: 1.2, psi: 0.3, eta1: 0.1, eta2: 0.4, eta3: 5.0, ..Default::default() };
    let momenta = hoop.momenta(0.0, &s);
    assert_near(momenta.eta1, (across + a * a) * s.eta1);
    assert_near(momenta.eta2, across * s.eta2);
    assert_near(momenta.eta3, (along + a * a) * s.eta3);
    let v = hoop.velocities(0.0, &s);
    assert_near(momenta.eta4, v.xi);
    assert_near(momenta.eta5, v.eta);
    assert_near(momenta.eta6, v.zeta);
    assert_eq!(hoop.domain(0.0, &s), [1.2_f64.sin()]);
}

/// The pull of a rod: `m (l omega^2 + g cos phi)` towards the pivot, so `lambda = -pull / 2 l` on `2 (x, y)`.
#[test]
fn reactions() {
    let (m, l, g, phi, omega) = (0.7, 2.0, 9.81, 0.6_f64, 1.4);
    let pendulum = ParticlePendulum::new(m, l).prepare().unwrap();
    let state = particle_pendulum::State { x: l * phi.sin(), y: -l * phi.cos(), omega };
    let pull = m * (l * omega * omega + g * phi.cos());
    assert_near(pendulum.reactions(0.0, &state).rod, -pull / (2.0 * l));
    assert_near(pendulum.rhs(0.0, &state).omega, -g / l * phi.sin());
}

#[test]
fn outputs_are_scalars_and_vectors() {
    let cart = heavy_cart();
    let outputs = cart.outputs(0.0, &STATE, &INPUTS);
    let (sin, cos) = STATE.phi.sin_cos();
    assert_near(outputs.height, -0.5 * cos);
    assert_near(outputs.hinge, INPUTS.push - 2.6 * 9.81);
    let [x, y, z] = outputs.pointer;
    assert_near(x, STATE.x + 0.5 * sin);
    assert_near(y, -0.5 * cos);
    assert_eq!(z, 0.0);
}

/// Central differences, whose own error is about `h^2 + eps/h`.
#[test]
fn linearization_is_the_derivative() {
    let cart = heavy_cart();
    let found = cart.linearize(0.3, &STATE, &INPUTS);
    const H: f64 = 1e-5;
    let (state, inputs): ([f64; 4], [f64; 2]) = (STATE.into(), INPUTS.into());
    for j in 0..4 {
        let at = |h: f64| {
            let mut moved = state;
            moved[j] += h;
            <[f64; 4]>::from(cart.rhs(0.3, &moved.into(), &INPUTS))
        };
        let (ahead, behind) = (at(H), at(-H));
        for i in 0..4 {
            let slope = (ahead[i] - behind[i]) / (2.0 * H);
            assert!((found.a[i][j] - slope).abs() < 1e-8, "a[{i}][{j}] = {} and {slope}", found.a[i][j]);
        }
    }
    for j in 0..2 {
        let at = |h: f64| {
            let mut moved = inputs;
            moved[j] += h;
            <[f64; 4]>::from(cart.rhs(0.3, &STATE, &moved.into()))
        };
        let (ahead, behind) = (at(H), at(-H));
        for i in 0..4 {
            let slope = (ahead[i] - behind[i]) / (2.0 * H);
            assert!((found.b[i][j] - slope).abs() < 1e-8, "b[{i}][{j}] = {} and {slope}", found.b[i][j]);
        }
    }
    assert!(found.a[3][1].abs() > 0.1 && found.b[2][0].abs() > 0.1);
}

#[test]
fn linearization_without_inputs() {
    let hoop = Hoop::new(0.8, 0.5, 1.1).prepare().unwrap();
    let state = [1.2, 0.3, 0.1, 2.0, -1.0, 0.9, 0.1, 0.4, 5.0];
    let found = hoop.linearize(0.0, &state.into());
    const H: f64 = 1e-5;
    for j in 0..9 {
        let at = |h: f64| {
            let mut moved = state;
            moved[j] += h;
            System::rhs(&hoop, 0.0, &moved)
        };
        let (ahead, behind) = (at(H), at(-H));
        for i in 0..9 {
            let slope = (ahead[i] - behind[i]) / (2.0 * H);
            assert!((found.a[i][j] - slope).abs() < 1e-7, "a[{i}][{j}] = {} and {slope}", found.a[i][j]);
        }
    }
}
