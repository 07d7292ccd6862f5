//! Mass and center go together.
//!
//! repair: `{ mass: m }` => `{ mass: m, center: vec(x, 0) }`

guen::mechanical_system! {
    pub system Slider {
        constants { m > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        bodies { block { mass: m } }
    }
}

fn main() {}
