//! Guards: motions that reach the edge of a chart or leave their invariants end in a typed error, and what they return
//! is in order.

#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

use guen::prelude::*;

use crate::simulation::{Circle, circle};
use guen::Guarded;
use guen::steppers::Method;

hoop!(guen::mechanical_system);

/// Times and states of the hoop that falls nearly flat, from `tests/data`.
fn falling() -> Vec<(f64, [f64; 9])> {
    include_str!("../data/falling_hoop.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            (numbers[0], std::array::from_fn(|i| numbers[i + 1]))
        })
        .collect()
}

fn prepared() -> hoop::Prepared {
    Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap()
}

/// The largest error over the samples, in units of the largest entry of the state; and the smallest tilt on the way.
fn worst<M>(method: &M) -> Result<(f64, f64), IntegrationError<f64, 9>>
where
    M: Method<f64, hoop::Prepared, 9>,
{
    let reference = falling();
    let times: Vec<f64> = reference.iter().map(|(t, _)| *t).collect();
    let (mut worst, mut lowest) = (0.0_f64, f64::INFINITY);
    Integration::new(&prepared(), 0.0, &reference[0].1)
        .sample(&times, &mut |k, _, x| {
            let exact = &reference[k].1;
            let largest = exact.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            for (found, exact) in x.iter().zip(exact) {
                worst = worst.max((found - exact).abs() / largest);
            }
        })
        .observe(&mut |_, x| {
            lowest = lowest.min(x[0].sin());
            ControlFlow::Continue(())
        })
        .run(method, 1.0)?;
    Ok((worst, lowest))
}

#[test]
fn adaptive_methods_follow_the_hoop_that_falls_nearly_flat() {
    fn check<M: Method<f64, hoop::Prepared, 9>>(name: &str, method: &M) {
        let (error, lowest) = worst(method).unwrap();
        println!("{name}: worst error {error:.1e}, smallest sin(theta) of a step {lowest:.2e}");
        assert!(error < 1e-10, "{name}: {error:e}");
        // They do come down to the tilt of 4e-4, where psi' is 15,000.
        assert!(lowest < 6e-4, "{name}: {lowest:e}");
    }
    check("DOP853", &Dop853::new(1e-13, 1e-13));
    check("Tsit5", &Tsit5::new(1e-13, 1e-13));
    check("Radau 5", &Radau5::new(1e-11, 1e-11));
}

#[test]
fn fixed_steps_say_so_before_the_energy_is_lost() {
    fn check<M: Method<f64, hoop::Prepared, 9>>(name: &str, method: &M, step: f64) -> bool {
        let (system, start) = (prepared(), falling()[0].1);
        let first = system.energy(0.0, &start.into());
        let off = |x: &[f64; 9]| ((system.energy(0.0, &(*x).into()) - first) / first).abs();
        let limit = Guard::default().energy;
        match Integration::new(&system, 0.0, &start).run(method, 1.0) {
            Ok(done) => {
                println!("{name} {step}: arrives, energy off by {:.1e}", off(&done.state));
                assert!(off(&done.state) <= limit, "{name} {step}: silently wrong");
                true
            }
            Err(error) => {
                println!("{name} {step}: {error}; energy off by {:.1e}", off(&error.state));
                assert!(off(&error.state) <= limit, "{name} {step}: {:e}", off(&error.state));
                // The fall lasts until about t = 0.82: until there everything was in order, and is returned.
                assert!(error.time < 0.83 && error.state.iter().all(|x| x.is_finite()));
                assert!(
                    matches!(
                        error.cause,
                        Cause::Energy { .. }
                            | Cause::ChartSingularity { .. }
                            | Cause::ApproachingSingularity { .. }
                            | Cause::Step { .. }
                            | Cause::NotFinite
                            | Cause::NoConvergence
                    ),
                    "{:?}",
                    error.cause
                );
                false
            }
        }
    }
    let mut stopped = 0;
    for step in [1e-2, 3e-3, 1e-3, 3e-4] {
        stopped += u32::from(!check("Euler", &Euler::new(step), step));
        stopped += u32::from(!check("RK4", &Rk4::new(step), step));
        stopped += u32::from(!check("RK8", &Rk8::new(step), step));
        stopped += u32::from(!check("Gauss 4", &Gauss4::new(step), step));
        stopped += u32::from(!check("Gauss 6", &Gauss6::new(step), step));
    }
    assert!(stopped >= 15, "only {stopped} of 20 runs were stopped");
    assert!(check("RK8", &Rk8::new(1e-4), 1e-4), "a step that is short enough arrives");
}

