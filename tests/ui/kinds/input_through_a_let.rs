//! An input enters forces only, through a name too.
//!
//! repair: `= power;` => `= x;\n        forces { power along dot(x); }`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        inputs { tau }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let power = tau*x;
        force_function = power;
    }
}

fn main() {}
