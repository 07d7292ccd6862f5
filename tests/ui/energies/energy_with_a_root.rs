//! The kinetic energy is a polynomial in the velocities.
//!
//! repair: `m*sqrt(u^2 + v^2)` => `m*u*v`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = 2*u^2 - (m*sqrt(u^2 + v^2) + v);
    }
}

fn main() {}
