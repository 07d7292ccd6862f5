//! No constraint is the rate of a holonomic one.
//!
//! repair: `\n        constraints { rolling: dot(z) = dot(y); }` => ``
//! repair: `u = dot(x);` => `u = dot(x); v = dot(y);`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y, z }
        parameters { u = dot(x); }
        holonomic { on_ground: z = y; }
        constraints { rolling: dot(z) = dot(y); }
        kinetic_energy = m/2*(u^2 + dot(y)^2 + dot(z)^2);
    }
}

fn main() {}
