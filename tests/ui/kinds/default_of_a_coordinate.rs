//! A default is made of earlier constants.
//!
//! repair: `length = x` => `length = 2`

guen::mechanical_system! {
    pub system Point {
        coordinates { x, y }
        constants { m > 0, length = x }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = length*x;
    }
}

fn main() {}
