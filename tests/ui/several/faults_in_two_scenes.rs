//! Faults of several scenes are reported together, and code that uses the scenes is not blamed.
//!
//! repair: none
//! errors: 2

use guen::prelude::*;

guen::mechanical_system! {
    pub system Point {
        constants { m > 0, c }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = m/2*(u^2 + v^2);
        forces { -c*u along u; }
        scene Across { track y; fix m = 1; provide energy; }
        scene Along { track x; fix u; }
        scene Light { track y; fix u; }
    }
}

fn main() {
    let start = point::State { x: 0.0, y: 1.0, u: 1.0, v: 2.0 };
    let across = point::Across::new(0.0).prepare().unwrap();
    let state = point::across::State::from(&start);
    println!("{} {}", across.rhs(0.0, &state).y, across.energy(0.0, &state));
    println!("{}", point::levels());
    let _ = point::Along::of(&point::Point::new(1.0, 0.0), &start);
    let _ = Monitored::residual(&across, 0.0, &state.into());
}
