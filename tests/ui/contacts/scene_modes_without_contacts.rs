//! Modes of a scene are those of contacts.
//!
//! repair: `modes { floor: open; } track z;` => `track z;`

guen::mechanical_system! {
    pub system Ball {
        constants { m > 0, g = 9.81 }
        coordinates { z }
        parameters { w = dot(z); }
        kinetic_energy = m/2*w^2;
        potential_energy = m*g*z;
        scene Falling { modes { floor: open; } track z; }
    }
}

fn main() {}
