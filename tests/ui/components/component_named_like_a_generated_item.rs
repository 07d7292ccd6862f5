//! A component in braces has a name that the module leaves free.
//!
//! repair: `component State` => `component Wheel`
//! repair: `use State` => `use Wheel`

guen::mechanical_system! {
    pub system Cart {
        component State(hub: vector, radius: scalar) {
            constants   { mass > 0, inertia > 0 }
            coordinates { angle }
            fn square(a) = a^2;
            particles   { mass at hub; }
            kinetic_energy = inertia/2*dot(angle)^2;
            constraints { rolls: dot(hub).x = radius*dot(angle); }
            outputs     { doubled = square(angle); }
        }
        constants   { r > 0 }
        coordinates { x }
        use State as wheel { hub: vec(x, r), radius: r }
        forces      { -dot(wheel.angle) along dot(wheel.angle); }
    }
}

fn main() {}
