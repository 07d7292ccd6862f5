//! Only doc comments stand inside of a declaration.
//!
//! repair: `#[cfg(test)]\n        ` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        #[cfg(test)]
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
