//! Entries of one array are instances of one component.
//!
//! repair: `use Ball as wheel[1] { }` => `use Wheel as wheel[1] { hub: vec(x, r), radius: r }`

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
        component Ball() { coordinates { y } kinetic_energy = dot(y)^2; }
        constants   { r > 0 }
        coordinates { x }
        use Wheel as wheel[0] { hub: vec(x, r), radius: r }
        use Ball as wheel[1] { }
    }
}

fn main() {}
