//! A holonomic constraint holds somewhere.
//!
//! repair: `= -a^2` => `= a^2`

guen::mechanical_system! {
    pub system Bead {
        constants { m, a > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        holonomic { circle: x^2 + y^2 = -a^2; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
    }
}

fn main() {}
