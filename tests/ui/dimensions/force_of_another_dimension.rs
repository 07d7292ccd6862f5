//! A force times its velocity is a power.
//!
//! repair: `-k*dot(x)` => `-c*dot(x)`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg > 0, k: N/m, c: N*s/m }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*dot(x) - c*0 along v; }
    }
}

fn main() {}
