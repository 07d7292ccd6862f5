//! A gap that moves by itself cannot be held.
//!
//! repair: `gap = y - t` => `gap = z - t`

guen::mechanical_system! {
    pub system Ball {
        constants { m > 0, a > 0, J > 0, mu >= 0, e in 0..1 = 0, g = 9.81 }
        inputs { push }
        coordinates { x, z, phi, y }
        parameters { u = dot(x); w = dot(z); spin = dot(phi); }
        constraints { rest: dot(y) = 0; }
        kinetic_energy = m/2*(u^2 + w^2 + dot(y)^2) + J/2*spin^2;
        potential_energy = m*g*z;
        switches { ice: x - 5; }
        forces { push along u; }
        contacts {
            wall: gap = y - t;
        }
    }
}

fn main() {}
