//! A constraint says more than `0 = 0`.
//!
//! repair: `(dot(x) + dot(y))*(cos(2*x) - cos(x)^2 + sin(x)^2) = 0` => `dot(x) + dot(y) = 0`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { c: (dot(x) + dot(y))*(cos(2*x) - cos(x)^2 + sin(x)^2) = 0; }
        kinetic_energy = m/2*(u^2 + dot(y)^2);
    }
}

fn main() {}
