//! A holonomic constraint has positions only.
//!
//! repair: `holonomic` => `constraints`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        holonomic { c: dot(y) = x; }
        kinetic_energy = m/2*(u^2 + dot(y)^2);
    }
}

fn main() {}
