//! A method that does not exist is answered with the nearest one.
//!
//! repair: `.powi3()` => `.powi(3)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = x.powi3();
    }
}

fn main() {}
