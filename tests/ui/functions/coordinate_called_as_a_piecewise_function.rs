//! Names of functions are reserved.
//!
//! repair: `x, floor` => `x, y`
//! repair: `dot(floor)` => `dot(y)`
//! repair: `dot(floor)` => `dot(y)`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x, floor }
        parameters { v = dot(x); w = dot(floor); }
        kinetic_energy = m/2*(v^2 + dot(floor)^2);
        forces { -c*v along v; }
    }
}

fn main() {}
