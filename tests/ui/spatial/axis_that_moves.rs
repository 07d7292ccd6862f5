//! The axis of a rotation depends on constants only.
//!
//! repair: `rot(vec(cos(x), sin(x), 0), x)` => `rot_z(x)*rot_x(x)`

guen::mechanical_system! {
    pub system Rotor {
        constants { J > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        let R = rot(vec(cos(x), sin(x), 0), x);
        kinetic_energy = J/2*inner(angular_velocity(R), angular_velocity(R));
    }
}

fn main() {}
