//! A force acts along something affine in the velocities.
//!
//! repair: `x + u^2` => `x*u`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        forces { -u along v + (x + u^2); }
    }
}

fn main() {}
