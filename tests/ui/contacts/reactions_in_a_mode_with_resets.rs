//! In a scene with resets contacts are no constraints.
//!
//! repair: `provide reactions(floor);` => `provide force;`

guen::mechanical_system! {
    pub system Dancer {
        constants { m > 0, g = 9.81, period > 0, step > 0, mu >= 0 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = m/2*(u^2 + w^2);
        potential_energy = m*g*z;
        states { dot(clock) = 1; }
        contacts { floor: gap = z, slip = u, friction = mu; }
        resets { tick: clock - period rises, clock = 0, x = x + step; }
        outputs { force = reaction(floor); }
        scene Standing { modes { floor: stick; } track x; provide reactions(floor); }
    }
}

fn main() {}
