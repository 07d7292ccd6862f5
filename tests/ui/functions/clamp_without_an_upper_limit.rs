//! `clamp` takes a value and two limits.
//!
//! repair: `clamp(v, 1)` => `clamp(v, -1, 1)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*clamp(v, 1) along v; }
    }
}

fn main() {}
