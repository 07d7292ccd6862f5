//! A force does not depend on an acceleration through the rate of a state.
//!
//! repair: `k*dot(seen) along` => `k*seen along`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current) = (u - R*current - k*omega)/L; dot(seen) = dot(omega) - seen; }
        kinetic_energy = J/2*omega^2;
        forces { k*dot(seen) along omega; }
    }
}

fn main() {}
