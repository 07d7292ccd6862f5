//! A component has no name; where it is used nothing more is said.
//!
//! repair: `component (` => `component Wheel(`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0 }
        component (hub: scalar) {
            constants { inertia > 0 }
            coordinates { angle }
            kinetic_energy = inertia/2*dot(angle)^2;
            constraints { rolls: dot(hub) = dot(angle); }
        }
        coordinates { x }
        use Wheel as left { hub: x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -dot(left.angle) along v; }
    }
}

fn main() {}
