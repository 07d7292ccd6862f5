//! The carried form has a name of its own.
//!
//! repair: `scene Carried` => `scene Sway`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        potential_energy = cos(x);
        provide carried;
        scene Carried { track x; }
    }
}

fn main() {}
