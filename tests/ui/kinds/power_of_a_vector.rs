//! Powers are of scalars.
//!
//! repair: `p^2` => `inner(p, p)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let p = vec(x, y);
        force_function = p^2;
    }
}

fn main() {}
