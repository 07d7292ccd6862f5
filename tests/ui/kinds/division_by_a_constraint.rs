//! Nothing is divided by what vanishes on the constraints.
//!
//! repair: `(x - y)` => `(x + y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        holonomic { together: x = y; }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        force_function = 1/(x - y);
    }
}

fn main() {}
