//! The axis of a rotation has unit length.
//!
//! repair: `vec(1, 1, 0)` => `unit(vec(1, 1, 0))`

guen::mechanical_system! {
    pub system Rotor {
        constants { J > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        let R = rot(vec(1, 1, 0), x);
        kinetic_energy = J/2*inner(angular_velocity(R), angular_velocity(R));
    }
}

fn main() {}
