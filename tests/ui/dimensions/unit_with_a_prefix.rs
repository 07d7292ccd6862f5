//! Units have no prefixes.
//!
//! repair: `x: mm` => `x: m`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg > 0, k: N/m }
        coordinates { x: mm }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*x along v; }
    }
}

fn main() {}