#[test]
fn the_energy_limit_is_the_users() {
    let (system, start) = (prepared(), falling()[0].1);
    let run = |energy: f64| {
        Integration::new(&system, 0.0, &start)
            .guard(Guard { energy, every: Some(1), ..Guard::default() })
            .run(&Rk4::new(0.05), 0.5)
    };
    assert!(run(1e-2).is_ok());
    let error = run(1e-9).unwrap_err();
    let Cause::Energy { found, change, limit } = error.cause else { panic!("{:?}", error.cause) };
    assert!(change > 1e-9 && limit == 1e-9 && found > error.time);
    // Looked at every step: the state returned is the one before.
    assert!((found - error.time - 0.05).abs() < 1e-12);
}

#[test]
fn stepping_over_the_edge_of_the_chart_is_refused() {
    // Without a turn about the vertical the hoop falls flat, through the edge of the chart, and every rate stays finite.
    let system = prepared();
    let start = hoop::State { theta: 0.5, zeta: 0.5_f64.sin(), ..Default::default() };
    let error = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-9, 1e-9), 1.0).unwrap_err();
    let Cause::ChartSingularity { found, function, distance, limit } = error.cause else {
        panic!("{:?}", error.cause)
    };
    assert_eq!(hoop::DOMAIN[function], "sin(theta)");
    assert!(distance < 0.0 && limit == 1e-8 && found > error.time);
    assert!(error.state[0] > 0.0, "the state returned is on this side");
    // With a fixed step the next step is seen to lead there, or beyond.
    let error = Integration::new(&system, 0.0, &start.into()).run(&Rk4::new(1e-3), 1.0).unwrap_err();
    let Cause::ApproachingSingularity { found, function: 0, ratio, limit } = error.cause else {
        panic!("{:?}", error.cause)
    };
    // As many steps as lie between two looks.
    assert!(ratio > limit && limit == 2.0 && found > error.time && found < error.time + 0.15);
    assert!(error.state[0] > 0.0 && error.state[0].sin() < 0.4, "{}", error.state[0]);
    // A limit of one's own stops earlier.
    let error = Integration::new(&system, 0.0, &start.into())
        .guard(Guard { singularity: 0.1, every: Some(1), ..Guard::default() })
        .run(&Dop853::new(1e-9, 1e-9), 1.0)
        .unwrap_err();
    let Cause::ChartSingularity { distance, .. } = error.cause else { panic!("{:?}", error.cause) };
    assert!(distance <= 0.1 && error.state[0].sin() > 0.1 * 0.5_f64.sin());
}

#[test]
fn what_the_observer_saw_before_a_failure_is_kept_and_in_order() {
    let (system, start) = (prepared(), falling()[0].1);
    let mut recording = guen_study::Recording::new(&hoop::State::<f64>::NAMES);
    let error = Rk4::new(1e-3).integrate(&system, 0.0, &start, 1.0, recording.observe()).unwrap_err();
    let kept = recording.iter().filter(|(t, _)| *t <= error.time).count();
    assert!(kept > 600, "{kept}");
    assert_eq!(recording.iter().find(|(t, _)| *t == error.time).unwrap().1, &error.state);
}

#[test]
fn a_residual_limit_is_watched() {
    // A start off the constraint, by less than the limit and by more.
    let system = Circle::new(1.0, 1.0).prepare().unwrap().driven(circle::Inputs::default());
    let run = |residual: f64| {
        Integration::new(&system, 0.0, &[0.0, -1.0, 3.0])
            .guard(Guard { residual, every: Some(1), ..Guard::FINITE })
            .run(&Rk4::new(0.1), 20.0)
    };
    assert!(run(1.0).is_ok());
    let error = run(1e-4).unwrap_err();
    let Cause::Residual { residual, limit, .. } = error.cause else { panic!("{:?}", error.cause) };
    assert!(residual > limit && limit == 1e-4);
    let [x, y, _] = error.state;
    // Relative to the terms: two squares of which each counts for its two factors and itself, one sum and the length.
    assert!((x * x + y * y - 1.0).abs() <= 6e-4);
    // Put back after every step there is nothing to report.
    let projected = guen::projected::<f64, _, 2, 1>(&system);
    assert!(
        Integration::new(&projected, 0.0, &[0.0, -1.0, 3.0])
            .guard(Guard { residual: 1e-12, every: Some(1), ..Guard::default() })
            .run(&Rk4::new(0.1), 20.0)
            .is_ok()
    );
}

