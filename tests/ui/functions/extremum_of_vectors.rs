//! `min` and `max` are of scalars.
//!
//! repair: `max(vec(x, 0), 1)` => `max(x, 0)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*max(vec(x, 0), 1) along v; }
    }
}

fn main() {}
