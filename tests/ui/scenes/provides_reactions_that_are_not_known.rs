//! The energy tells the reactions that a scene provides.
//!
//! repair: `kinetic_energy = m/2*eta1^2` => `kinetic_energy = m/2*(dot(x)^2 + dot(y)^2)`

guen::mechanical_system! {
    pub system Bead {
        constants { m > 0, g = 9.81 }
        coordinates { x, y }
        parameters { eta1 = dot(x); }
        constraints { rail: dot(y) = 0; }
        kinetic_energy = m/2*eta1^2;
        force_function = m*g*x;
        scene Pressed { provide reactions(rail); }
    }
}

fn main() {}
