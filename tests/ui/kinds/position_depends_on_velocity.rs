//! A position depends on time and coordinates.
//!
//! repair: `vec(u, y)` => `vec(x, y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        particles { m at vec(u, y); }
    }
}

fn main() {}
