//! The rate of a state is used below its declaration.
//!
//! repair: `dot(slope) = (dot(current) - slope)/L; dot(current) = u;` => `dot(current) = u; dot(slope) = (dot(current) - slope)/L;`

guen::mechanical_system! {
    pub system Motor {
        constants { J > 0, R > 0, L > 0, k }
        inputs { u }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(slope) = (dot(current) - slope)/L; dot(current) = u; }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
    }
}

fn main() {}
