//! A function is defined for its argument.
//!
//! repair: `ln(-2)` => `ln(2)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = ln(-2)*x;
    }
}

fn main() {}
