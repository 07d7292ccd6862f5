//! The method: against the reference trajectories, its order, what the driver asks of it, and what it refuses.

use std::cell::Cell;

use guen::prelude::*;
use guen::steppers::Outcome;
use guen::{Dual, Lift, Setting, mechanical_system, projected};

use guen_study::Digits71;

hoop!(guen::mechanical_system; provide taylor;);

fn prepared<R: Real>() -> hoop::Prepared<R> {
    let of = R::from_ratio;
    Hoop { a: of(1, 1), A: of(1, 2), C: of(1, 1), g: of(981, 100) }.prepare().unwrap()
}

/// Times and states of the first case of a reference, whose numbers are texts.
fn reference() -> Vec<(f64, [f64; 9])> {
    let file: serde_json::Value =
        serde_json::from_str(include_str!("../../data/01_hoop_rolling.json")).unwrap();
    let case = &file["cases"][0];
    let number = |value: &serde_json::Value| -> f64 { value.as_str().unwrap().parse().unwrap() };
    let times = case["times"].as_array().unwrap().iter();
    let states = case["states"].as_array().unwrap().iter();
    times
        .zip(states)
        .map(|(time, state)| (number(time), std::array::from_fn(|i| number(&state[i]))))
        .collect()
}

fn off<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_hoop_is_where_the_reference_is() {
    let reference: Vec<_> = reference().into_iter().filter(|(t, _)| *t <= 10.0).collect();
    let times: Vec<f64> = reference.iter().map(|(t, _)| *t).collect();
    for (tolerance, bound) in [(1e-4, 1e-2), (1e-8, 1e-6), (1e-12, 3e-11), (1e-15, 3e-14)] {
        // Landed on, and between the steps.
        let (mut landed, mut between) = (0.0_f64, 0.0_f64);
        let method = Taylor::new(tolerance, tolerance);
        method
            .sample(&prepared(), 0.0, &reference[0].1, &times, |k, _, x| {
                landed = landed.max(off(x, &reference[k].1));
            })
            .unwrap();
        Integration::new(&prepared(), 0.0, &reference[0].1)
            .sample(&times, &mut |k, _, x| between = between.max(off(x, &reference[k].1)))
            .run(&method, 10.0)
            .unwrap();
        println!("{tolerance:e}: {landed:.1e}, {between:.1e}");
        assert!(landed < bound && between < bound, "{tolerance:e}: {landed:e}, {between:e}");
    }
}

#[test]
fn forwards_and_back_again() {
    let start = reference()[0].1;
    let method = Taylor::new(1e-15, 1e-15);
    let there = Integration::new(&prepared(), 0.0, &start).run(&method, 3.0).unwrap();
    let back = Integration::new(&prepared(), 3.0, &there.state).run(&method, 0.0).unwrap();
    assert!(off(&back.state, &start) < 1e-13, "{:e}", off(&back.state, &start));
}

#[test]
fn the_hoop_that_falls_nearly_flat() {
    let reference: Vec<(f64, [f64; 9])> = include_str!("../../data/falling_hoop.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let numbers: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            (numbers[0], std::array::from_fn(|i| numbers[i + 1]))
        })
        .collect();
    let times: Vec<f64> = reference.iter().map(|(t, _)| *t).collect();
    let (mut worst, mut lowest) = (0.0_f64, f64::INFINITY);
    Integration::new(&prepared(), 0.0, &reference[0].1)
        .sample(&times, &mut |k, _, x| {
            let exact = &reference[k].1;
            let largest = exact.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            worst = worst.max(off(x, exact) / largest);
        })
        .observe(&mut |_, x| {
            lowest = lowest.min(x[0].sin());
            ControlFlow::Continue(())
        })
        .run(&Taylor::new(1e-14, 1e-14), 1.0)
        .unwrap();
    println!("worst {worst:.1e} of the largest entry, lowest tilt of a step {lowest:.2e}");
    assert!(worst < 1e-12 && lowest < 6e-4, "{worst:e}, {lowest:e}");
}

