//! A grip that slips needs a load that the mode determines: three feet of one block carry it together.
//!
//! repair: `middle: closed;` => `middle: open;`

guen::mechanical_system! {
    pub system Block {
        constants { m > 0, b > 0, h > 0, g = 9.81 }
        coordinates { x, z, tilt }
        bodies { block { mass: m, center: vec(x, z), inertia: diag(0, 0, m*b^2), orientation: rot_z(tilt) } }
        gravity = vec(0, -g);
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); }
        contacts {
            lid: gap = 9 - z;
            left: gap = z - h - b*sin(tilt);
            middle: gap = z - h;
            right: gap = z - h + b*sin(tilt);
            brake: grip = u, friction = 1/2, load = reaction(left);
        }
        scene Braking { modes { lid: open; left: closed; middle: closed; right: closed; brake: slip+; } }
    }
}

fn main() {}
