//! The rate on the left is written `dot`.
//!
//! repair: `der(current)` => `dot(current)`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { der(current) = (u - R*current - k*omega)/L; }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
    }
}

fn main() {}
