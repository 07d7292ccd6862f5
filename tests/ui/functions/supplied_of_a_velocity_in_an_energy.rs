//! A kinetic energy stays quadratic in the velocities whatever function the program supplies.
//!
//! repair: `inertia(v)` => `inertia(x)*v^2`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { inertia(speed); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + inertia(v));
    }
}

fn main() {}
