//! A function of the program has a name of its own.
//!
//! repair: `{ x(s); }` => `{ ground(s); }`
//! repair: `*x(x)` => `*ground(x)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        coordinates { x, y }
        functions   { x(s); }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*x(x);
    }
}

fn main() {}
