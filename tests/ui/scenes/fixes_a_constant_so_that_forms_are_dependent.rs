//! A scene keeps the forms independent.
//!
//! repair: none

guen::mechanical_system! {
    pub system Points {
        constants { m > 0, c != 0 }
        coordinates { x, y }
        parameters { u = dot(x) + c*dot(y); v = dot(x) + dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        scene Equal { fix m = 2, c = 1; }
    }
}

fn main() {}
