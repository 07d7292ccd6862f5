//! Numbers are exact and have no types.
//!
//! repair: `1.5f64` => `1.5`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = 1.5f64*x;
    }
}

fn main() {}
