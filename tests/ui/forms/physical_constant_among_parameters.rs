//! A physical constant is no parameter.
//!
//! repair: `parameters { k = 2*pi; u` => `parameters { u`
//! repair: `m > 0` => `m > 0, k = 2*pi`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { k = 2*pi; u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2) + k*u;
    }
}

fn main() {}
