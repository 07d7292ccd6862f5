//! Permanent constraints on positions and edges of the chart in runs through modes.

use guen::hybrid::HybridCause;
use guen::mechanical_system;
use guen::steppers::Cause;

mechanical_system! {
    /// A pendulum in the plane's coordinates, with an elastic wall.
    pub system Bob {
        coordinates { x, y }
        parameters { omega = x*dot(y) - y*dot(x); }
        kinetic_energy = 1/2*(dot(x)^2 + dot(y)^2);
        potential_energy = y;
        holonomic { rod: x^2 + y^2 = 1; }
        contacts { wall: gap = x + 1/2, restitution = 1; }
    }
}

mechanical_system! {
    /// The same with a parameter that does not determine the velocity where `y = 0`.
    pub system Sideways {
        coordinates { x, y }
        parameters { u = dot(x); }
        kinetic_energy = 1/2*(dot(x)^2 + dot(y)^2);
        potential_energy = y;
        holonomic { rod: x^2 + y^2 = 1; }
        contacts { wall: gap = x + 2; }
    }
}

#[test]
fn positions_stay_on_the_permanent_constraints() {
    let system = Bob::default().prepare().unwrap();
    let start = bob::State { x: 0.6, y: -0.8, omega: 0.0 };
    // With loose tolerances it would drift away by 1e-3.
    let motion = system.simulation(&start).tolerance(1e-5).run(0.0..200.0).unwrap();
    assert!(motion.transitions().len() > 30, "{}", motion.transitions().len());
    for (t, state) in motion.sample(0.37) {
        let residual = state.x * state.x + state.y * state.y - 1.0;
        assert!(residual.abs() < 1e-14, "{residual:e} at {t}");
        assert!(state.x > -0.5 - 1e-9);
    }
    for transition in motion.transitions() {
        let [x, y, _] = transition.state_after;
        assert!((x + 0.5).abs() < 1e-9 && (x * x + y * y - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_start_is_put_onto_the_permanent_constraints() {
    let system = Bob::default().prepare().unwrap();
    let start = bob::State { x: 0.7, y: -0.7, omega: 0.0 };
    let motion = system.simulate(&start, 0.0..0.1).unwrap();
    let state = motion.at(0.0);
    assert!((state.x - 0.5_f64.sqrt()).abs() < 1e-15 && (state.y + 0.5_f64.sqrt()).abs() < 1e-15);
    // At the centre no way is the shortest.
    let error = system.simulate(&bob::State::default(), 0.0..0.1).unwrap_err().error;
    assert_eq!(error.cause, HybridCause::Integration(Cause::Positions));
}

#[test]
fn an_edge_of_the_chart_ends_a_run() {
    let system = Sideways::default().prepare().unwrap();
    let start = sideways::State { x: 0.0, y: -1.0, u: 1.6 };
    let error = system.simulate(&start, 0.0..10.0).unwrap_err();
    let edge = matches!(
        error.error.cause,
        HybridCause::Integration(Cause::ChartSingularity { .. } | Cause::ApproachingSingularity { .. })
    );
    assert!(edge, "{error}");
    // It is not reached before the bob is beside the pivot, and the last good state is on this side.
    assert!(error.error.state[1] < 0.0 && error.error.state[1] > -0.1, "{:?}", error.error.state);
    assert!(error.error.t > 0.6 && error.trajectory.end_time() == error.error.t);
}
