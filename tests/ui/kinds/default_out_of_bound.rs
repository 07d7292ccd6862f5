//! A default keeps its bound.
//!
//! repair: `= -1` => `= 1`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 = -1 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
