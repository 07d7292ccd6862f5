//! `select` chooses between values of one kind.
//!
//! repair: `vec(x, 0)` => `2*x`

guen::mechanical_system! {
    pub system Stop {
        constants { m > 0, c >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        forces { -c*select(x >= 0, x, vec(x, 0)) along v; }
    }
}

fn main() {}
