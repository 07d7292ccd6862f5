//! A function of the program has at most eight arguments.
//!
//! repair: `ground(a, b, c, d, e, f, h, i, j)` => `ground(a, b, c, d, e, f, h, i)`
//! repair: `x, y, x, y, x, y, x, y, x` => `x, y, x, y, x, y, x, y`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(a, b, c, d, e, f, h, i, j); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground(x, y, x, y, x, y, x, y, x);
    }
}

fn main() {}
