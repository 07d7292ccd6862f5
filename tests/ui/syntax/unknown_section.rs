//! The sections have fixed names.
//!
//! repair: `coordinate {` => `coordinates {`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinate { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