#[test]
fn the_energy_of_a_long_run_stays_at_rounding() {
    let (system, long) = (prepared::<f64>(), prepared::<Digits71>());
    let start = reference()[0].1;
    // In 71 digits: evaluated in doubles the energy itself would be off by more.
    let energy = |t: f64, x: &[f64; 9]| {
        long.energy(Digits71::from_f64(t), &hoop::State::from(x.map(Digits71::from_f64)))
    };
    let first = energy(0.0, &start);
    let (mut worst, mut steps) = (0.0_f64, 0);
    Taylor::new(1e-16, 1e-16)
        .with_order(24)
        .integrate(&system, 0.0, &start, 300.0, |t, x| {
            steps += 1;
            if steps % 16 == 0 {
                worst = worst.max(((energy(t, x) - first) / first).abs().to_f64());
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    println!("{steps} steps, {worst:.1e}");
    // Measured 8e-16 and 1.4e-15 with steps that differ by some parts in a thousand: a random walk of the rates' rounding.
    assert!(worst < 3e-15, "{worst:e}");
}

#[test]
fn errors_fall_as_the_power_of_the_step() {
    let start = reference()[0].1.map(Digits71::from_f64);
    let system = prepared::<Digits71>();
    let run = |tolerance: f64, order: u32| {
        let end = Digits71::from_ratio(3, 4);
        Integration::new(&system, Digits71::zero(), &start)
            .run(&Taylor::new(tolerance, tolerance).with_order(order), end)
            .unwrap()
    };
    let exact = run(1e-40, 32).state;
    for order in [4, 7, 12, 21] {
        let digits = 0.8 * f64::from(order);
        let (coarse, fine) =
            (run(10f64.powf(-digits), order), run(10f64.powf(-digits - 0.5 * f64::from(order)), order));
        let error = |done: &IntegrationResult<Digits71, 9>| {
            done.state.iter().zip(&exact).map(|(a, b)| (*a - *b).abs().to_f64()).fold(0.0, f64::max)
        };
        let steps = fine.statistics.accepted as f64 / coarse.statistics.accepted as f64;
        let measured = (error(&coarse) / error(&fine)).log10() / steps.log10();
        println!("order {order}: {measured:.2} from {:e} and {:e}", error(&coarse), error(&fine));
        assert!((measured - f64::from(order)).abs() < 0.12 * f64::from(order), "{order}: {measured}");
    }
}

#[test]
fn single_precision_and_duals() {
    let reference = reference();
    let single = Hoop::<f32> { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    let start = reference[0].1.map(|x| x as f32);
    let done = Integration::new(&single, 0.0, &start).run(&Taylor::new(1e-6, 1e-6), 10.0).unwrap();
    let end = reference.iter().find(|(t, _)| *t == 10.0).unwrap().1;
    assert!(off(&done.state.map(f64::from), &end) < 1e-4, "{:e}", off(&done.state.map(f64::from), &end));

    // The derivative of the end by the initial spin, against a difference.
    type D = Dual<f64, 1>;
    let method = Taylor::<D>::new(1e-13, 1e-13);
    let lifted: hoop::Prepared<D> = prepared::<f64>().lift();
    let mut begin = reference[0].1.map(<D as Lift<f64>>::lift);
    begin[8].tangent[0] = 1.0;
    let done = Integration::new(&lifted, D::zero(), &begin).run(&method, D::one()).unwrap();
    let at = |spin: f64| {
        let mut begin = reference[0].1;
        begin[8] += spin;
        Integration::new(&prepared(), 0.0, &begin).run(&Taylor::new(1e-14, 1e-14), 1.0).unwrap().state
    };
    let (ahead, behind) = (at(1e-5), at(-1e-5));
    for i in 0..9 {
        let difference = (ahead[i] - behind[i]) / 2e-5;
        assert!(
            (done.state[i].tangent[0] - difference).abs() < 1e-7,
            "{i}: {:?} {difference}",
            done.state[i]
        );
    }
}

mechanical_system! {
    /// A point on a circle, in Cartesian coordinates.
    system Pendulum {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { x, y }
        particles { m at vec(x, y); }
        gravity = vec(0, -g);
        parameters { omega = (x*dot(y) - y*dot(x))/l^2; }
        holonomic { rod: x^2 + y^2 = l^2; }
        provide taylor;
    }
}

#[test]
fn constraints_on_positions_are_put_back() {
    let system = Pendulum { m: 1.0, l: 1.0, g: 9.81 }.prepare().unwrap();
    let begin = [0.6, -0.8, 0.0];
    let largest = |restored: bool| {
        let worst = Cell::new(0.0_f64);
        let seen = |t: f64, x: &[f64; 3]| {
            worst.set(worst.get().max(system.residual(t, x)));
            ControlFlow::Continue(())
        };
        let method = Taylor::new(1e-5, 1e-5);
        if restored {
            method.integrate(&projected(&system), 0.0, &begin, 20.0, seen).unwrap();
        } else {
            method.integrate(&system, 0.0, &begin, 20.0, seen).unwrap();
        }
        worst.get()
    };
    assert!(largest(true) < 1e-15 && largest(false) > 1e-9, "{:e} {:e}", largest(true), largest(false));
}

mechanical_system! {
    /// A stone: its series ends.
    system Stone {
        constants { g = 9.81 }
        coordinates { z }
        parameters { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = g*z;
        provide taylor;
    }
}

#[test]
fn events_observers_and_motions_that_are_polynomials() {
    let stone = Stone { g: 9.81 }.prepare().unwrap();
    let height = |_t: f64, x: &[f64; 2]| x[0];
    let mut steps = 0;
    let done = Integration::new(&stone, 0.0, &[1.0, 10.0])
        .events([Event::new(&height).direction(Direction::Falling).terminal()], &mut |_| {
            ControlFlow::Continue(())
        })
        .observe(&mut |_, _| {
            steps += 1;
            ControlFlow::Continue(())
        })
        .run(&Taylor::new(1e-12, 1e-12), 100.0)
        .unwrap();
    assert_eq!((done.outcome, done.statistics.rejected), (Outcome::Event(0), 0));
    assert!(steps < 20, "{steps}");
    let landing = (10.0 + (100.0_f64 + 2.0 * 9.81).sqrt()) / 9.81;
    assert!((done.time - landing).abs() < 1e-13, "{} {landing}", done.time);
    // No span, no step.
    let still = Integration::new(&stone, 1.0, &[0.0, 1.0]).run(&Taylor::new(1e-12, 1e-12), 1.0);
    assert_eq!(still.unwrap().statistics.accepted, 0);
}

mechanical_system! {
    /// Falls into a centre in finite time, and has a root of its distance from a wall.
    system Edges {
        constants { k }
        coordinates { r, x }
        parameters { v = dot(r); w = dot(x); }
        kinetic_energy = 1/2*(v^2 + w^2);
        forces { -1/r^2 along v; -k*sqrt(x) along w; }
        provide taylor;
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let system = Edges { k: 0.0 }.prepare().unwrap();
    let run =
        |method: Taylor, start: [f64; 4], end: f64| Integration::new(&system, 0.0, &start).run(&method, end);
    let fine = Taylor::new(1e-10, 1e-10);
    let start = [1.0, 1.0, 0.0, 0.0];
    let cause = |method: Taylor, start: [f64; 4]| run(method, start, 2.0).unwrap_err().cause;
    assert_eq!(cause(fine.with_order(1), start), Cause::Setting(Setting::Order));
    assert_eq!(cause(fine.with_order(33), start), Cause::Setting(Setting::Order));
    assert_eq!(cause(Taylor::new(0.0, 0.0), start), Cause::Setting(Setting::Tolerance));
    assert_eq!(cause(Taylor::new(f64::NAN, f64::NAN), start), Cause::Setting(Setting::Tolerance));
    assert_eq!(cause(fine.with_max_steps(3), start), Cause::TooManySteps { limit: 3 });
    assert_eq!(cause(fine, [f64::NAN, 1.0, 0.0, 0.0]), Cause::NotFinite);
    assert_eq!(cause(fine, [0.0, 1.0, 0.0, 0.0]), Cause::NotFinite);
    assert_eq!(cause(fine, [1.0, -1.0, 0.0, 0.0]), Cause::NotFinite);
    assert_eq!(cause(fine, [1.0, 0.0, 0.0, 0.0]), Cause::NotFinite);
    // From rest at distance one the fall takes pi / (2 sqrt(2)).
    let error = run(fine, start, 2.0).unwrap_err();
    let end = std::f64::consts::PI / 8.0_f64.sqrt();
    assert!(matches!(error.cause, Cause::StepUnderflow | Cause::NotFinite), "{error}");
    assert!((error.time - end).abs() < 1e-9, "{} {end}", error.time);
    assert!(error.state.iter().all(|x| x.is_finite()));
}

mechanical_system! {
    /// Pushed by a force whose series at time zero has terms at every sixth power alone.
    system Pushed {
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = 1/2*v^2;
        forces { sin(t^3) along v; }
        provide taylor;
    }
}

#[test]
fn series_with_gaps_are_no_polynomials() {
    let system = Pushed::default().prepare().unwrap();
    for start in [0.0, 1e-8, 1e-4] {
        // Of order 22 the last coefficients vanish at zero: 19 to 22, between 17 and 23.
        let run =
            |method: &Taylor| Integration::new(&system, start, &[0.0, 0.0]).run(method, 2.0).unwrap().state;
        let exact =
            Integration::new(&system, start, &[0.0, 0.0]).run(&Dop853::new(1e-14, 1e-14), 2.0).unwrap();
        for order in [16, 18, 20, 22, 24, 28] {
            let error = off(&run(&Taylor::new(1e-12, 1e-12).with_order(order)), &exact.state);
            assert!(error < 1e-10, "from {start}, order {order}: {error:e}");
        }
    }
}

#[test]
fn scales_of_time_far_from_one() {
    // The same fall in units in which a second is 10^12 or 10^-12: coefficients would overflow without a scale.
    for unit in [1e12, 1e-12] {
        let system = Stone { g: 9.81 }.prepare().unwrap();
        let done =
            Integration::new(&system, 0.0, &[0.0, unit]).run(&Taylor::new(1e-12, 1e-12), unit).unwrap();
        assert!((done.state[1] - (unit - 9.81 * unit)).abs() < 1e-14 * 10.0 * unit);
    }
    let hoop = prepared::<f64>();
    for spin in [1e6, 1e-6] {
        let start = hoop::State { theta: 1.2, eta3: spin, ..Default::default() };
        let span = 1.0 / f64::max(spin, 1.0);
        let run = |tolerance: f64, order: u32| {
            Integration::new(&hoop, 0.0, &start.into())
                .run(&Taylor::new(tolerance, tolerance).with_order(order), span)
                .unwrap()
                .state
        };
        let (one, other) = (run(1e-13, 32), run(1e-13, 16));
        let largest = one.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        assert!(off(&one, &other) < 1e-11 * largest, "{spin:e}: {:e}", off(&one, &other));
    }
}
