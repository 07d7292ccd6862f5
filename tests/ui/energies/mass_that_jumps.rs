//! A mass has no jumps: momenta would jump.
//!
//! repair: `(1 + floor(t))*m` => `(1 + t)*m`

guen::mechanical_system! {
    pub system Cart {
        constants { m > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        particles { (1 + floor(t))*m at vec(x, 0); }
    }
}

fn main() {}
