//! Constraints do not contradict each other.
//!
//! repair: `dot(y) = 2;` => `dot(z) = 2;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); }
        constraints {
            slow: dot(y) = 1;
            fast: dot(y) = 2;
        }
        kinetic_energy = m/2*(u^2 + dot(y)^2 + dot(z)^2);
    }
}

fn main() {}
