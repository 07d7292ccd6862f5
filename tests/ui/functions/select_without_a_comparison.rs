//! The first argument of `select` is a comparison.
//!
//! repair: `select(x, ` => `select(x >= 0, `

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -select(x, c*x, 0) along v; }
    }
}

fn main() {}
