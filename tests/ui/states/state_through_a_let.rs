//! An energy does not depend on a state through a `let`.
//!
//! repair: ` + flux^2/2` => ``

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current) = (u - R*current - k*omega)/L; }
        let flux = L*current;
        kinetic_energy = J/2*omega^2 + flux^2/2;
        forces { k*flux/L along omega; }
    }
}

fn main() {}
