//! A fault in a `let` is no fault where the name is used.
//!
//! repair: `lenght` => `length`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, length > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let height = lenght*cos(x);
        let twice = 2*height;
        force_function = height + sin(twice);
    }
}

fn main() {}
