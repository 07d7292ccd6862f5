//! A gap has no kinks: its rate would jump.
//!
//! repair: `z - abs(x)` => `z - x^2`

guen::mechanical_system! {
    pub system Groove {
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = 1/2*(u^2 + w^2);
        potential_energy = z;
        contacts { bottom: gap = z - abs(x); }
    }
}

fn main() {}
