//! Names of functions are reserved.
//!
//! repair: `let sin = x;` => `let s = x;`
//! repair: `-sin;` => `-s;`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let sin = x;
        force_function = -sin;
    }
}

fn main() {}
