//! A function of the program is given every argument.
//!
//! repair: `*ground(x)` => `*ground(x, y)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x, y); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x);
    }
}

fn main() {}
