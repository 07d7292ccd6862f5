//! Words of the language are reserved.
//!
//! repair: `let energy = x;` => `let e = x;`
//! repair: `-energy;` => `-e;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let energy = x;
        force_function = -energy;
    }
}

fn main() {}
