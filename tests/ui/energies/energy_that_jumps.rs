//! An energy has no jumps.
//!
//! repair: `select(x >= l, h, 0)` => `select(x >= l, h*(x - l), 0)`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, h > 0, l > 0, g = 9.81 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        potential_energy = m*g*select(x >= l, h, 0);
    }
}

fn main() {}
