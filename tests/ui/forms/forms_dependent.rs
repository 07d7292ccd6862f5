//! The forms are independent.
//!
//! repair: `v = 2*dot(x)` => `v = 2*dot(y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = 2*dot(x); }
        kinetic_energy = m/2*(u^2 + v^2 + dot(y)^2);
    }
}

fn main() {}
