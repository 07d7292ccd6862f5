//! Only functions are called.
//!
//! repair: `m(x + y)` => `m*(x + y)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = m(x + y);
    }
}

fn main() {}
