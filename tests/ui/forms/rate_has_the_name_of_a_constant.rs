//! The name of a parameter that the macro chooses is free.
//!
//! repair: `x_rate` => `damping`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0, x_rate >= 0 }
        coordinates { x }
        kinetic_energy = m/2*dot(x)^2;
        forces { -x_rate*dot(x) along dot(x); }
    }
}

fn main() {}
