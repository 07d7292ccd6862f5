//! `select` takes a comparison and two values.
//!
//! repair: `select(x >= 0, c*x)` => `select(x >= 0, c*x, 0)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -select(x >= 0, c*x) along v; }
    }
}

fn main() {}
