//! A constraint is affine in the velocities.
//!
//! repair: `sin(dot(y))` => `sin(y)*dot(y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { c: dot(x) + 2*(y*u - sin(dot(y))) = 0; }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
