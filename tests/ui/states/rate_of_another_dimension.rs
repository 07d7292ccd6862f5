//! The rate of a state has the dimension of the state per second.
//!
//! repair: `(u - R*current - k*omega);` => `(u - R*current - k*omega)/L;`

guen::mechanical_system! {
    pub system Motor {
        constants { J: kg*m^2 > 0, R: Ohm > 0, L: H > 0, k: N*m/A }
        inputs { u: V }
        coordinates { phi }
        parameters { omega = dot(phi); }
        states { dot(current: A) = (u - R*current - k*omega); }
        kinetic_energy = J/2*omega^2;
        forces { k*current along omega; }
        outputs { flux = L*current; }
    }
}

fn main() {}
