//! The rolling of a vector is not the rate of a holonomic constraint.
//!
//! repair: `rolling: wheel.velocity_at(contact) = 0;` => `rolling: inner(wheel.velocity_at(contact), vec(1, 0)) = 0;`
//! repair: `parameters { }` => `parameters { u = dot(x); }`

guen::mechanical_system! {
    pub system Wheel {
        constants { m > 0, J > 0, a > 0 }
        coordinates { x, y, phi }
        let contact = vec(x, y - a);
        bodies {
            wheel { mass: m, inertia: diag(J, J, J), center: vec(x, y), orientation: rot_z(phi) }
        }
        holonomic { on_ground: y = a; }
        parameters { }
        constraints { rolling: wheel.velocity_at(contact) = 0; }
    }
}

fn main() {}
