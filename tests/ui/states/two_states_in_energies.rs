//! Every name that an energy cannot depend on is an error of its own.
//!
//! repair: ` + L*current` => ``
//! repair: ` - heat*omega` => ``
//! errors: 3

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current) = (u - R*current - k*omega)/L; dot(heat) = R*current^2; }
        kinetic_energy = J/2*omega^2 + L*current;
        potential_energy = phi^2 - heat*omega;
        forces { k*current along omega; }
    }
}

fn main() {}
