//! A reaction needs the momentum that goes with its constraint.
//!
//! repair: `m/2*u^2` => `m/2*(dot(x)^2 + dot(y)^2)`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, strong > 0 }
        inputs { push in -strong..strong }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*u^2;
        forces { push along u; }
        outputs { grip = reaction(rail); }
    }
}

fn main() {}
