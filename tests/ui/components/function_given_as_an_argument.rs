//! A function that the program supplies to a component stands in the struct of its constants, and is no argument.
//!
//! repair: `, height: bump` => ``

guen::mechanical_system! {
    pub system Carrier {
        constants { m > 0 }
        coordinates { x }
        fn bump(s) = s^2;
        component Track(place: scalar) {
            functions { height(s); }
            potential_energy = height(place);
        }
        parameters { u = dot(x); }
        use Track as track { place: bump(x), height: bump }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
