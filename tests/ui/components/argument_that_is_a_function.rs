//! An argument is a value: a function of a component is declared under `functions`.
//!
//! repair: `component Track(place: scalar, height: function) {` => `component Track(place: scalar) {\n            functions { height(s); }`
//! repair: `, height: terrain` => ``

guen::mechanical_system! {
    pub system Carrier {
        constants { m > 0 }
        functions { terrain(s); }
        coordinates { x }
        component Track(place: scalar, height: function) {
            potential_energy = height(place);
        }
        parameters { u = dot(x); }
        use Track as track { place: terrain(x), height: terrain }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
