//! A default is known before the program supplies functions.
//!
//! repair: `ground(1)` => `1`

guen::mechanical_system! {
    pub system Surface {
        functions   { ground(x); }
        constants   { m > 0 = ground(1), g = 9.81 }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x);
    }
}

fn main() {}
