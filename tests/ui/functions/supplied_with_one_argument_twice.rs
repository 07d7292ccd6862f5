//! Arguments of a function of the program have different names.
//!
//! repair: `ground(x, x)` => `ground(x, y)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x, x); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x, y);
    }
}

fn main() {}
