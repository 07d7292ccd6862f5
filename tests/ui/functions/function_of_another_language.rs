//! The language has `select` and not `Piecewise`.
//!
//! repair: `Piecewise(x, 0)` => `max(x, 0)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*Piecewise(x, 0) along v; }
    }
}

fn main() {}
