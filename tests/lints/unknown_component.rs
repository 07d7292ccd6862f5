//! A component that is neither declared nor imported: the compiler looks for it as for a macro, because an import would bring one.

guen::mechanical_system! {
    pub system Cart {
        component Wheel(hub: vector, radius: scalar) {
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
        use Wheal as wheel { hub: vec(x, r), radius: r }
        forces      { -dot(wheel.angle) along dot(wheel.angle); }
    }
}

fn main() {}
