//! A value that follows from others has no new value.
//!
//! repair: `tick: clock - period rises, clock = 0, ahead = 1;` => `tick: clock - period rises, clock = 0, v = -v;`

guen::mechanical_system! {
    pub system Clocked {
        constants { m > 0, period > 0 }
        inputs { push }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        states { dot(clock) = 1; }
        let ahead = x + v;
        switches { far: x - 1; }
        forces { push*far*ahead along v; }
        resets { tick: clock - period rises, clock = 0, ahead = 1; }
    }
}

fn main() {}
