//! A statement of `modes` names a contact, and not its instance.
//!
//! repair: `left: open` => `left.sole: open`

guen::mechanical_system! {
    pub system Plank {
        component Foot(point: vector) {
            constants { mu >= 0 }
            contacts { sole: gap = point.y, slip = dot(point).x, friction = mu; }
        }
        constants   { m > 0, J > 0, g = 9.81 }
        coordinates { x, z, tilt }
        parameters  { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy   = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        use Foot as left  { point: vec(x - cos(tilt), z - sin(tilt)) }
        use Foot as right { point: vec(x + cos(tilt), z + sin(tilt)) }
        modes { left: open, stick; }
    }
}

fn main() {}
