//! A position does not depend on a state.
//!
//! repair: `vec(phi, current)` => `vec(phi, 0)`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current) = (u - R*current - k*omega)/L; }
        particles { J at vec(phi, current); }
        forces { k*current along omega; }
    }
}

fn main() {}
