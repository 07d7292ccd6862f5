//! A system has a name of its own.
//!
//! repair: `State` => `Point`

guen::mechanical_system! {
    pub system State {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
