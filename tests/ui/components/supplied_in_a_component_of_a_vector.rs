//! A function that the program supplies takes scalars, in components too.
//!
//! repair: `height(place)` => `height(place.x)`

guen::mechanical_system! {
    pub system Carrier {
        constants { m > 0 }
        coordinates { x }
        component Inner(place: vector) {
            functions { height(s); }
            potential_energy = height(place);
        }
        component Track(place: vector) { use Inner as hub { place } }
        parameters { u = dot(x); }
        use Track as track { place: vec(x, 0) }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
