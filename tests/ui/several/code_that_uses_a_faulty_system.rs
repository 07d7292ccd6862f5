//! Code that uses a faulty system has no errors of its own.
//!
//! repair: `m*9.81*zeta` => `m*9.81*xi`

guen::mechanical_system! {
    /// A hoop.
    pub system Hoop {
        constants { a > 0, m > 0, g = 9.81 }
        coordinates { theta, xi }
        parameters { omega = dot(theta); }
        constraints { rolling: dot(xi) = a*omega; }
        kinetic_energy = m/2*dot(xi)^2 + m*a^2/4*omega^2;
        force_function = m*9.81*zeta - g*theta;
    }
}

use guen::prelude::*;

fn main() {
    let hoop = Hoop { a: 1.0, m: 2.0, g: 9.81 }.prepare().unwrap();
    let other = Hoop::new(1.0, 2.0).prepare().unwrap();
    let state = hoop::State { theta: 0.1, xi: 0.0, omega: 1.0 };
    let rate: hoop::State = hoop.rhs(0.0, &state);
    let energy: f64 = hoop.energy(0.0, &state) + other.energy(0.0, &hoop::State::default());
    let velocities = hoop.velocities(0.0, &state);
    let residual = hoop.residuals(0.0, &state).rolling + hoop.reactions(0.0, &state).rolling;
    let momentum = hoop.momenta(0.0, &state).omega;
    let numbers: [f64; 3] = state.into();
    let slope = hoop::X1.apply(&hoop, &Coordinate::<0>, 0.0, &state.coordinates().into());
    let end = Dop853::new(1e-9, 1e-9).integrate(&hoop, 0.0, &state.into(), 1.0, |_, _| ControlFlow::Continue(()));
    println!("{} {energy} {} {residual} {momentum} {numbers:?} {slope}", rate.omega, velocities.theta);
    println!("{} {} {:?}", hoop::COST, hoop::REPORT, end.map(|end| end.state));
}
