//! What `max` compares has one dimension.
//!
//! repair: `max(x, g)` => `max(x, l)`

guen::mechanical_system! {
    pub system Stop {
        constants { m: kg > 0, k: N/m >= 0, l: m = 1, g: m/s^2 = 9.81 }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*max(x, g) - m*g along v; }
    }
}

fn main() {}
