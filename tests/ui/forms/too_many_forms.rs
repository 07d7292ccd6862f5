//! There are no more forms than coordinates.
//!
//! repair: `w = dot(x) + dot(y); ` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); w = dot(x) + dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
