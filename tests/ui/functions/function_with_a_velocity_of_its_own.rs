//! What a function says is allowed where it is called.
//!
//! repair: `a*dot(x)` => `a`

guen::mechanical_system! {
    pub system Surface {
        constants { m > 0, h, g = 9.81 }
        coordinates { x, y }
        fn height(a) = h*a*dot(x);
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*height(y);
    }
}

fn main() {}
