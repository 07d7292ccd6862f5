//! A force acts along a velocity, and a state is none.
//!
//! repair: `along current` => `along omega`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current) = (u - R*current - k*omega)/L; }
        kinetic_energy = J/2*omega^2;
        forces { k*current along current; }
    }
}

fn main() {}
