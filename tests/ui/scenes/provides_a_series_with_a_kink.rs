//! The motion of a scene with a kink has no Taylor series.
//!
//! repair: ` track y; provide taylor;` => ` track y;`

guen::mechanical_system! {
    pub system Point {
        constants { k }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = 1/2*(u^2 + v^2);
        forces { -k*abs(y)*y along v; }
        scene Across { track x; provide taylor; }
        scene Up { track y; provide taylor; }
    }
}

fn main() {}
