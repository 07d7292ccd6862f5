//! The forms are independent, by trigonometric identities too.
//!
//! repair: `(1 - cos(2*x))*dot(z)` => `(1 + cos(2*x))*dot(z)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters {
            u = cos(x)*dot(y) + sin(x)*dot(z);
            v = 2*sin(x)*cos(x)*dot(y) + (1 - cos(2*x))*dot(z);
            w = dot(x);
        }
        kinetic_energy = m/2*(u^2 + v^2 + w^2);
    }
}

fn main() {}
