//! A constraint has a velocity in it.
//!
//! repair: `a = 1` => `dot(y) = a`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, a }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { c: a = 1; }
        kinetic_energy = m/2*(u^2 + dot(y)^2);
    }
}

fn main() {}
