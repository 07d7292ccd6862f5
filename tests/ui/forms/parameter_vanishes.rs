//! A parameter is not identically zero.
//!
//! repair: `dot(x) - dot(x)` => `dot(x)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x) - dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
