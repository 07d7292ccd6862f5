//! A function calls those that are declared before it.
//!
//! repair: `bump(a)` => `exp(-a^2)`

guen::mechanical_system! {
    pub system Surface {
        constants { m > 0, h, g = 9.81 }
        coordinates { x, y }
        fn height(a) = h*bump(a);
        fn bump(a) = exp(-a^2);
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*(height(x) + bump(x));
    }
}

fn main() {}
