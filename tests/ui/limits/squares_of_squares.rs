//! A chain of squares stays below the 1000th power.
//!
//! repair: none

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        let a0 = x;
        let a1 = a0^2;
        let a2 = a1^2;
        let a3 = a2^2;
        let a4 = a3^2;
        let a5 = a4^2;
        let a6 = a5^2;
        let a7 = a6^2;
        let a8 = a7^2;
        let a9 = a8^2;
        let a10 = a9^2;
        let a11 = a10^2;
        let a12 = a11^2;
        force_function = a12;
    }
}

fn main() {}
