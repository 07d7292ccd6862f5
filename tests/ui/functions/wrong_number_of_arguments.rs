//! A call gives every argument.
//!
//! repair: `height(x)` => `height(x, y)`

guen::mechanical_system! {
    pub system Surface {
        constants { m > 0, h, g = 9.81 }
        coordinates { x, y }
        fn height(a, b) = h*exp(-(a^2 + b^2));
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2);
        potential_energy = m*g*height(x);
    }
}

fn main() {}
