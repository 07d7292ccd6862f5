//! A state has a name of its own.
//!
//! repair: `dot(phi) = (u - R*phi` => `dot(current) = (u - R*current`
//! repair: `k*phi along` => `k*current along`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(phi) = (u - R*phi - k*omega)/L; }
        kinetic_energy = J/2*omega^2;
        forces { k*phi along omega; }
    }
}

fn main() {}
