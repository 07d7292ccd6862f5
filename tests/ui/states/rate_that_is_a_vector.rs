//! The rate of a state is a scalar.
//!
//! repair: `vec(u, 0)` => `u`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current) = vec(u, 0); }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
    }
}

fn main() {}
