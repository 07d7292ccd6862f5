//! A name that is not declared is answered with the nearest one.
//!
//! repair: `mas/2` => `mass/2`

guen::mechanical_system! {
    pub system Point {
        constants { mass > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = mas/2*(u^2 + v^2);
    }
}

fn main() {}
