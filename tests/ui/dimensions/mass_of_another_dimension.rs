//! What moves has an energy.
//!
//! repair: `m: N` => `m: kg`

guen::mechanical_system! {
    pub system Spring {
        constants { m: N > 0, k: N/m }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*x along v; }
    }
}

fn main() {}
