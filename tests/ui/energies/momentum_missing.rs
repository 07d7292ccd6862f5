//! The kinetic energy is written with the constraints dropped.
//!
//! repair: `m/2*(u^2 + v^2)` => `m/2*(dot(x)^2 + dot(y)^2 + v^2)`

guen::mechanical_system! {
    pub system Sled {
        constants { m > 0 }
        coordinates { x, y, phi }
        parameters {
            v = dot(phi);
            u = dot(x)*cos(phi) + dot(y)*sin(phi);
        }
        constraints { blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }
        kinetic_energy = m/2*(u^2 + v^2);
    }
}

fn main() {}
