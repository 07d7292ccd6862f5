//! A sled that is steered while it runs.

use core::ops::ControlFlow;
use guen::prelude::{Dop853, Rk4, System};

guen::mechanical_system! {
    /// A sled with a blade, and a moment that steers it.
    pub system Sled {
        constants { m > 0, k > 0, alpha = k/2, drag = 0.1 }
        inputs { moment }
        coordinates { phi, x, y }
        parameters { turning = dot(phi); speed = dot(x)*cos(phi) + dot(y)*sin(phi); }
        constraints { blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }
        kinetic_energy = m/2*(dot(x + alpha*cos(phi))^2 + dot(y + alpha*sin(phi))^2) + m/2*k^2*turning^2;
        forces { moment along turning; -drag*sqrt(1 + speed^2)*speed along speed; }
    }
}

/// The heading after some time, or a number that is none where the run fails.
pub fn heading(seconds: f64) -> f64 {
    let start = sled::State { speed: 1.0, ..Default::default() };
    let Ok(system) = Sled::new(2.0, 0.4).prepare() else { return f64::NAN };
    let steered = system.driven(sled::Inputs { moment: 0.3 });
    let rate = steered.rhs(0.0, &start.into());
    let adaptive = Dop853::new(1e-12, 1e-12)
        .integrate(&steered, 0.0, &start.into(), seconds, |_, _| ControlFlow::Continue(()));
    let fixed =
        Rk4::new(0.001).integrate(&steered, 0.0, &start.into(), seconds, |_, _| ControlFlow::Continue(()));
    match (adaptive, fixed) {
        (Ok(one), Ok(other)) if (one.state[0] - other.state[0]).abs() < 1e-9 && rate[3] > 0.0 => one.state[0],
        _ => f64::NAN,
    }
}
