//! Terms of a sum have one dimension.
//!
//! repair: `k*x + c*x` => `k*x + c*dot(x)`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg > 0, k: N/m, c: N*s/m }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -(k*x + c*x) along v; }
    }
}

fn main() {}
