//! A function takes no more than its number of arguments.
//!
//! repair: `sin(x, y)` => `sin(x)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = sin(x, y);
    }
}

fn main() {}
