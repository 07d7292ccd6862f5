//! `parameters`, `quasi_velocities` and `speeds` are names of one section.
//!
//! repair: `speeds { v = dot(y); }` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        speeds { v = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
    }
}

fn main() {}
