//! The velocity of points of a body needs an orientation.
//!
//! repair: `block.velocity_at(vec(0, 0))` => `dot(block.center)`

guen::mechanical_system! {
    pub system Slider {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        bodies { block { mass: m, center: vec(x, y) } }
        outputs { w = block.velocity_at(vec(0, 0)); }
    }
}

fn main() {}
