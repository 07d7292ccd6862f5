//! Physical constants belong to `constants`.
//!
//! repair: `parameters { k = 3, u` => `parameters { u`
//! repair: `m > 0` => `m > 0, k = 3`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { k = 3, u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = k*x;
    }
}

fn main() {}
