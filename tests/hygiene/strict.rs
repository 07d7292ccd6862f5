//! Systems in a crate that forgives nothing.
#![no_std]
#![deny(missing_docs, warnings, unsafe_code)]
#![deny(clippy::all, clippy::pedantic)]
#![deny(missing_debug_implementations, missing_copy_implementations, unreachable_pub, unused_qualifications)]
#![deny(unused_results, single_use_lifetimes, trivial_casts, trivial_numeric_casts)]

mechanics::mechanical_system! {
    /// A hoop that rolls on a plane.
    pub system Hoop {
        constants { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        let rolling = dot(psi)*cos(theta) + dot(phi);
        parameters { eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = rolling; }
        constraints {
            eta4: dot(xi) = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
        }
        holonomic { on_ground: zeta = a*sin(theta); }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
    }
}

mechanics::mechanical_system! {
    pub system Motor {
        constants { J > 0, c >= 0 = 0.1 }
        inputs { tau }
        coordinates { phi }
        parameters { omega = dot(phi); }
        kinetic_energy = J/2*omega^2;
        forces { tau - c*omega along omega; }
        outputs { power = tau*omega; tip = vec(cos(phi), sin(phi)); }
    }
}

mechanics::mechanical_system! {
    system Hidden {
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = u^2/2;
    }
}

/// Uses the private system.
#[must_use]
pub fn rate() -> f64 {
    let state = hidden::State { x: 0.0, u: 1.0 };
    Hidden::default().prepare().map_or(0.0, |system| system.rhs(0.0, &state).x)
}
