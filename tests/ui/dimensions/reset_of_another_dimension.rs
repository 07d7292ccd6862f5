//! A variable and its new value have one dimension.
//!
//! repair: `v = x` => `v = -v`

guen::mechanical_system! {
    pub system Clocked {
        constants { m: kg > 0, period: s > 0 }
        coordinates { x: m }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        resets { tick: t - period rises, v = x; }
    }
}

fn main() {}
