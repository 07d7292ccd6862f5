//! An unknown name is one mistake, however often it is used.
//!
//! repair: `constants { m > 0 }` => `constants { m > 0, k }`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let stretch = k*x;
        let other = k*stretch;
        force_function = k*other + stretch;
    }
}

fn main() {}
