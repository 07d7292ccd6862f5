//! A force and the velocity that it acts along are of one kind.
//!
//! repair: `F along dot(p)` => `F along dot(x)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        inputs { F }
        let p = vec(x, y);
        forces { F along dot(p); }
        outputs { place = p; }
    }
}

fn main() {}
