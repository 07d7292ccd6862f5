//! A mistake in a component is told once, with the first instance that shows it.
//!
//! repair: `inertia at hub*hub` => `mass at hub`

guen::mechanical_system! {
    pub system Cart {
        component Wheel(hub: vector, radius: scalar) {
            constants   { mass > 0, inertia > 0 }
            coordinates { angle }
            fn square(a) = a^2;
            particles   { inertia at hub*hub; }
            kinetic_energy = inertia/2*dot(angle)^2;
            constraints { rolls: dot(hub).x = radius*dot(angle); }
            outputs     { doubled = square(angle); }
        }
        constants   { r > 0 }
        coordinates { x }
        use Wheel as wheel { hub: vec(x, r), radius: r }
        use Wheel as other { hub: vec(x, 2*r), radius: 2*r }
        forces      { -dot(wheel.angle) along dot(wheel.angle); }
    }
}

fn main() {}
