//! At the values of a scene no contact divides by zero.
//!
//! repair: `roughness = 0` => `roughness = 1/2`

guen::mechanical_system! {
    pub system Puck {
        constants   { m > 0, mu >= 0, roughness >= 0, g = 9.81 }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*y;
        contacts { ground: gap = y, slip = u, friction = mu/roughness; }
        scene Smooth { fix roughness = 0; }
    }
}

fn main() {}
