//! A slip that goes along its gap in one instance is told with that instance.
//!
//! repair: `ahead: w` => `ahead: u`

guen::mechanical_system! {
    pub system Plank {
        component Foot(height: scalar, ahead: scalar) {
            constants { mu >= 0 }
            contacts { sole: gap = height, slip = ahead, friction = mu; }
        }
        constants   { m > 0, J > 0, g = 9.81 }
        coordinates { x, z, tilt }
        parameters  { u = dot(x); w = dot(z); omega = dot(tilt); }
        kinetic_energy   = m/2*(u^2 + w^2) + J/2*omega^2;
        potential_energy = m*g*z;
        use Foot as left  { height: z - sin(tilt), ahead: u }
        use Foot as right { height: z, ahead: w }
    }
}

fn main() {}
