//! A power is written with `^`.
//!
//! repair: `x**2` => `x^2`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = x**2;
    }
}

fn main() {}
