//! A system has coordinates.
//!
//! repair: none

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        kinetic_energy = m/2;
    }
}

fn main() {}
