//! A scene cannot fix a variable that a reset changes.
//!
//! repair: `fix strength;` => ``

guen::mechanical_system! {
    pub system Clocked {
        constants { m > 0, period > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
        states { dot(clock) = 1; dot(strength) = 0; }
        forces { -strength*x along v; }
        resets { tick: clock - period rises, clock = 0, strength = strength + 1; }
        scene Held { track x; fix strength; }
    }
}

fn main() {}
