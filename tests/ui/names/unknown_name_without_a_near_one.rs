//! A name that is not declared is answered with those that are.
//!
//! repair: `stiffness*x` => `m*x`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = stiffness*x;
    }
}

fn main() {}
