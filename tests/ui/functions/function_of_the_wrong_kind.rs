//! The kinds of arguments fit where they are used.
//!
//! repair: `height(vec(x, y))` => `height(x)`

guen::mechanical_system! {
    pub system Surface {
        constants { m > 0, h, g = 9.81 }
        coordinates { x, y }
        fn height(a) = h*sin(a);
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*height(vec(x, y));
    }
}

fn main() {}
