//! A coordinate is used.
//!
//! repair: `coordinates { x, y, z }` => `coordinates { x, y }`
//! repair: `w = dot(x) + dot(y); ` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); w = dot(x) + dot(y); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
