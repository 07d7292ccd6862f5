//! What the program supplies has no expression.
//!
//! repair: `functions   { ground(x) = x^2; }` => `fn ground(x) = x^2;`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x) = x^2; }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x);
    }
}

fn main() {}
