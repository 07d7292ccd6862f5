//! A reset happens where a function goes through zero.
//!
//! repair: `tick: clock > period, clock = 0, v = -v;` => `tick: clock - period rises, clock = 0, v = -v;`

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
        resets { tick: clock > period, clock = 0, v = -v; }
    }
}

fn main() {}
