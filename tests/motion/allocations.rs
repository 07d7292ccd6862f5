//! Right-hand sides and runs take no memory but their stack: every allocation of this thread is counted, and there is none.
//!
//! `tests/toolchain/panics.rs` shows the same of a library that has no allocator; here the platform's functions, the larger methods,
//! lanes and what ends in an error are counted too.

use std::hint::black_box;

use allocation_counter::measure;
use guen::prelude::*;
use guen::steppers::{Bounded, Direction, Event, Method, reversible};
use guen::{Differentiable, Dual, Guarded, TaylorSeries};

hoop! { guen::mechanical_system; provide carried, taylor; scene Tilt { track theta; provide energy, taylor; } }
robot! { guen::mechanical_system; provide taylor; }

/// Does it once, and does it again under count.
fn count(name: &str, mut work: impl FnMut()) {
    work();
    let found = measure(work);
    assert_eq!(found.count_total, 0, "{name}: {} bytes", found.bytes_total);
}

fn run<S, M, const N: usize>(name: &str, system: &S, method: &M, start: &[f64; N]) -> bool
where
    S: System<f64, N>,
    M: Method<f64, S, N>,
{
    let mut arrived = false;
    count(name, || {
        let (mut sum, mut seen, mut crossings) = (0.0, 0.0, 0);
        let first = |_t: f64, x: &[f64; N]| x[0] - 1.0;
        let done = Integration::new(system, 0.0, black_box(start))
            .sample(&[0.1, 0.25, 0.5], &mut |_, _, x| sum += x[0])
            .events([Event::new(&first).direction(Direction::Any)], &mut |_| {
                crossings += 1;
                ControlFlow::Continue(())
            })
            .observe(&mut |_, x| {
                seen += x[N - 1];
                ControlFlow::Continue(())
            })
            .run(method, 0.5);
        arrived = done.is_ok();
        let _ = black_box((sum, seen, crossings));
    });
    arrived
}

/// Every method.
fn runs<S, const N: usize>(name: &str, system: &S, start: &[f64; N])
where
    S: System<f64, N> + Differentiable<f64, N> + TaylorSeries<f64, N>,
{
    let arrived = [
        run(&format!("{name}, Euler"), system, &Euler::new(1e-3), start),
        run(&format!("{name}, RK4"), system, &Rk4::new(1e-3), start),
        run(&format!("{name}, RK4 compensated"), system, &Rk4::new(1e-3).compensated(), start),
        run(&format!("{name}, RK8"), system, &Rk8::new(1e-3), start),
        run(&format!("{name}, Gauss 4"), system, &Gauss4::new(1e-3), start),
        run(&format!("{name}, Gauss 6"), system, &Gauss6::new(1e-3), start),
        run(&format!("{name}, Tsit5"), system, &Tsit5::new(1e-9, 1e-9), start),
        run(&format!("{name}, DOP853"), system, &Dop853::new(1e-9, 1e-9), start),
        run(&format!("{name}, Radau 5"), system, &Radau5::new(1e-9, 1e-9), start),
        run(&format!("{name}, Taylor"), system, &Taylor::new(1e-9, 1e-9), start),
    ];
    assert_eq!(arrived, [true; 10], "{name}");
    count(&format!("{name}, right-hand side"), || {
        black_box(system.rhs(0.0, black_box(start)));
        black_box(system.jacobian(0.0, black_box(start)));
        let guarded = system.guarded();
        black_box(guarded.conserved(0.0, black_box(start)));
        black_box(guarded.condition(0.0, black_box(start)));
    });
    count(&format!("{name}, control period"), || {
        for method in [Bounded::dop853(48), Bounded::tsit5(25)] {
            black_box(method.advance(system, 0.0, black_box(start), 0.01).unwrap());
        }
    });
}

const HOOP: Hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
const START: hoop::State = hoop::State {
    theta: 1.1,
    eta1: 0.4,
    eta2: 0.9,
    eta3: 2.5,
    psi: 0.0,
    phi: 0.0,
    xi: 0.0,
    eta: 0.0,
    zeta: 0.9,
};

#[test]
fn a_count_sees_what_is_allocated() {
    assert!(measure(|| drop(black_box(vec![0_u8; 100]))).count_total >= 1);
}

#[test]
fn nothing_is_allocated() {
    count("preparation", || {
        black_box(black_box(HOOP).prepare().unwrap());
    });
    let hoop = HOOP.prepare().unwrap();
    runs("hoop", &hoop, &START.into());
    let tilt = hoop::Tilt::from(HOOP).prepare().unwrap();
    runs("a scene", &tilt, &hoop::tilt::State { theta: 1.1, eta1: 0.4, eta2: 0.9, eta3: 2.5 }.into());
    let robot = Robot {
        m: 10.0,
        mw: 1.0,
        h: 0.5,
        b: 0.25,
        r: 0.125,
        A: 0.5,
        B: 0.375,
        C: 0.25,
        I: 0.004,
        J: 0.008,
        g: 9.81,
    };
    let robot = robot.prepare().unwrap().driven(robot::Inputs { left_torque: 0.1, right_torque: -0.1 });
    runs("robot", &robot, &robot::State { tilt: 0.1, speed: 0.5, ..Default::default() }.into());
    let carried = hoop.carried().unwrap();
    let start = START.carried(&carried, 0.0).into();
    assert!(run("a carried form", &carried, &Rk4::new(1e-3), &start));
    assert!(run(
        "a carried form that is renormalized",
        &guen::renormalized(carried),
        &Dop853::new(1e-9, 1e-9),
        &start
    ));
}

#[test]
fn errors_are_not_allocated_either() {
    // Falls flat: at the edge of its chart, and with a step that is too long.
    let hoop = HOOP.prepare().unwrap();
    let start = hoop::State { theta: 0.3, eta1: -1.0, eta2: 1e-9, zeta: 0.3, ..Default::default() }.into();
    count("an edge", || {
        let error = Integration::new(&hoop, 0.0, black_box(&start)).run(&Rk4::new(1e-2), 10.0).unwrap_err();
        black_box(error);
    });
    count("constants", || {
        black_box(Hoop { a: -1.0, ..HOOP }.prepare().unwrap_err());
    });
    count("there and back", || {
        let method = Dop853::<Dual<f64, 9>>::new(1e-9, 1e-9);
        black_box(reversible(&hoop, &[], &method, 0.0, black_box(&START.into()), 1.0, 1e-8).unwrap());
    });
}
