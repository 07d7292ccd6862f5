//! An exponent that is a fraction stands in parentheses.
//!
//! repair: `x^1/2` => `x^(1/2)`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = x^1/2;
    }
}

fn main() {}
