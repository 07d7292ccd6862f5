//! A text of C calls no function of the program.
//!
//! repair: `provide source;` => ``

guen::mechanical_system! {
    pub system Surface {
        constants   { m > 0, g = 9.81 }
        functions   { ground(x); }
        coordinates { x, y }
        parameters  { u = dot(x); v = dot(y); }
        kinetic_energy   = m/2*(u^2 + v^2);
        potential_energy = m*g*(ground(x) + sin(x));
        provide source;
    }
}

fn main() {}
