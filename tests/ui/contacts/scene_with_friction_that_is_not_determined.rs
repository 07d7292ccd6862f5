//! In the only mode of a scene three feet of one block slip, whose loads are not determined.
//!
//! repair: `middle: slip+;` => `middle: open;`

guen::mechanical_system! {
    pub system Block {
        constants { m > 0, J > 0, b > 0, mu >= 0, g = 9.81 }
        coordinates { x, z, tilt }
        kinetic_energy = m/2*(dot(x)^2 + dot(z)^2) + J/2*dot(tilt)^2;
        potential_energy = m*g*z;
        contacts {
            left: gap = z - b*sin(tilt), slip = dot(x) + b/2*dot(tilt), friction = mu;
            middle: gap = z, slip = dot(x), friction = mu;
            right: gap = z + b*sin(tilt), slip = dot(x) - b/3*dot(tilt), friction = mu;
        }
        scene Sliding { modes { left: slip+; middle: slip+; right: slip+; } }
    }
}

fn main() {}
