//! Powers of powers stay below the 1000th.
//!
//! repair: `(x + 1)^64)^64` => `(x + 1)^64)^8`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = ((x + 1)^64)^64;
    }
}

fn main() {}
