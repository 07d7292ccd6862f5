//! A release that is above zero everywhere never rises.
//!
//! repair: `release = 1 + ice` => `release = x - 5`

guen::mechanical_system! {
    pub system Ball {
        constants { m > 0, a > 0, J > 0, mu >= 0, e in 0..1 = 0, g = 9.81 }
        inputs { push }
        coordinates { x, z, phi }
        parameters { u = dot(x); w = dot(z); spin = dot(phi); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*spin^2;
        potential_energy = m*g*z;
        switches { ice: x - 5; }
        forces { push along u; }
        contacts {
            bolt: latch = phi, release = 1 + ice;
        }
    }
}

fn main() {}
