//! The limits of a constant can show that a coefficient is below zero.
//!
//! repair: `friction = k - 3` => `friction = k`

guen::mechanical_system! {
    pub system Ball {
        constants { m > 0, a > 0, J > 0, mu >= 0, e in 0..1 = 0, g = 9.81, k in 1..2 }
        inputs { push }
        coordinates { x, z, phi }
        parameters { u = dot(x); w = dot(z); spin = dot(phi); }
        kinetic_energy = m/2*(u^2 + w^2) + J/2*spin^2;
        potential_energy = m*g*z;
        switches { ice: x - 5; }
        forces { push along u; }
        contacts {
            floor: gap = z - a, slip = u, friction = k - 3;
        }
    }
}

fn main() {}
