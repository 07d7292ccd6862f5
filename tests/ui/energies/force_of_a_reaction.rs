//! A force does not depend on reactions.
//!
//! repair: `reaction(rail)` => `u`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, strong > 0 }
        inputs { push in -strong..strong }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        forces { push - reaction(rail) along u; }
    }
}

fn main() {}
