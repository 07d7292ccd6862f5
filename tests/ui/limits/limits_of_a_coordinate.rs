//! Only inputs have limits.
//!
//! repair: `x in 0..1` => `x`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, strong > 0 }
        inputs { push in -strong..strong }
        coordinates { x in 0..1, y }
        parameters { u = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        forces { push along u; }
    }
}

fn main() {}
