//! One hoop declared in three ways: what is derived does not depend on how the declaration is written.

/// The kinetic energy in velocities, the terms in the order of the paper.
mod velocities {
    guen::mechanical_system! {
        pub system Hoop {
            constants { a > 0, A > 0, C > 0, g = 9.81 }
            coordinates { theta, psi, phi, xi, eta, zeta }
            parameters {
                eta1 = dot(theta);
                eta2 = dot(psi)*sin(theta);
                eta3 = dot(psi)*cos(theta) + dot(phi);
            }
            constraints {
                eta4: dot(xi) - a*sin(theta)*sin(psi)*dot(theta) + a*cos(theta)*cos(psi)*dot(psi) + a*cos(psi)*dot(phi) = 0;
                eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
                eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
            }
            kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)
                           + 1/2*(A*dot(theta)^2 + A*(dot(psi)*sin(theta))^2 + C*(dot(psi)*cos(theta) + dot(phi))^2);
            force_function = -a*g*sin(theta);
        }
    }
}

/// The kinetic energy by (3.5), in the parameters and the constraints' names.
mod quasi_velocities {
    guen::mechanical_system! {
        pub system Hoop {
            constants { a > 0, A > 0, C > 0, g = 9.81 }
            coordinates { theta, psi, phi, xi, eta, zeta }
            parameters {
                eta1 = dot(theta);
                eta2 = dot(psi)*sin(theta);
                eta3 = dot(psi)*cos(theta) + dot(phi);
            }
            constraints {
                eta4: dot(xi) - a*sin(theta)*sin(psi)*dot(theta) + a*cos(theta)*cos(psi)*dot(psi) + a*cos(psi)*dot(phi) = 0;
                eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
                eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
            }
            kinetic_energy = 1/2*((A + a^2)*eta1^2 + A*eta2^2 + (C + a^2)*eta3^2)
                + 1/2*(eta4^2 + eta5^2 + eta6^2 + 2*a*sin(theta)*sin(psi)*eta1*eta4
                     - 2*a*sin(theta)*cos(psi)*eta1*eta5 + 2*a*cos(theta)*eta1*eta6
                     - 2*a*cos(psi)*eta3*eta4 - 2*a*sin(psi)*eta3*eta5);
            force_function = -a*g*sin(theta);
        }
    }
}

/// Every product expanded, terms and factors in another order, squares of sines by those of cosines, sides
/// exchanged, doubled and halved angles.
mod expanded {
    guen::mechanical_system! {
        pub system Hoop {
            constants { a > 0, A > 0, C > 0, g = 9.81 }
            coordinates { theta, psi, phi, xi, eta, zeta }
            let tilt = dot(theta);
            parameters {
                eta1 = tilt*(sin(psi)^2 + cos(psi)^2);
                eta2 = 2*sin(theta/2)*cos(theta/2)*dot(psi);
                eta3 = dot(phi) + (1 - 2*sin(theta/2)^2)*dot(psi);
            }
            constraints {
                eta4: cos(psi)*dot(phi)*a + dot(psi)*cos(psi)*cos(theta)*a + dot(xi) = sin(psi)*tilt*sin(theta)*a;
                eta5: dot(phi)*sin(psi)*a + cos(psi)*sin(theta)*dot(theta)*a + dot(psi)*a*sin(psi)*cos(theta) = -dot(eta);
                eta6: -dot(a*sin(theta)) + dot(zeta) = 0;
            }
            kinetic_energy = dot(phi)^2*C/2 + C*cos(theta)*dot(phi)*dot(psi) + dot(zeta)^2/2
                + A*dot(psi)^2/2 - dot(psi)^2*cos(theta)^2*A/2 + tilt*tilt*A/2
                + (1 - sin(theta)^2)*C*dot(psi)^2/2 + 1/2*dot(eta)*dot(eta) + dot(xi)^2/2;
            potential_energy = sin(theta)*g*a;
        }
    }
}

use guen::prelude::*;

#[test]
fn what_is_printed_is_the_same() {
    let report = velocities::hoop::REPORT;
    for other in [quasi_velocities::hoop::REPORT, expanded::hoop::REPORT] {
        assert_eq!(report.sections.len(), other.sections.len());
        for (section, other) in report.sections.iter().zip(other.sections) {
            assert_eq!(section.title, other.title);
            assert_eq!(section.lines, other.lines, "{}", section.title);
        }
    }
}

#[test]
fn operations_are_the_same() {
    assert_eq!(velocities::hoop::COST, quasi_velocities::hoop::COST);
    assert_eq!(velocities::hoop::COST, expanded::hoop::COST);
    assert_eq!(velocities::hoop::PREPARE_COST, quasi_velocities::hoop::PREPARE_COST);
    assert_eq!(velocities::hoop::PREPARE_COST, expanded::hoop::PREPARE_COST);
}

/// Rates agree to the bit, everything else to a few roundings, at many states.
#[test]
fn numbers_are_the_same() {
    macro_rules! values {
        ($way:ident, $state:expr) => {{
            let system = $way::Hoop::new(0.9, 0.45, 1.1).prepare().unwrap();
            let state = $way::hoop::State::from($state);
            let mut others = vec![system.energy(0.0, &state)];
            others.extend(<[f64; 6]>::from(system.momenta(0.0, &state)));
            others.extend(<[f64; 3]>::from(system.reactions(0.0, &state)));
            (System::rhs(&system, 0.0, &$state).map(f64::to_bits), others)
        }};
    }
    for k in 1..100 {
        let s = f64::from(k) * 0.03;
        let state = [s, s.sin(), -s, 0.3, 0.2 * s, 0.1, s.cos(), 1.0 - s, 2.0 + s];
        let (rates, expected) = values!(velocities, state);
        for (found, others) in [values!(quasi_velocities, state), values!(expanded, state)] {
            assert_eq!(found, rates, "{state:?}");
            let largest = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for (x, y) in others.iter().zip(&expected) {
                assert!((x - y).abs() <= 32.0 * f64::EPSILON * largest, "{x} and {y} at {state:?}");
            }
        }
    }
}
