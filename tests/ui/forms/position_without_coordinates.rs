//! A holonomic constraint depends on coordinates.
//!
//! repair: `reach: l = 1;` => `reach: l*x = y;`

guen::mechanical_system! {
    pub system Rod {
        constants { l > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        kinetic_energy = (dot(x)^2 + dot(y)^2)*l;
        holonomic { reach: l = 1; }
    }
}

fn main() {}
