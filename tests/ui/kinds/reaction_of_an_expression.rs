//! A reaction is asked for by the name of its constraint.
//!
//! repair: `reaction(dot(y))` => `reaction(rail)`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, strong > 0 }
        inputs { push in -strong..strong }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        forces { push along u; }
        outputs { grip = reaction(dot(y)); }
    }
}

fn main() {}
