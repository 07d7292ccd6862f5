//! The rate of a rotation is its angular velocity.
//!
//! repair: `dot(R)` => `angular_velocity(R)`

guen::mechanical_system! {
    pub system Rotor {
        constants { J > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        let R = rot_z(x);
        let omega = dot(R);
        kinetic_energy = J/2*inner(omega, omega);
    }
}

fn main() {}
