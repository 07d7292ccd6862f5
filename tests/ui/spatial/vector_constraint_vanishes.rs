//! A vector constraint says more than `0 = 0`.
//!
//! repair: `\n        constraints { c: dot(p) - vec(u, v) = 0; }` => ``

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        let p = vec(x, y);
        constraints { c: dot(p) - vec(u, v) = 0; }
        kinetic_energy = m/2*(u^2 + v^2);
        outputs { place = p; }
    }
}

fn main() {}
