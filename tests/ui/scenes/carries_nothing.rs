//! What is carried is there.
//!
//! repair: `provide carried;` => ``

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        provide carried;
    }
}

fn main() {}
