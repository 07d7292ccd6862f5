//! The number of forms and an unused name are two errors.
//!
//! repair: `, k }` => ` }`
//! repair: `u = dot(x);` => `u = dot(x); v = dot(y);`
//! errors: 2

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, k }
        coordinates { x, y }
        parameters { u = dot(x); }
        kinetic_energy = m/2*(u^2 + dot(y)^2);
    }
}

fn main() {}
