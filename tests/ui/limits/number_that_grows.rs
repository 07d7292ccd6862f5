//! Numbers stay between 10^-400 and 10^400.
//!
//! repair: `1e300*x*1e300` => `1e300*x`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = 1e300*x*1e300;
    }
}

fn main() {}
