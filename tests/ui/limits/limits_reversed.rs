//! The lower limit of an input is not above the upper one.
//!
//! repair: `2..1` => `1..2`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0 }
        inputs { push in 2..1 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        forces { push along u; }
    }
}

fn main() {}