#[test]
fn a_start_that_is_not_finite_is_called_that() {
    let system = prepared();
    for start in [[f64::NAN; 9], [f64::INFINITY; 9]] {
        let go_on = |_: f64, _: &[f64; 9]| ControlFlow::Continue(());
        let fixed = Rk4::new(1e-3).integrate(&system, 2.0, &start, 3.0, go_on).unwrap_err();
        let adaptive = Dop853::new(1e-9, 1e-9).integrate(&system, 2.0, &start, 3.0, go_on).unwrap_err();
        let implicit = Gauss6::new(1e-3).integrate(&system, 2.0, &start, 3.0, go_on).unwrap_err();
        let sampled = Rk8::new(1e-3).sample(&system, 2.0, &start, &[3.0], |_, _, _| ()).unwrap_err();
        for error in [fixed, adaptive, sampled] {
            assert_eq!((error.cause, error.time), (Cause::NotFinite, 2.0));
        }
        assert!(matches!(implicit.cause, Cause::NotFinite | Cause::NoConvergence));
    }
}

/// A tilt next to pi consists of roundings: how many are left is what is compared, and not the sine itself.
#[test]
fn the_distance_from_the_edge_counts_roundings() {
    let system = prepared();
    let run = |theta: f64, edge: f64| {
        let start = hoop::State { theta, zeta: theta.sin(), eta3: -1.0, ..Default::default() };
        let guard = Guard { singularity: edge, every: Some(1), ..Guard::FINITE };
        let run =
            Integration::new(&system, 0.0, &start.into()).guard(guard).run(&Dop853::new(1e-9, 1e-9), 1e-6);
        run.map_err(|error| error.cause)
    };
    let near = std::f64::consts::PI - 1e-9;
    let Err(Cause::ChartSingularity { distance, limit, found, .. }) = run(near, 1e-8) else {
        panic!("{:?}", run(near, 1e-8))
    };
    assert!(distance > 0.0 && distance < limit && limit == 1e-8 && found == 0.0, "{distance:e}");
    assert!(run(near, 1e-12).is_ok());
    // As far from zero there are all digits.
    assert!(run(1e-9, 1e-8).is_ok());
}

/// The sled whose mass matrix has `gamma^2 - beta^2` of 1e-14 left.
#[test]
fn a_condition_limit_is_watched() {
    let sled =
        guen_benchmarks::systems::Sled { m: 1.5, alpha: 6e-8, beta: 1.0, k: 8e-8, incline: 0.4, g: 9.81 };
    let system = sled.prepare().unwrap();
    let run = |condition: f64| {
        Integration::new(&system, 0.0, &[0.3, 0.0, 0.0, 0.1, 0.2])
            .guard(Guard { condition, ..Guard::default() })
            .run(&Dop853::new(1e-9, 1e-9), 1e-9)
            .map_err(|error| error.cause)
    };
    let Err(Cause::Condition { condition, limit, .. }) = run(1e12) else { panic!("{:?}", run(1e12)) };
    // gamma^2/(gamma^2 - beta^2)
    assert!((condition * 1e-14 - 1.0).abs() < 0.1 && limit == 1e12, "{condition:e}");
    assert!(!matches!(run(1e15), Err(Cause::Condition { .. })));
}

/// What looks cost is counted for the system, and decides how often a run looks.
#[test]
fn looks_have_a_price() {
    let hoop = prepared();
    let costs = Guarded::<f64, 9>::check_costs(&hoop);
    // The edge is a sine; a right-hand side has two, and 24 operations.
    assert!(costs.singularities > 0.2 && costs.singularities < 3.0, "{costs:?}");
    assert!(f64::from(costs.all) > costs.singularities, "{costs:?}");
    // Without an edge there is nothing to ask for.
    let free = Free { m: 1.0 }.prepare().unwrap();
    assert_eq!(Guarded::<f64, 2>::check_costs(&free).singularities, 0.0);
}

guen::mechanical_system! {
    /// A mass that nothing moves.
    system Free {
        constants { m > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
    }
}
