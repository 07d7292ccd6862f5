//! A keyword of Rust is a raw name.
//!
//! repair: `type` => `r#type`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { type }
        parameters { u = dot(r#type); }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
