//! A system has a kinetic energy.
//!
//! repair: `v = dot(y); }` => `v = dot(y); }\n        kinetic_energy = u^2 + v^2;`

guen::mechanical_system! {
    pub system Point {
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
    }
}

fn main() {}
