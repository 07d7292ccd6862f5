//! A scene in one mode in which a contact slips needs a reset.
//!
//! repair: `floor: slip-;` => `floor: slip;`

guen::mechanical_system! {
    pub system Slider {
        constants { m > 0, g = 9.81, period > 0, mu >= 0 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = m/2*(u^2 + w^2);
        potential_energy = m*g*z;
        states { dot(clock) = 1; }
        contacts { floor: gap = z, slip = u, friction = mu; }
        resets { tick: clock - period rises, clock = 0; }
        scene Sliding { modes { floor: slip-; } track u; }
    }
}

fn main() {}
