//! `pub` stands before `system` only.
//!
//! repair: `pub let` => `let`
//! repair: `2*x` => `x`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        pub let w = 2*x;
        force_function = w;
    }
}

fn main() {}
