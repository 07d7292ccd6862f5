//! A position is a vector.
//!
//! repair: `m at x` => `m at vec(x, y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        particles { m at x; }
    }
}

fn main() {}
