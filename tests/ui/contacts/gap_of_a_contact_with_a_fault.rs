//! Who asks for the gap of a contact with a fault is told of the fault alone.
//!
//! repair: `gap = zz` => `gap = z`

guen::mechanical_system! {
    pub system Box {
        constants { m > 0, g = 9.81 }
        coordinates { x, z }
        particles { m at vec(x, z); }
        gravity = vec(0, -g);
        contacts { floor: gap = zz; }
        outputs { height = gap(floor); }
        scene Low { modes { floor: open; } track z; }
    }
}

fn main() {}
