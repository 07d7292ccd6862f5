//! A kinetic energy is quadratic in the velocities.
//!
//! repair: `max(v, 0)^2` => `v^2`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*max(v, 0)^2;
        forces { -c*v along v; }
    }
}

fn main() {}
