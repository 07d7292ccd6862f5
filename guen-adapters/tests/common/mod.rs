//! The sled of the paper, and where it goes by our own stepper: what the adapters are compared with.

use guen::prelude::*;

guen::mechanical_system! {
    /// Chaplygin's sled on a plane inclined by `incline`, with a thruster along the blade.
    pub system Sled {
        constants   { m > 0, alpha, k > 0, c >= 0, incline, g = 9.81 }
        inputs      { push }
        coordinates { phi, x, y }
        parameters  { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
        constraints { blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }
        let centre = vec(x + alpha*cos(phi), y + alpha*sin(phi));
        kinetic_energy = m/2*inner(dot(centre), dot(centre)) + m/2*k^2*turning^2;
        force_function = m*g*sin(incline)*(x + alpha*cos(phi));
        forces { push - c*speed along speed; -c*turning along turning; }
        provide carried;
    }
}

/// The prepared system, its input, where it begins and how long it runs; `c` is the drag.
pub fn case(c: f64) -> (sled::Prepared, sled::Inputs, [f64; 5], f64) {
    let system = Sled { m: 1.5, alpha: 0.3, k: 0.5, c, incline: 0.2, g: 9.81 }.prepare().unwrap();
    let start = sled::State { phi: 0.4, turning: 1.2, speed: 0.5, ..Default::default() };
    (system, sled::Inputs { push: 0.7 }, start.into(), 3.0)
}

/// The end by our own DOP853 at the accuracy of `f64`.
pub fn end(c: f64) -> [f64; 5] {
    let (system, inputs, start, span) = case(c);
    let method = Dop853::new(1e-13, 1e-13);
    method
        .integrate(&system.driven(inputs), 0.0, &start, span, |_, _| ControlFlow::Continue(()))
        .unwrap()
        .state
}

/// The largest distance of two states.
pub fn distance(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).fold(0.0, |most, (x, y)| most.max((x - y).abs()))
}
