//! A contact without a gap can have further faults.
//!
//! repair: `slip = u + vv, restitution = x` => `gap = z - a, restitution = e`
//! errors: 3

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
            floor: slip = u + vv, restitution = x;
        }
    }
}

fn main() {}
