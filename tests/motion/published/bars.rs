//! The N-four-bar mechanism of the IFToMM library of multibody benchmarks (A02) with two loops: three uprights and two bars that join their
//! tips, each a uniform rod of one metre and one kilogramme. The tips start upright at 1 m/s. The bars stay parallel to the ground, so that
//! `3 a'' = -3.5 g cos a` for the angle of the uprights. Where all rods lie in one line the mechanism may fold, and the rank of its equations drops.

use guen::Cause;
use guen::prelude::*;

use super::close;

guen::mechanical_system! {
    /// In the angles of all rods.
    pub system Bars {
        constants { g = 9.81 }
        coordinates { a0, a1, a2, b1, b2 }
        let tip0 = rot_z(a0).x;
        let tip1 = vec(1, 0) + rot_z(a1).x;
        let tip2 = vec(2, 0) + rot_z(a2).x;
        bodies {
            upright0 { mass: 1, inertia: diag(0, 0, 1/12), center: tip0/2, orientation: rot_z(a0) }
            upright1 { mass: 1, inertia: diag(0, 0, 1/12), center: vec(1, 0) + rot_z(a1).x/2, orientation: rot_z(a1) }
            upright2 { mass: 1, inertia: diag(0, 0, 1/12), center: vec(2, 0) + rot_z(a2).x/2, orientation: rot_z(a2) }
            bar1 { mass: 1, inertia: diag(0, 0, 1/12), center: tip0 + rot_z(b1).x/2, orientation: rot_z(b1) }
            bar2 { mass: 1, inertia: diag(0, 0, 1/12), center: tip1 + rot_z(b2).x/2, orientation: rot_z(b2) }
        }
        gravity = vec(0, -g);
        parameters { turn = dot(a0); }
        holonomic { left: tip0 + rot_z(b1).x = tip1; right: tip1 + rot_z(b2).x = tip2; }
    }
}

guen::mechanical_system! {
    /// With bars that stay parallel to the ground: one angle.
    pub system Parallel {
        constants { g = 9.81 }
        coordinates { a }
        let R = rot_z(a);
        bodies {
            upright0 { mass: 1, inertia: diag(0, 0, 1/12), center: R.x/2, orientation: R }
            upright1 { mass: 1, inertia: diag(0, 0, 1/12), center: vec(1, 0) + R.x/2, orientation: R }
            upright2 { mass: 1, inertia: diag(0, 0, 1/12), center: vec(2, 0) + R.x/2, orientation: R }
        }
        particles { 1 at R.x; 1 at vec(1, 0) + R.x; }
        gravity = vec(0, -g);
        parameters { turn = dot(a); }
    }
}

const UPRIGHT: f64 = core::f64::consts::FRAC_PI_2;

#[test]
fn parallel_bars_are_where_they_are_computed_to_be_after_ten_seconds() {
    let system = Parallel::default().prepare().unwrap();
    let start = parallel::State { a: UPRIGHT, turn: -1.0 };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-14, 1e-14), 10.0);
    let end: parallel::State = end.unwrap().state.into();
    let (sin, cos) = end.a.sin_cos();
    close("tip", &[cos, sin], &[0.32845811156, 0.94451853817], 1.0, 1e-10);
    close("velocity", &[-sin * end.turn, cos * end.turn], &[1.42305147026, -0.49486884554], 1.0, 1e-10);
    // Published for a step that goes to zero: right to six digits.
    close("published", &[cos, sin], &[0.3284573768, 0.9445187937], 1.0, 1e-6);
}

/// The angle of the uprights while they stay parallel.
fn angle_at(time: f64) -> f64 {
    let system = Parallel::default().prepare().unwrap();
    let start = parallel::State { a: UPRIGHT, turn: -1.0 };
    Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-13, 1e-13), time).unwrap().state[0]
}

#[test]
fn bars_in_all_angles_run_to_the_first_fold_and_say_which_bars_lie_in_line() {
    let system = Bars::default().prepare().unwrap();
    let start = bars::State { a0: UPRIGHT, a1: UPRIGHT, a2: UPRIGHT, turn: -1.0, ..Default::default() };
    let entries: [f64; 6] = start.into();
    let method = Dop853::new(1e-13, 1e-13);
    // 0.03 s before the fold.
    let before = Integration::new(&system, 0.0, &entries).run(&method, 0.68).unwrap().state;
    let angle = angle_at(0.68);
    close("angles", &before[..5], &[angle, angle, angle, 0.0, 0.0], 1.0, 1e-11);
    let error = Integration::new(&system, 0.0, &entries).run(&method, 10.0).unwrap_err();
    let Cause::ChartSingularity { found, function, .. } = error.cause else { panic!("{error:?}") };
    assert!(["-sin(a1 - b1)", "-sin(a2 - b2)"].contains(&bars::DOMAIN[function]), "{error:?}");
    // All rods lie on the ground.
    assert!(error.time <= found && angle_at(error.time).abs() < 1e-6, "{error:?}");
    // A simulation says it in words.
    let text = system.simulate(&start, 0.0..10.0).unwrap_err().to_string();
    assert!(text.contains("the edge of the chart: `-sin(a1 - b1)` must not vanish"), "{text}");
}
