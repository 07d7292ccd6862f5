//! States of thousands of numbers, in a thread with a small stack and without optimisation.

use core::ops::ControlFlow;
use std::f64::consts::PI;

use guen_runtime::steppers::{Dop853, Event, Integration, Method, Rk4, Rk8, Tsit5};
use guen_runtime::{Cause, System};

const LINKS: usize = 1000;
/// The state is the displacements, then the speeds.
const N: usize = 2 * LINKS;

/// Equal masses in a row, joined by equal springs, the first and the last to a wall.
struct Row;

impl System<f64, N> for Row {
    fn rhs(&self, _t: f64, x: &[f64; N]) -> [f64; N] {
        let mut rates = [0.0; N];
        let at = |i: usize| if (1..=LINKS).contains(&i) { x[i - 1] } else { 0.0 };
        for i in 1..=LINKS {
            rates[i - 1] = x[LINKS + i - 1];
            rates[LINKS + i - 1] = at(i - 1) - 2.0 * at(i) + at(i + 1);
        }
        rates
    }
}

/// The shape of the highest tone of the row, and its frequency.
fn tone() -> ([f64; N], f64) {
    let angle = LINKS as f64 * PI / (LINKS + 1) as f64;
    let mut shape = [0.0; N];
    for (i, entry) in shape[..LINKS].iter_mut().enumerate() {
        *entry = ((i + 1) as f64 * angle).sin();
    }
    (shape, 2.0 * (angle / 2.0).sin())
}

/// Runs with everything that is looked at on the way, and compares with the tone.
fn runs_in_two_megabytes<M: Method<f64, Row, N> + Send + 'static>(method: M, tolerance: f64) {
    let thread = std::thread::Builder::new().stack_size(2 << 20);
    let run = thread.spawn(move || {
        let (start, frequency) = tone();
        let middle = |_t: f64, x: &[f64; N]| x[LINKS / 2];
        let (mut sampled, mut crossed, mut steps) = (Vec::new(), Vec::new(), 0);
        let done = Integration::new(&Row, 0.0, &start)
            .sample(&[0.4, 0.9], &mut |_, t, x| sampled.push((t, x[LINKS / 2])))
            .observe(&mut |_, _| {
                steps += 1;
                ControlFlow::Continue(())
            })
            .events([Event::new(&middle)], &mut |event| {
                crossed.push(event.time);
                ControlFlow::Continue(())
            })
            .run(&method, 1.0)
            .unwrap();
        let shape = start[LINKS / 2];
        for (t, x) in sampled.into_iter().chain([(done.time, done.state[LINKS / 2])]) {
            assert!((x - shape * (frequency * t).cos()).abs() < tolerance, "{x} at {t}");
        }
        assert_eq!(crossed.len(), 1);
        assert!((crossed[0] - PI / 2.0 / frequency).abs() < tolerance, "crossed at {}", crossed[0]);
        assert_eq!(steps, done.statistics.accepted);
        // A failure is told in the same room.
        let failed = Integration::new(&Row, 0.0, &start).run(&method, f64::NAN).unwrap_err();
        assert!(matches!(failed.cause, Cause::Setting(_)) && failed.state == start);
    });
    run.unwrap().join().unwrap();
}

#[test]
fn steps_of_a_thousand_links_fit_in_two_megabytes() {
    runs_in_two_megabytes(Rk4::new(0.01), 1e-8);
    runs_in_two_megabytes(Rk8::new(0.05), 1e-12);
    runs_in_two_megabytes(Dop853::new(1e-12, 1e-12), 1e-11);
    runs_in_two_megabytes(Tsit5::new(1e-10, 1e-10), 1e-8);
}
