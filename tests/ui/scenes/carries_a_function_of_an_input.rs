//! An input jumps, and so would a function of it: it is no state.
//!
//! repair: `sin(angle)` => `angle*sin(x)`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0 }
        inputs { angle }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { sin(angle) along v; }
        scene Sway { track x; provide carried; }
    }
}

fn main() {}
