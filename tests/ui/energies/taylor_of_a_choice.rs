//! A motion with a switch has no Taylor series.
//!
//! repair: `        provide taylor;\n` => ``

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*max(x, 0) along v; }
        provide taylor;
    }
}

fn main() {}
