//! Gravity acts on masses.
//!
//! repair: `gravity = vec(0, -9.81);` => `force_function = -9.81*m*y;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        gravity = vec(0, -9.81);
    }
}

fn main() {}
