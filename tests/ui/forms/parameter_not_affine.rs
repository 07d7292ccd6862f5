//! A parameter is affine in the velocities.
//!
//! repair: ` + dot(x)^2` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = x*dot(y) + dot(x)^2; v = dot(x); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
