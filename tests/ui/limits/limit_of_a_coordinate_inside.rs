//! Limits of inputs are made of constants.
//!
//! repair: `-strong..x` => `-strong..strong`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, strong > 0 }
        coordinates { x, y }
        inputs { push in -strong..x }
        parameters { u = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        forces { push along u; }
    }
}

fn main() {}
