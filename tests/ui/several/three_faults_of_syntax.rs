//! Three faults of syntax are three errors.
//!
//! repair: `2x` => `2*x`
//! repair: `y**2` => `y^2`
//! repair: `==` => `=`
//! errors: 3

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); }
        constraints { c: dot(y) == 0; }
        kinetic_energy = m/2*(u^2 + dot(y)^2);
        force_function = 2x + y**2;
    }
}

fn main() {}
