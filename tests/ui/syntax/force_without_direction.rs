//! A force acts along a velocity.
//!
//! repair: `= -u` => `along -u`
//! repair: `drag along -u` => `-u along u`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        forces { drag = -u; }
    }
}

fn main() {}
