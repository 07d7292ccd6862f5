//! A rotation is applied from the left.
//!
//! repair: `e*R` => `R*e`

guen::mechanical_system! {
    pub system Rotor {
        constants { m > 0, a }
        coordinates { x }
        parameters { u = dot(x); }
        let R = rot_z(x);
        let e = vec(a, 0);
        particles { m at e*R; }
    }
}

fn main() {}
