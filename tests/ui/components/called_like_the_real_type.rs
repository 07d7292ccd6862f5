//! The real type of generated code has the name that components and instances leave free.
//!
//! errors: 2
//! repair: `component R` => `component Spring`
//! repair: `use R as` => `use Spring as`
//! repair: `as R {` => `as right {`

guen::mechanical_system! {
    pub system Cart {
        component R(length: scalar) {
            constants        { k >= 0 }
            potential_energy = k/2*length^2;
        }
        constants      { m > 0 }
        coordinates    { x }
        kinetic_energy = m/2*dot(x)^2;
        use R as left { length: x }
    }
}

guen::mechanical_system! {
    pub system Slide {
        component Damper(rate: scalar) {
            constants { c >= 0 }
            forces    { -c*rate along rate; }
        }
        constants      { m > 0 }
        coordinates    { x }
        kinetic_energy = m/2*dot(x)^2;
        use Damper as R { rate: dot(x) }
    }
}

fn main() {}
