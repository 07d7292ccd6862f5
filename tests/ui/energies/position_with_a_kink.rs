//! A position has no kinks: velocities would jump.
//!
//! repair: `max(0, x)` => `max(0, x)^3`

guen::mechanical_system! {
    pub system Bead {
        constants { m > 0, g = 9.81 }
        coordinates { x }
        parameters { v = dot(x); }
        particles { m at vec(x, max(0, x)); }
        gravity = vec(0, -g);
    }
}

fn main() {}
