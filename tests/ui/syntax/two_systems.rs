//! One invocation declares one system.
//!
//! repair: none

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = m/2*u^2;
    }
    pub system Other {
        constants { m > 0 }
        coordinates { x }
        parameters { u = dot(x); }
        kinetic_energy = m/2*u^2;
    }
}

fn main() {}
