//! Numbers lie between 10^-400 and 10^400.
//!
//! repair: `1e999` => `1e99`

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = 1e999*x;
    }
}

fn main() {}
