//! A comparison stands in `select` only.
//!
//! repair: `(x >= 0)*x` => `max(x, 0)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*(x >= 0)*x along v; }
    }
}

fn main() {}
