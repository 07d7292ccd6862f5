//! Three faults in three sections are three errors.
//!
//! repair: `2*dot(x)^2` => `2*dot(x)`
//! repair: `v^3` => `v^2`
//! repair: `(x - x)` => `x`
//! errors: 3

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = 2*dot(x)^2; v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^3);
        potential_energy = 1/(x - x);
    }
}

fn main() {}
