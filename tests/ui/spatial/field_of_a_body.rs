//! A body has its fields.
//!
//! repair: `block.speed` => `block.center`

guen::mechanical_system! {
    pub system Slider {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        bodies { block { mass: m, center: vec(x, y) } }
        outputs { w = block.speed; }
    }
}

fn main() {}
