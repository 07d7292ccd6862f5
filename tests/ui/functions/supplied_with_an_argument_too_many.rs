//! A function of the program is given its arguments and no more.
//!
//! repair: `*ground(x, y)` => `*ground(x)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x, y);
    }
}

fn main() {}
