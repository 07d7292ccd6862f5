//! A vector is written with `vec`.
//!
//! repair: `m at (x` => `m at vec(x`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        particles { m at (x, y); }
    }
}

fn main() {}
