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

mechanics::mechanical_component! {
    /// A mass on a spring.
    pub component Spring(
        /// Where it hangs.
        anchor: vector,
    ) {
        constants   { m > 0, k > 0 = 1, I > 0 = m*k }
        inputs      { pull }
        coordinates { length, turned }
        particles   { m at anchor - vec(0, 0, length); }
        kinetic_energy = I/2*dot(turned)^2;
        potential_energy = k/2*length^2;
        forces      { pull along dot(length); }
        outputs     { stretch = length; }
    }
}

mechanics::mechanical_system! {
    /// Springs at a beam.
    pub system Beam {
        constants   { M > 0 }
        coordinates { z }
        particles   { M at vec(0, 0, z); }
        use Spring as one { anchor: vec(0, 0, z) }
        for i in 0..2 { use Spring as more[i] { anchor: vec(i, 0, z) } }
        scene Part { track one; fix more[1].k = 3; }
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
