//! A parameter is a velocity.
//!
//! repair: `u = x^2; ` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = x^2; v = dot(y); w = dot(x); }
        kinetic_energy = m/2*(w^2 + v^2);
    }
}

fn main() {}
