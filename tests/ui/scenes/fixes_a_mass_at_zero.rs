//! A scene keeps the system regular.
//!
//! repair: none

guen::mechanical_system! {
    pub system Points {
        constants { m > 0, M }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*u^2 + M/2*v^2;
        scene Light { fix M = 0; }
    }
}

fn main() {}
