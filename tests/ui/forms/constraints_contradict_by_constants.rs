//! Constraints do not contradict each other for most constants.
//!
//! repair: `dot(y) = b;` => `dot(z) = b;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, a, b }
        coordinates { x, y, z }
        parameters { u = dot(x); }
        constraints {
            slow: dot(y) = a;
            fast: dot(y) = b;
        }
        kinetic_energy = m/2*(u^2 + dot(y)^2 + dot(z)^2);
    }
}

fn main() {}
