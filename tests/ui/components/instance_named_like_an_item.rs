//! An instance has a name that the module of the system leaves free.
//!
//! repair: `use Disc as program` => `use Disc as wheel`
//! repair: `-dot(program.angle) along dot(program.angle)` => `-dot(wheel.angle) along dot(wheel.angle)`

guen::mechanical_system! {
    pub system Cart {
        component Disc(hub: vector, radius: scalar) {
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
        use Disc as program { hub: vec(x, r), radius: r }
        forces      { -dot(program.angle) along dot(program.angle); }
    }
}

fn main() {}
