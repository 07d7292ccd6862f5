//! A motion with a kink has no Taylor series.
//!
//! repair: `        provide taylor;\n` => ``

guen::mechanical_system! {
    pub system Slider {
        constants { m > 0, mu >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -mu*sign(v) along v; }
        provide taylor;
    }
}

fn main() {}
