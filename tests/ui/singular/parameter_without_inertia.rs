//! Every parameter has an inertia.
//!
//! repair: `m/2*u^2` => `m/2*(u^2 + v^2)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
