//! A bound compares with zero.
//!
//! repair: `m > 1` => `m > 0`

guen::mechanical_system! {
    pub system Point {
        constants { m > 1 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
