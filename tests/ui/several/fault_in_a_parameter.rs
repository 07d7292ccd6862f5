//! A fault in a parameter is no fault where it is used, and none of the count.
//!
//! repair: `dot(z)` => `dot(y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(z); }
        kinetic_energy = m/2*(u^2 + v^2);
        forces { -v along v; }
    }
}

fn main() {}
