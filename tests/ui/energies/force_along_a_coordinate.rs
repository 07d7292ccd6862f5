//! A force acts along a velocity, not along a coordinate.
//!
//! repair: `along x` => `along dot(x)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        forces { -u along x; }
    }
}

fn main() {}
