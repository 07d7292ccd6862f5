//! A coordinate is fixed at its initial value.
//!
//! repair: none

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        outputs { speed = sqrt(u^2 + v^2); }
        scene Small { fix x = 1; }
    }
}

fn main() {}
