//! A particle is a mass at a place.
//!
//! repair: `m, vec` => `m at vec`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        particles { m, vec(x, y); }
    }
}

fn main() {}
