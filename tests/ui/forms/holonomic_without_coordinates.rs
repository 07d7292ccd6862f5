//! A condition on positions has coordinates in it.
//!
//! repair: `t = 1` => `y = t`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        holonomic { c: t = 1; }
        kinetic_energy = m/2*(u^2 + dot(y)^2);
    }
}

fn main() {}
