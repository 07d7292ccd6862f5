//! Contacts that slip in the mode of a scene are closed: their gaps vanish together.
//!
//! repair: `wall: slip+; fence: slip-;` => `wall: slip+; fence: open;`

guen::mechanical_system! {
    pub system Ball {
        constants { m > 0, a > 0, J > 0, mu >= 0, e in 0..1 = 0, g = 9.81 }
        inputs { push }
        coordinates { x, y, z, phi }
        parameters { u = dot(x); v = dot(y); w = dot(z); spin = dot(phi); }
        kinetic_energy = m/2*(u^2 + v^2 + w^2) + J/2*spin^2;
        potential_energy = m*g*z;
        switches { ice: x - 5; }
        forces { push along u; }
        contacts {
            floor: gap = z - a, slip = u - a*spin + dot(y), friction = mu*(1 - ice), restitution = e;
            wall: gap = 9 - x, slip = w, friction = mu;
            fence: gap = x, slip = w, friction = mu;
            bolt: latch = phi, when = w, release = t - 1;
        }
        outputs { force = reaction(floor); }
        modes { bolt: free; }
        scene Falling { modes { floor: open; wall: slip+; fence: slip-; } track v; }
    }
}

fn main() {}
