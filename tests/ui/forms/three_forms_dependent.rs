//! The forms are independent, all together.
//!
//! repair: `w = dot(y) - dot(x)` => `w = dot(z)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters {
            u = dot(x) + dot(z);
            v = dot(y) + dot(z);
            w = dot(y) - dot(x);
        }
        kinetic_energy = m/2*(u^2 + v^2 + w^2);
    }
}

fn main() {}
