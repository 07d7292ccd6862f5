//! An inertia has three or six entries.
//!
//! repair: `diag(J, J)` => `diag(J, J, J)`

guen::mechanical_system! {
    pub system Rotor {
        constants { J > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        bodies { wheel { inertia: diag(J, J), orientation: rot_z(x) } }
    }
}

fn main() {}
