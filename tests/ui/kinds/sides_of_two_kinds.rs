//! The sides of an equation are of one kind.
//!
//! repair: `dot(p) = dot(x)` => `dot(p) = vec(dot(y), 0)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        let p = vec(x, y);
        constraints { c: dot(p) = dot(x); }
        kinetic_energy = m/2*inner(dot(p), dot(p));
    }
}

fn main() {}
