//! A constraint does not depend on a state.
//!
//! repair: `dot(phi) + current` => `dot(phi)`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi, x }
        parameters { omega = dot(phi); }
        constraints { rolls: dot(x) = dot(phi) + current; }
        states { dot(current) = (u - R*current - k*omega)/L; }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
    }
}

fn main() {}
