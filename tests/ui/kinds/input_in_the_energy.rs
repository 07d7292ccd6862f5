//! Inputs enter forces and outputs only.
//!
//! repair: `tau*x;` => `x;\n        forces { tau along dot(x); }`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        inputs { tau }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = tau*x;
    }
}

fn main() {}
