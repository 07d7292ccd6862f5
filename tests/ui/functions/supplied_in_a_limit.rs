//! Limits are known before the program supplies functions.
//!
//! repair: `ground(1)` => `1`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x);
        inputs { push in 0..ground(1) }
        forces { push along u; }
    }
}

fn main() {}
