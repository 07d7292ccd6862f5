//! There are as many forms as coordinates.
//!
//! repair: `v = dot(y);` => `v = dot(y); w = dot(z);`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2 + dot(z)^2);
    }
}

fn main() {}
