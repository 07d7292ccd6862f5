//! A function of the program is declared before its calls.
//!
//! repair: `ground(x);` => `x;`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        coordinates { x, y }
        let height = ground(x);
        functions   { ground(x); }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*height*ground(y);
    }
}

fn main() {}
