//! Functions of the program take and give scalars: there is no type to write.
//!
//! repair: `ground(x: f64)` => `ground(x)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x: f64); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x);
    }
}

fn main() {}
