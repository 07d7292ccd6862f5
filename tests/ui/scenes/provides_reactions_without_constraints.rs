//! A system without constraints has no reactions.
//!
//! repair: ` provide reactions;` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = m/2*u^2;
        scene Pressed { track x; provide reactions; }
    }
}

fn main() {}
