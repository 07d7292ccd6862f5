//! Only constants may be given in degrees.
//!
//! repair: `x: deg` => `x: rad`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg*m^2 > 0, k: N*m }
        coordinates { x: deg }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*x along v; }
    }
}

fn main() {}
