//! A parameter is affine in the velocities.
//!
//! repair: `select(dot(x) >= 0, dot(x), 2*dot(x))` => `2*dot(x)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = select(dot(x) >= 0, dot(x), 2*dot(x)); }
        kinetic_energy = m/2*dot(x)^2;
        forces { -c*dot(x) along dot(x); }
    }
}

fn main() {}
