//! A component that is neither declared nor imported, with a fault of the grammar and an unknown name elsewhere: all are told.

guen::mechanical_system! {
    pub system Cart {
        constants   { m > 0 }
        coordinates { x }
        use Wheal as wheel { hub: x }
        parameters  { v == dot(x); }
        kinetic_energy = m/2*v^2;
        forces      { -dot(wheel.angle) along dot(x); }
    }
}

guen::mechanical_system! {
    pub system Trolley {
        constants   { m > 0 }
        coordinates { x }
        use Wheal as wheel { hub: x }
        parameters  { v = dot(x); }
        kinetic_energy = M/2*v^2;
        forces      { -dot(wheel.angle) along dot(x); }
    }
}

fn main() {}
