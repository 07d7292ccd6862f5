//! The components of a vector have names of their own.
//!
//! repair: `let p_x` => `let q`
//! repair: `-p_x` => `-q`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { p = dot(vec(x, y)); }
        let p_x = x;
        kinetic_energy = m/2*inner(p, p);
        force_function = -p_x;
    }
}

fn main() {}
