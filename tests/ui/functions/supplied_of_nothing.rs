//! A function of the program has arguments.
//!
//! repair: `ground();` => `ground(x);`
//! repair: `*ground()` => `*ground(x)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground();
    }
}

fn main() {}
