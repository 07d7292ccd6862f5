//! No constraint follows from the others.
//!
//! repair: `\n            again: 2*dot(y) = 2*x*dot(x);` => ``
//! repair: `u = dot(x);` => `u = dot(x); v = dot(z);`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); }
        constraints {
            slope: dot(y) - x*dot(x) = 0;
            again: 2*dot(y) = 2*x*dot(x);
        }
        kinetic_energy = m/2*(u^2 + dot(y)^2 + dot(z)^2);
    }
}

fn main() {}
