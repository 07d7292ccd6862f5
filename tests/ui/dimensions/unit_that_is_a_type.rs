//! What stands behind a name is a unit.
//!
//! repair: `x: f64` => `x: m`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg > 0, k: N/m }
        coordinates { x: f64 }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*x along v; }
    }
}

fn main() {}
