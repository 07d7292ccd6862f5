//! All names are different.
//!
//! repair: `let m = x;` => `let w = x;`
//! repair: `-m` => `-m*w`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let m = x;
        force_function = -m;
    }
}

fn main() {}
