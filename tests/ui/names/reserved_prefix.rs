//! Names of the expansion are reserved.
//!
//! repair: `__guen_k` => `k`
//! repair: `__guen_k` => `k`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, __guen_k }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = -__guen_k*x;
    }
}

fn main() {}
