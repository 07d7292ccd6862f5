//! Slip in a plane has no sign.
//!
//! repair: `foot: stick, slip+;` => `foot: stick, slip;`

guen::mechanical_system! {
    pub system Puck {
        constants { m > 0, mu >= 0, g = 9.81 }
        coordinates { x, y, z }
        parameters { u = dot(x); v = dot(y); w = dot(z); }
        particles { m at vec(x, y, z); }
        gravity = vec(0, 0, -g);
        contacts { foot: gap = z, slip = vec(u, v, 0), friction = mu; }
        modes { foot: stick, slip+; }
    }
}

fn main() {}
