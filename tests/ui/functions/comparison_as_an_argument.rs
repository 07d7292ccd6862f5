//! A comparison is the first argument of `select`.
//!
//! repair: `max(x > 0, x)` => `max(0, x)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*max(x > 0, x) along v; }
    }
}

fn main() {}
