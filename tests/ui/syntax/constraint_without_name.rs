//! Every constraint has a name.
//!
//! repair: `{ dot(y)` => `{ straight: dot(y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { dot(y) = 0; }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
