//! Two dependent forms are two errors.
//!
//! repair: `v = 2*dot(x)` => `v = 2*dot(z)`
//! repair: `w = 3*dot(y)` => `w = 3*dot(w0)`
//! errors: 2

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z, w0 }
        parameters { u = dot(x); v = 2*dot(x); s = dot(y); w = 3*dot(y); }
        kinetic_energy = m/2*(u^2 + v^2 + s^2 + w^2 + dot(z)^2 + dot(w0)^2);
    }
}

fn main() {}
