//! There are no arrays of functions.
//!
//! repair: `ground[2](x)` => `ground(i, x)`
//! repair: `ground[0](x)` => `ground(0, x)`
//! errors: 2

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground[2](x); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*ground[0](x);
    }
}

fn main() {}
