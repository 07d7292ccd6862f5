//! A scene provides no reaction that its mode does not determine.
//!
//! repair: `provide load;` => ``

guen::mechanical_system! {
    pub system Block {
        constants { m > 0, b > 0, h > 0, l > 0, g = 9.81 }
        coordinates { x, z, tilt, q }
        bodies { block { mass: m, center: vec(x, z), inertia: diag(0, 0, m), orientation: rot_z(tilt) } }
        particles { m at vec(x, z) + l*vec(sin(q), -cos(q)); }
        gravity = vec(0, -g);
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); swing = dot(q); }
        let left = vec(x, z) + rot_z(tilt)*vec(-b, -h);
        let right = vec(x, z) + rot_z(tilt)*vec(b, -h);
        contacts {
            left_foot: gap = left.y, slip = block.velocity_at(left).x, friction = 1/2;
            right_foot: gap = right.y, slip = block.velocity_at(right).x, friction = 1/2;
        }
        outputs { load = reaction(right_foot); }
        scene Resting { modes { left_foot: stick; right_foot: stick; } track q; provide load; }
    }
}

fn main() {}
