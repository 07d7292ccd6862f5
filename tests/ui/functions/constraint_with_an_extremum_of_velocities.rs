//! A constraint is affine in the velocities.
//!
//! repair: `max(dot(x), 0)` => `2*dot(x)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x, y }
        parameters { v = dot(x); }
        constraints { ratchet: dot(y) = max(dot(x), 0); }
        kinetic_energy = m/2*v^2;
        forces { -c*v along v; }
    }
}

fn main() {}
