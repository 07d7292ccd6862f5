//! A text of C has one right-hand side.
//!
//! repair: `provide source;` => `scene Falls { modes { floor: open; } track z; provide source; }`

guen::mechanical_system! {
    pub system Ball {
        constants   { m > 0 = 1, g = 9.81 }
        coordinates { z }
        parameters  { v = dot(z); }
        kinetic_energy   = m/2*v^2;
        potential_energy = m*g*z;
        contacts    { floor: gap = z; }
        provide source;
    }
}

fn main() {}
