//! The rattleback of Kane and Levinson (1982). Their results are curves; the digits come from an independent integration of the
//! vector equations in 30 digits, of which nine agree between two step sizes.

use super::close;
use guen::prelude::*;

rattleback!(guen::mechanical_system);

/// The stone with the published constants.
pub(super) fn stone() -> rattleback::Prepared {
    let system = Rattleback {
        m: 1.0,
        a: 0.2,
        b: 0.03,
        c: 0.02,
        h: 0.01,
        A: 0.0002,
        B: 0.0016,
        C: 0.0017,
        D: -0.00002,
        g: 9.81,
    };
    system.prepare().unwrap()
}

/// The published start.
pub(super) fn start() -> rattleback::State {
    let half_degree = 0.5_f64.to_radians();
    rattleback::State { roll: half_degree, pitch: half_degree, spin_z: -5.0, ..Default::default() }
}

#[test]
fn rattleback_turns_back_as_computed_from_its_vector_equations() {
    let (system, start) = (stone(), start());
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-13, 1e-13), 5.0);
    let end: rattleback::State = end.unwrap().state.into();
    let angles = [-0.0469311349, 0.0144529744, -2.7501613135];
    close("angles", &[end.roll, end.pitch, end.yaw], &angles, 1.0, 2e-9);
    let spin = [-2.197841109, -1.745175997, 4.164246046];
    close("spin", &[end.spin_x, end.spin_y, end.spin_z], &spin, 1.0, 2e-9);
}
