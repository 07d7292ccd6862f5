//! A scene is not called like a constant of the generated module.
//!
//! repair: `scene COST` => `scene Cost`

guen::mechanical_system! {
    pub system Point {
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = u^2 + v^2;
        scene COST { track x; }
    }
}

fn main() {}
