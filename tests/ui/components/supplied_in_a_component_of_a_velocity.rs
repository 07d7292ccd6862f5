//! A potential energy in a component depends on no velocity, whatever its functions are given.
//!
//! repair: `place: dot(x)` => `place: x`

guen::mechanical_system! {
    pub system Carrier {
        constants { m > 0 }
        coordinates { x }
        component Track(place: scalar) {
            functions { height(s); }
            potential_energy = height(place);
        }
        parameters { u = dot(x); }
        for i in 0..2 { use Track as track[i] { place: dot(x) } }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
