//! An equation has one `=`.
//!
//! repair: `==` => `=`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { straight: dot(y) == 0; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
    }
}

fn main() {}
