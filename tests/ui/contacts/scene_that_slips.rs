//! A contact does not slip in the only mode of a scene.
//!
//! repair: `table: slip;` => `table: stick;`

guen::mechanical_system! {
    pub system Puck {
        constants { m > 0, mu >= 0, g = 9.81 }
        coordinates { x, y, z, swing }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(swing)^2);
        potential_energy = m*g*z + m/2*swing^2;
        contacts { table: gap = z, slip = vec(dot(x), dot(y)), friction = mu; }
        scene Sliding { modes { table: slip; } }
    }
}

fn main() {}
