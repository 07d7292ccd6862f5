//! Functions other than roots take numbers.
//!
//! repair: `tanh(dot(x))` => `tanh(dot(x)/w)`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg > 0, f: N, w: m/s > 0 }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -f*tanh(dot(x)) - 0*w along v; }
    }
}

fn main() {}
