//! An orientation is a rotation.
//!
//! repair: `orientation: x` => `orientation: rot_z(x)`

guen::mechanical_system! {
    pub system Rotor {
        constants { J > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        bodies { wheel { inertia: diag(J, J, J), orientation: x } }
    }
}

fn main() {}
