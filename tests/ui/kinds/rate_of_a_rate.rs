//! `dot` takes functions of time and coordinates.
//!
//! repair: `dot(u)` => `u`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        forces { m*dot(u) along dot(x); }
    }
}

fn main() {}
