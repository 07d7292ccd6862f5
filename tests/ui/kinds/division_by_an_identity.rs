//! Nothing is divided by what vanishes by an identity.
//!
//! repair: `cos(2*x) - cos(x)^2 + sin(x)^2` => `cos(2*x) - cos(x)^2`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = 1/(cos(2*x) - cos(x)^2 + sin(x)^2);
    }
}

fn main() {}
