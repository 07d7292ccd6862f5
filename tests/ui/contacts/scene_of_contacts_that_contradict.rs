//! The contacts of a mode can touch together.
//!
//! repair: `floor: stick; belt: stick;` => `floor: stick; belt: open;`

guen::mechanical_system! {
    pub system Block {
        constants { m > 0, g = 9.81, speed = 2 }
        coordinates { x, z, y }
        particles { m at vec(x, z, y); }
        gravity = vec(0, -g);
        contacts {
            floor: gap = z, slip = dot(x), friction = 1/2;
            belt: gap = 1 - z, slip = dot(x) - speed, friction = 1/2;
        }
        scene Between { modes { floor: stick; belt: stick; } track y; }
    }
}

fn main() {}
