//! A scene has something that moves.
//!
//! repair: `fix u;` => `track x; fix u;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = m/2*u^2;
        scene Rest { fix u; }
    }
}

fn main() {}
