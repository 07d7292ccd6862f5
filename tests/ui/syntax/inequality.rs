//! Constraints are equations.
//!
//! repair: `straight: dot(y) > 0;` => `straight: dot(y) = 0;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { straight: dot(y) > 0; }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
