//! A component that says `0 = 0` has no reaction.
//!
//! repair: `reaction(rail).x` => `reaction(rail).y`

guen::mechanical_system! {
    pub system Slider {
        constants { m > 0, mu >= 0, g = 9.81 }
        coordinates { x, y, z }
        let place = vec(x, y, z);
        particles { m at place; }
        gravity = vec(0, 0, -g);
        constraints { rail: dot(place) = dot(x)*vec(1, 0, 0); }
        parameters { u = dot(x); }
        contacts { rub: grip = u, friction = mu, load = reaction(rail).x; }
    }
}

fn main() {}
