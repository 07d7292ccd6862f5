//! There are as many forms as coordinates, wherever the velocities occur.
//!
//! repair: `v = dot(y) + dot(z);` => `v = dot(y) + dot(z); w = dot(y);`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y) + dot(z); }
        kinetic_energy = m/2*(u^2 + v^2 + dot(z)^2);
    }
}

fn main() {}
