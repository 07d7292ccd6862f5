//! Every state has an entry of its own.
//!
//! repair: `dot(current, heat)` => `dot(current)`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current, heat) = (u - R*current - k*omega)/L; }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
    }
}

fn main() {}
