//! Every section is given at most once.
//!
//! repair: `\n        constants { k }` => ``
//! repair: `{ m > 0 }` => `{ m > 0, k }`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        constants { k }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = k*x;
    }
}

fn main() {}
