//! Constraints are affine in the velocities, functions written out.
//!
//! repair: `square(dot(x))` => `3*dot(x)`

guen::mechanical_system! {
    pub system Surface {
        constants { m > 0, h, g = 9.81 }
        coordinates { x, y }
        fn square(a) = a^2;
        parameters { u = dot(x); }
        constraints { slope: dot(y) = square(dot(x)); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*h*x;
    }
}

fn main() {}
