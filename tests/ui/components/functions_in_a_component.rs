//! The program supplies functions to systems, which hand values to their components.
//!
//! repair: none

guen::mechanical_system! {
    pub system Carrier {
        constants { m > 0 }
        coordinates { x }
        component Track(place: scalar) {
            functions { height(s); }
            potential_energy = height(place);
        }
        parameters { u = dot(x); }
        use Track as track { place: x }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
