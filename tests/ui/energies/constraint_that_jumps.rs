//! A constraint on velocities has no jumps.
//!
//! repair: `select(x > 1, 2, 1)*dot(x)` => `2*dot(x)`

guen::mechanical_system! {
    pub system Gear {
        constants { m > 0 }
        coordinates { x, y }
        parameters { v = dot(x); }
        constraints { shifts: dot(y) = select(x > 1, 2, 1)*dot(x); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
    }
}

fn main() {}
