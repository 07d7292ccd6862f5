//! A constraint stays affine in the velocities whatever function the program supplies.
//!
//! repair: `ratio(dot(x))` => `ratio(x)*dot(x)`

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ratio(speed); }
        coordinates { x, y }
        parameters  { u = dot(x); }
        constraints { gear: dot(y) = ratio(dot(x)); }
        kinetic_energy   = m/2*(dot(x)^2 + dot(y)^2);
    }
}

fn main() {}
