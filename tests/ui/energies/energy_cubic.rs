//! The kinetic energy is quadratic in the velocities.
//!
//! repair: `v^3` => `v^2`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^3);
    }
}

fn main() {}
