//! Gravity is the same everywhere.
//!
//! repair: `vec(0, -x)` => `vec(0, -9.81)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        particles { m at vec(x, y); }
        gravity = vec(0, -x);
    }
}

fn main() {}
