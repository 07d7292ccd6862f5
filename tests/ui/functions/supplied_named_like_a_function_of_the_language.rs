//! Functions of the language keep their names.
//!
//! repair: `{ floor(x); }` => `{ ground(x); }`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { floor(x); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*x;
    }
}

fn main() {}
