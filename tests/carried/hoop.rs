//! The hoop of the paper with its sines and cosines as states, against the reference in 25 digits.

use guen::prelude::*;
use guen::{Carrying, mechanical_system, rejoined};

mechanical_system! {
    /// A hoop of radius `a` that rolls without slipping on a horizontal plane.
    pub system Hoop {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
        provide carried;
        scene Tilt { track theta; provide carried; }
    }
}

#[test]
fn costs() {
    println!("{:?}\n{:?}", hoop::COST, hoop::carried::COST);
    println!("{:?}\n{:?}", hoop::tilt::COST, hoop::tilt::carried::COST);
    println!("{:#?}", hoop::carried::FUNCTIONS);
    assert_eq!(hoop::carried::COST.calls, 0);
}
