//! In the only mode of a scene two grips slip, each loaded by the reaction of another constraint.
//!
//! repair: `second: slip+;` => `second: stick;`

guen::mechanical_system! {
    pub system Slides {
        constants { m > 0, mu >= 0, g = 9.81 }
        coordinates { x, y, u, v, w }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(v)^2 + dot(w)^2) + m/9*dot(x)*dot(u);
        potential_energy = m*g*(y + v) + m*w^2;
        constraints { table: dot(y) = 0; ceiling: dot(v) = 0; }
        contacts {
            first: grip = dot(x), friction = mu, load = reaction(table);
            second: grip = dot(u), friction = mu, load = reaction(ceiling);
        }
        scene Sliding { modes { first: slip+; second: slip+; } }
    }
}

fn main() {}
