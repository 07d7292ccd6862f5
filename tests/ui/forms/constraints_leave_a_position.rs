//! Constraints do not hide a condition on positions.
//!
//! repair: `\n            pulled: dot(y) = t + x;` => ``
//! repair: `constraints {` => `holonomic { pulled: -t - x + 1 = 0; }\n        constraints {`
//! repair: `u = dot(z);` => `u = dot(z);`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(z); }
        constraints {
            driven: dot(y) = 1;
            pulled: dot(y) = t + x;
        }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + u^2);
    }
}

fn main() {}
