//! `select` compares by an order.
//!
//! repair: `x == 0` => `x >= 0`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -select(x == 0, 0, c*x) along v; }
    }
}

fn main() {}
