//! A condition on positions is holonomic.
//!
//! repair: `constraints` => `holonomic`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, a > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { circle: x^2 + y^2 = a^2; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
    }
}

fn main() {}
