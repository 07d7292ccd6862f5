//! What is never used is reported by the compiler's own lint, at its place.
#![deny(unused_variables)]

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, k, _spare }
        inputs { tau }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let r#type = x + y;
    }
}

guen::mechanical_system! {
    /// Names of values of the module, and of the prelude.
    pub system Mass {
        constants { X0, COST, None, m > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = m/2*u^2;
    }
}

/// On purpose; what a scene fixes need not be used.
mod silent {
    #![allow(unused_variables)]

    guen::mechanical_system! {
        pub system Point {
            constants { m > 0, k }
            coordinates { x }
            parameters { u = dot(x); }
            kinetic_energy = m/2*u^2;
            scene Fixed { track x; fix k = 1; }
        }
    }
}

fn main() {
    let _ = (Point { m: 1.0, k: 0.0, _spare: 0.0 }.prepare(), silent::Point { m: 1.0, k: 0.0 }.prepare());
}
