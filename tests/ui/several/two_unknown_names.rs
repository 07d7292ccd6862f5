//! Two unknown names are two errors.
//!
//! repair: `stiffness*x` => `m*x`
//! repair: `gravity_constant*y` => `m*y`
//! errors: 2

guen::mechanical_system! {
    pub system Point {
        constants { m > 0 }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        force_function = stiffness*x + gravity_constant*y;
    }
}

fn main() {}
