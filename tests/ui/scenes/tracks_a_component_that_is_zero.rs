//! A component of a vector that is zero is no variable, and is not tracked.
//!
//! repair: `track x, v_z;` => `track x, v_y;`

guen::mechanical_system! {
    pub system Puck {
        constants        { m > 0, k >= 0 }
        coordinates      { x, y }
        parameters       { v = dot(vec(x, y)); }
        kinetic_energy   = m/2*inner(v, v);
        potential_energy = k/2*(x^2 + y^2);
        scene Seen       { track x, v_z; }
    }
}

fn main() {}
