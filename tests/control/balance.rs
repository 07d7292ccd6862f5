//! The balance of energy and power along whole runs, on systems with dissipation and with moving constraints.

use guen::Monitored;
use guen::prelude::*;

use crate::jacobians::{
    Appell, Cart, EulerTop, Hoop, ParticlePendulum, Sled, Trailer, Turntable, appell, cart, euler_top, hoop,
    numbers, particle_pendulum, sled, trailer, turntable,
};
use crate::vehicles::{robot, small_robot, small_train, train};

guen::mechanical_system! {
    /// A hoop with air drag on a belt that starts and stops: everything changes the energy at once.
    pub system BeltHoop {
        constants { a > 0, A > 0, C > 0, g = 9.81, drag >= 0, belt, nu }
        inputs { torque }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        let v = belt*sin(nu*t);
        constraints {
            eta4: dot(xi) - v = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
        forces {
            torque along eta3;
            -drag*vec(dot(xi), dot(eta), dot(zeta)) along vec(dot(xi), dot(eta), dot(zeta));
        }
    }
}

/// Integrates rates and power together, and compares the work with the change of energy at every step. `M` is one more
/// than `N`. Returns the largest change.
pub fn balance<const N: usize, const M: usize>(
    name: &str,
    system: &impl Monitored<f64, N>,
    power: impl Fn(f64, &[f64; N]) -> f64,
    start: [f64; N],
    until: f64,
) -> f64 {
    const { assert!(M == N + 1) };
    let head = |x: &[f64; M]| -> [f64; N] { std::array::from_fn(|i| x[i]) };
    let both = from_fn(|t, x: &[f64; M]| {
        let (rates, power) = (system.rhs(t, &head(x)), power(t, &head(x)));
        std::array::from_fn(|i| if i < N { rates[i] } else { power })
    });
    let begin: [f64; M] = std::array::from_fn(|i| if i < N { start[i] } else { 0.0 });
    let energy = system.energy(0.0, &start);
    let mut largest = 0.0_f64;
    Dop853::new(1e-13, 1e-13)
        .integrate(&both, 0.0, &begin, until, |t, x| {
            let change = system.energy(t, &head(x)) - energy;
            assert!(
                (change - x[N]).abs() < 1e-9 * (1.0 + change.abs()),
                "{name} at {t}: {change} and {}",
                x[N]
            );
            largest = largest.max(change.abs());
            ControlFlow::Continue(())
        })
        .unwrap();
    largest
}

/// What nothing drives or brakes keeps its energy, by `power` as by the run.
#[test]
fn conservative_systems() {
    let mut upright = numbers::<9>(1);
    upright[0] += 1.5;
    let system = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let power = |t, s: &[f64; 9]| system.power(t, &hoop::State::from(*s));
    assert!(balance::<9, 10>("hoop", &system, power, upright, 3.0) < 1e-9);
    let system = Appell { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let power = |t, s: &[f64; 9]| system.power(t, &appell::State::from(*s));
    assert!(balance::<9, 10>("appell", &system, power, upright, 1.0) < 1e-9);
    let system = Sled { m: 1.3, alpha: 0.2, beta: 0.1, k: 0.5, incline: 0.3, g: 9.81 }.prepare().unwrap();
    let power = |t, s: &[f64; 5]| system.power(t, &sled::State::from(*s));
    assert!(balance::<5, 6>("sled", &system, power, numbers(2), 5.0) < 1e-9);
    let system = Trailer { m: 1.0, J: 0.3, M: 0.8, K: 0.2, d: 0.6 }.prepare().unwrap();
    let power = |t, s: &[f64; 6]| system.power(t, &trailer::State::from(*s));
    assert!(balance::<6, 7>("trailer", &system, power, numbers(3), 5.0) < 1e-9);
    let system = EulerTop { I1: 1.0, I2: 2.0, I3: 2.5 }.prepare().unwrap();
    let power = |t, s: &[f64; 6]| system.power(t, &euler_top::State::from(*s));
    assert!(balance::<6, 7>("top", &system, power, [0.1, 1.2, 0.3, 0.2, 0.3, 1.1], 3.0) < 1e-9);
    let system = ParticlePendulum { m: 1.3, l: 0.8, g: 9.81 }.prepare().unwrap();
    let power = |t, s: &[f64; 3]| system.power(t, &particle_pendulum::State::from(*s));
    assert!(balance::<3, 4>("pendulum", &system, power, [0.8, 0.0, 1.0], 5.0) < 1e-9);
}

#[test]
fn driven_and_braked_systems() {
    let system = Cart { M: 2.0, m: 0.6, l: 0.5, I: 0.05.into(), c: 0.1, g: 9.81 }.prepare().unwrap();
    let inputs = cart::Inputs { push: 1.7, wind: -0.6 };
    let power = |t, s: &[f64; 4]| system.power(t, &cart::State::from(*s), &inputs);
    assert!(balance::<4, 5>("cart", &system.driven(inputs), power, numbers(4), 3.0) > 0.1);
    let system = small_robot();
    let inputs = robot::Inputs { left_torque: 0.8, right_torque: 0.3 };
    let power = |t, s: &[f64; 9]| system.power(t, &robot::State::from(*s), &inputs);
    assert!(balance::<9, 10>("robot", &system.driven(inputs), power, numbers(5), 2.0) > 0.1);
    let system = small_train();
    let inputs = train::Inputs { push: 0.8, steering: 0.03 };
    let power = |t, s: &[f64; 8]| system.power(t, &train::State::from(*s), &inputs);
    let start = [0.0, 0.0, 0.2, 0.1, 0.0, 0.1, 0.5, 0.0];
    assert!(balance::<8, 9>("train", &system.driven(inputs), power, start, 2.0) > 0.1);
}

#[test]
fn moving_constraints() {
    let system = Turntable::new(0.7, 0.25, 1.5, 0.8, 1.3).prepare().unwrap();
    let power = |t, s: &[f64; 8]| system.power(t, &turntable::State::from(*s));
    let start = [0.4, -0.2, 0.3, 1.2, -0.5, 0.6, -0.9, 0.5];
    assert!(balance::<8, 9>("turntable", &system, power, start, 6.0) > 0.01);
    let system =
        BeltHoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81, drag: 0.2, belt: 0.8, nu: 2.0 }.prepare().unwrap();
    let inputs = belt_hoop::Inputs { torque: 0.6 };
    let power = |t, s: &[f64; 9]| system.power(t, &belt_hoop::State::from(*s), &inputs);
    let mut start = numbers::<9>(1);
    start[0] += 1.5;
    start[8] += 5.0;
    assert!(balance::<9, 10>("belt", &system.driven(inputs), power, start, 3.0) > 0.1);
}
