//! A default that is made of constants has the dimension of its constant.
//!
//! repair: `= m*k` => `= m/k`

guen::mechanical_system! {
    pub system Spring {
        constants { m: kg > 0, k: kg/s, T: s > 0 = m*k }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -k*v*tanh(t/T) along v; }
    }
}

fn main() {}
