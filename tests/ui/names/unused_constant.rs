//! A constant is used.
//!
//! repair: `, k }` => ` }`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, k }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
