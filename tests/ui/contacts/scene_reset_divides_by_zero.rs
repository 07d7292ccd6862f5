//! At the values of a scene no reset divides by zero.
//!
//! repair: `slope = 0` => `slope = 1/2`

guen::mechanical_system! {
    pub system Puck {
        constants   { m > 0, mu >= 0, g = 9.81, slope }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*y;
        contacts { ground: gap = y, slip = u, friction = mu; }
        resets   { lift: x - 1/slope rises, v = 1; }
        scene Deep { fix slope = 0; }
    }
}

fn main() {}
