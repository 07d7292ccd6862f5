//! Nothing is raised to a negative power that vanishes.
//!
//! repair: `(x - x)^-1` => `x^-1`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = (x - x)^-1;
    }
}

fn main() {}
