//! Motions through positions where the equations break down: guards stop them there, or let them pass if they are told to.

use std::f64::consts::FRAC_PI_2;

use guen::prelude::*;
use guen::steppers::Method;
use guen::{Projected, mechanical_system, projected};

mechanical_system! {
    /// Four equal bars, one of them the ground: whenever the crank lies along it, the others could fold.
    system Bars {
        constants { m = 1, g = 9.81 }
        coordinates { q1, q2, q3 }
        let crank = rot_z(q1).x;
        let coupler = rot_z(q2).x;
        let rocker = rot_z(q3).x;
        bodies {
            one { mass: m, inertia: diag(0, 0, m/12), center: crank/2, orientation: rot_z(q1) }
            two { mass: m, inertia: diag(0, 0, m/12), center: crank + coupler/2, orientation: rot_z(q2) }
            three { mass: m, inertia: diag(0, 0, m/12), center: vec(1, 0) + rocker/2, orientation: rot_z(q3) }
        }
        gravity = vec(0, -g);
        parameters { turn = dot(q1); }
        holonomic { closure: crank + coupler = vec(1, 0) + rocker; }
        provide taylor;
    }
}

type Closed = Projected<bars::Prepared, 3, 2>;

/// Upright, turning at this rate.
fn upright(turn: f64) -> [f64; 4] {
    [FRAC_PI_2, 0.0, FRAC_PI_2, turn]
}

fn closed(g: f64) -> Closed {
    projected(Bars { g, ..Bars::new() }.prepare().unwrap())
}

/// Runs a check with methods that can be set to about 1e-6.
macro_rules! with_methods {
    ($check:ident) => {
        $check("RK4", &Rk4::new(0.01));
        $check("RK8", &Rk8::new(0.04));
        $check("DOP853", &Dop853::new(1e-6, 1e-6));
        $check("DOP853, 1e-9", &Dop853::new(1e-9, 1e-9));
        $check("Tsit5", &Tsit5::new(1e-6, 1e-6));
        $check("Taylor", &Taylor::new(1e-6, 1e-6));
    };
}

/// Runs from upright until the guard ends it, and returns how far the crank has turned by then.
fn turned<M: Method<f64, Closed, 4>>(name: &str, method: &M, turn: f64, guard: Guard) -> f64 {
    let start = upright(turn);
    let run = Integration::new(&closed(9.81), 0.0, &start).guard(guard).run(method, 20.0);
    let error = run.expect_err(name);
    assert!(
        matches!(error.cause, Cause::ChartSingularity { .. } | Cause::ApproachingSingularity { .. }),
        "{name}: {error}"
    );
    (error.state[0] - start[0]).abs()
}

#[test]
fn a_linkage_is_stopped_before_its_bars_come_to_lie_on_one_line() {
    fn check<M: Method<f64, Closed, 4>>(name: &str, method: &M) {
        for turn in [6.0, 1.0, -0.3] {
            let closely = Guard { every: Some(1), ..Guard::default() };
            let angle = turned(name, method, turn, closely);
            assert!(angle < FRAC_PI_2, "{name}, {turn}: {angle}");
        }
    }
    with_methods!(check);
    check("Gauss 6", &Gauss6::new(0.02));
    check("Radau 5", &Radau5::new(1e-6, 1e-6));
}

#[test]
fn it_passes_if_the_edge_is_not_watched_and_everything_else_still_is() {
    // Without the implicit methods, whose equations may have no solution in such a place.
    fn check<M: Method<f64, Closed, 4>>(name: &str, method: &M) {
        let (system, start) = (closed(9.81), upright(6.0));
        let pass = Guard { singularity: -1.0, ..Guard::default() };
        let (mut passed, mut side) = (0, 1.0);
        let done = Integration::new(&system, 0.0, &start)
            .guard(pass)
            .observe(&mut |_, x| {
                let now = x[0].sin().signum();
                passed += i32::from(now != side);
                side = now;
                // The bars stay parallel.
                assert!((x[2] - x[0]).sin().abs() < 1e-3 && x[1].sin().abs() < 1e-3, "{name}: {x:?}");
                ControlFlow::Continue(())
            })
            .run(method, 5.0)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(done.outcome == Outcome::Arrived && passed >= 10, "{name}: {passed}");
        let impossible = Guard { energy: 1e-16, ..pass };
        let run = Integration::new(&system, 0.0, &start).guard(impossible).run(method, 5.0);
        assert!(matches!(run.unwrap_err().cause, Cause::Energy { .. }), "{name}");
    }
    with_methods!(check);
}

/// A function that vanishes twice between two looks at everything, for a system that says so by hand.
struct Swing {
    cost: f64,
}

impl System<f64, 2> for Swing {
    fn rhs(&self, _: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        [v, -x]
    }

    fn guarded(&self) -> impl guen::Guarded<f64, 2> {
        self
    }
}

impl guen::Guarded<f64, 2> for Swing {
    fn singularities(
        &self,
        _: guen::RunningError<f64>,
        state: &[guen::RunningError<f64>; 2],
        values: &mut [guen::RunningError<f64>],
    ) -> usize {
        // Zero where x is -0.9, twice within a tenth of a turn.
        values[0] = state[0] + guen::RunningError::once(0.9);
        1
    }

    fn check_costs(&self) -> guen::CheckCosts {
        guen::CheckCosts { singularities: self.cost, ..Default::default() }
    }
}

#[test]
fn what_is_cheap_to_look_at_is_looked_at_in_every_step() {
    // Of so cheap a function every step.
    for cost in [0.01, 0.05] {
        for tolerance in [1e-9, 1e-12] {
            let run = Integration::new(&Swing { cost }, 0.0, &[1.0, 0.0])
                .run(&Dop853::new(tolerance, tolerance), 100.0);
            let error = run.unwrap_err();
            assert!(
                matches!(error.cause, Cause::ChartSingularity { .. }) && error.time < 3.0,
                "{cost} {tolerance:e}: {error}"
            );
        }
    }
}

mechanical_system! {
    /// Two particles beside each other on a blade that moves over a table which turns: their mass may not be minus a half, wherever the table is.
    system OnTable {
        constants { m = 2, J = 1/2, om = 0.7 }
        coordinates { x, y, phi }
        let table = rot_z(om*t);
        let place = table*vec(x, y, 0);
        let ahead = table*vec(cos(phi), sin(phi), 0);
        let aside = table*vec(-sin(phi), cos(phi), 0);
        particles { m at place; 1/2 at place; }
        kinetic_energy = J/2*dot(phi)^2;
        constraints { blade: inner(dot(place), aside) = 0; }
        parameters { v = inner(dot(place), ahead); w = dot(phi); }
    }
}

/// A function of the domain in which the angle of the table cancels is a constant: it has no roundings that grow with the angle.
#[test]
fn a_constant_on_a_turning_table_is_none_of_time() {
    assert!(on_table::DOMAIN.is_empty(), "{:?}", on_table::DOMAIN);
    let start = on_table::State { x: 0.3, y: -0.2, phi: 0.5, v: 0.4, w: -0.3 };
    let table = OnTable::new().prepare().unwrap();
    // After whole turns it stands as it did.
    let run = |t: f64| table.simulate(&start, t..t + 1.0).unwrap().end();
    let turn = 2.0 * std::f64::consts::PI / 0.7;
    let (first, late) = (run(0.0), run((1.7e9 / turn).round() * turn));
    assert!((first.x - late.x).abs() + (first.y - late.y).abs() < 1e-5, "{first:?} {late:?}");
    assert!(OnTable { m: -0.5, ..OnTable::new() }.prepare().is_err());
}
