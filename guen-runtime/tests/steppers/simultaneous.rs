//! Several events at one instant, with every method: all that has happened when a run ends is reported, and a run that goes
//! on from there finds each crossing once.

use core::ops::ControlFlow;

use guen_runtime::prelude::*;
use guen_runtime::steppers::{Method, Occurrence};
use guen_runtime::{Coefficients, Differentiable, TaylorSeries};

/// Two balls that fall beside each other: heights and velocities.
struct Balls;

impl System<f64, 4> for Balls {
    fn rhs(&self, _: f64, &[_, _, v, w]: &[f64; 4]) -> [f64; 4] {
        [v, w, -9.81, -9.81]
    }
}

impl Differentiable<f64, 4> for Balls {
    fn jacobian(&self, _: f64, _: &[f64; 4]) -> [[f64; 4]; 4] {
        [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4]]
    }

    fn along(&self, _: f64, _: &[f64; 4], _: f64, &[_, _, v, w]: &[f64; 4]) -> [f64; 4] {
        [v, w, 0.0, 0.0]
    }
}

impl TaylorSeries<f64, 4> for Balls {
    const PRODUCTS: usize = 0;

    fn series(&self, _: f64, state: &[f64; 4], scale: f64, order: usize, to: &mut Coefficients<f64, 4>) {
        to[0] = *state;
        for k in 1..=order {
            let [_, _, v, w] = to[k - 1];
            let g = if k == 1 { -9.81 } else { 0.0 };
            to[k] = [v, w, g, g].map(|rate| rate * scale / k as f64);
        }
    }
}

macro_rules! with_every_method {
    ($check:ident, $($argument:expr),*) => {
        $check("Euler", &Euler::new(1e-3), $($argument),*);
        $check("RK4", &Rk4::new(0.01), $($argument),*);
        $check("RK8", &Rk8::new(0.1), $($argument),*);
        $check("DOP853", &Dop853::new(1e-9, 1e-9), $($argument),*);
        $check("Tsit5", &Tsit5::new(1e-9, 1e-9), $($argument),*);
        $check("Gauss 4", &Gauss4::new(0.02), $($argument),*);
        $check("Gauss 6", &Gauss6::new(0.05), $($argument),*);
        $check("Radau 5", &Radau5::new(1e-9, 1e-9), $($argument),*);
        $check("Taylor", &Taylor::new(1e-12, 1e-12), $($argument),*);
    };
}

/// How two balls are dropped and what bounces.
#[derive(Clone, Copy, Debug)]
struct Drop {
    heights: [f64; 2],
    direction: Direction,
    /// The second ball's event is declared first.
    swapped: bool,
    restitution: f64,
    start: f64,
}

/// Lets both balls bounce, those that are reported and no others, until `span` has passed or the first has bounced often
/// enough; returns how often each was reported.
fn bounces<M: Method<f64, Balls, 4>>(name: &str, method: &M, drop: Drop, span: f64, enough: u32) -> [u32; 2] {
    let first = |_: f64, x: &[f64; 4]| x[usize::from(drop.swapped)];
    let second = |_: f64, x: &[f64; 4]| x[usize::from(!drop.swapped)];
    let mut counts = [0; 2];
    let (mut time, mut state) = (drop.start, [drop.heights[0], drop.heights[1], 0.0, 0.0]);
    while time < drop.start + span && counts[0] < enough {
        assert!(counts[1] < 100, "{name}, {drop:?}: no end at {time}");
        let mut fired = [false; 2];
        let mut reported: Vec<Occurrence<f64, 4>> = Vec::new();
        let done = Integration::new(&Balls, time, &state)
            .events(
                [
                    Event::new(&first).direction(drop.direction).terminal(),
                    Event::new(&second).direction(drop.direction).terminal(),
                ],
                &mut |event| {
                    let ball = if drop.swapped { 1 - event.index } else { event.index };
                    assert!(!fired[ball], "{name}, {drop:?}: ball {ball} twice at {}", event.time);
                    fired[ball] = true;
                    reported.push(*event);
                    ControlFlow::Continue(())
                },
            )
            .run(method, drop.start + span)
            .unwrap();
        for event in &reported {
            assert_eq!((event.time, event.state), (done.time, done.state), "{name}, {drop:?}");
            assert!(!event.rising, "{name}, {drop:?}: a ghost at {}", event.time);
        }
        match done.outcome {
            Outcome::Event(index) => assert_eq!(index, reported[0].index, "{name}, {drop:?}"),
            _ => assert!(reported.is_empty(), "{name}, {drop:?}"),
        }
        (time, state) = (done.time, done.state);
        for ball in 0..2 {
            assert!(state[ball] > -1e-9, "{name}, {drop:?}: ball {ball} at {} after {time}", state[ball]);
            if fired[ball] {
                counts[ball] += 1;
                state[2 + ball] *= -drop.restitution;
            }
        }
    }
    counts
}

/// Equal heights, and heights that differ by less than what is resolved, by about as much, and by more.
const APART: [f64; 14] =
    [0.0, 1e-17, 1e-16, -1e-16, 2.3e-16, 1e-15, -2e-15, 4e-15, 1e-14, -1e-14, 3e-14, 1e-13, 1e-11, -1e-8];

#[test]
fn two_balls_that_land_together_both_bounce() {
    fn check<M: Method<f64, Balls, 4>>(name: &str, method: &M, height: f64) {
        for apart in APART {
            for direction in [Direction::Falling, Direction::Any] {
                for swapped in [false, true] {
                    let heights = [height, height + apart];
                    let drop = Drop { heights, direction, swapped, restitution: 1.0, start: 0.0 };
                    // At odd multiples of sqrt(2 h/g).
                    let until = 6.1 * (2.0 * height / 9.81_f64).sqrt();
                    let counts = bounces(name, method, drop, until, 4);
                    assert_eq!(counts, [3, 3], "{name}, {drop:?}");
                }
            }
        }
    }
    for height in [1.0, 0.37] {
        with_every_method!(check, height);
    }
}

#[test]
fn flights_shorter_than_a_step_are_seen_from_the_bounce_on() {
    fn check<M: Method<f64, Balls, 4>>(name: &str, method: &M, start: f64) {
        for (apart, direction) in
            [(0.0, Direction::Falling), (1e-15, Direction::Any), (0.2, Direction::Falling)]
        {
            let heights = [1.0, 1.0 + apart];
            let drop = Drop { heights, direction, swapped: false, restitution: 0.5, start };
            // The first rests after 3 sqrt(2 h/g), and somewhat later with Euler's method. Its last flight here takes a
            // thousandth of the first one.
            let counts = bounces(name, method, drop, 2.0, 11);
            assert_eq!(counts[0], 11, "{name}, {drop:?}");
            // As long as the second does not rest either.
            assert!(drop.heights[0] != drop.heights[1] || counts[1] == 11, "{name}, {drop:?}: {counts:?}");
        }
    }
    for start in [0.0, 17.3] {
        with_every_method!(check, start);
    }
}

/// `x' = 1`: the state is a clock, and every crossing of a function of it is known.
struct Clock;

impl System<f64, 1> for Clock {
    fn rhs(&self, _: f64, _: &[f64; 1]) -> [f64; 1] {
        [1.0]
    }
}

impl Differentiable<f64, 1> for Clock {
    fn jacobian(&self, _: f64, _: &[f64; 1]) -> [[f64; 1]; 1] {
        [[0.0]]
    }

    fn along(&self, _: f64, _: &[f64; 1], _: f64, _: &[f64; 1]) -> [f64; 1] {
        [0.0]
    }
}

impl TaylorSeries<f64, 1> for Clock {
    const PRODUCTS: usize = 0;

    fn series(&self, _: f64, state: &[f64; 1], scale: f64, order: usize, to: &mut Coefficients<f64, 1>) {
        to[0] = *state;
        to[1] = [scale];
        to[2..=order].fill([0.0]);
    }
}

/// A function whose crossings of zero are events.
type Function = Box<dyn Fn(f64, &[f64; 1]) -> f64>;

/// Numbers between zero and one, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Runs from event to event, every one of which ends a run, and returns the time of each crossing by its function.
fn all_crossings<M: Method<f64, Clock, 1>, const E: usize>(
    method: &M,
    functions: &[Function; E],
    terminal: impl Fn(usize) -> bool,
    end: f64,
) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    let (mut time, mut state) = (0.0, [0.0]);
    loop {
        let events = core::array::from_fn(|i| {
            let event = Event::new(&*functions[i]).direction(Direction::Falling);
            if terminal(i) { event.terminal() } else { event }
        });
        let done = Integration::<_, _, 1>::new(&Clock, time, &state)
            .events::<E>(events, &mut |event| {
                found.push((event.index, event.time));
                ControlFlow::Continue(())
            })
            .run(method, end)
            .unwrap();
        if done.outcome == Outcome::Arrived {
            return found;
        }
        assert!(done.time >= time);
        (time, state) = (done.time, done.state);
    }
}

#[test]
fn runs_from_event_to_event_find_every_crossing_once() {
    fn check<M: Method<f64, Clock, 1>>(name: &str, method: &M, seed: u64) {
        const E: usize = 40;
        let mut random = Random(seed);
        // Crossings at random, in clusters, identical ones, at the end, and at multiples of a step.
        let crossings: [f64; E] = core::array::from_fn(|i| match i {
            0..10 => 2.0 * random.next(),
            10..20 => 1.234 + 1e-15 * (random.next() - 0.5),
            20..25 => 0.75,
            25..30 => 0.5 + 1e-13 * random.next(),
            30..35 => 0.1 * (2.0 + 14.0 * random.next()).floor(),
            35 => 2.0,
            _ => 1e-9 * random.next(),
        });
        let functions: [Function; E] = core::array::from_fn(|i| {
            let (at, slope) = (crossings[i], 10.0_f64.powf(6.0 * random.next() - 3.0));
            Box::new(move |_: f64, x: &[f64; 1]| slope * (at - x[0])) as Box<_>
        });
        for terminal in [1, 2, 3] {
            let mut found = all_crossings(method, &functions, |i| i % terminal == 0, 2.0);
            assert!(found.is_sorted_by(|a, b| a.1 <= b.1), "{name}, seed {seed}: out of order");
            found.sort_by_key(|(index, _)| *index);
            let indices: Vec<usize> = found.iter().map(|(index, _)| *index).collect();
            // The state's own rounding may miss the end.
            let expected: Vec<usize> = (0..E).filter(|i| *i != 35 || indices.contains(&35)).collect();
            assert_eq!(indices, expected, "{name}, seed {seed}, every {terminal}. terminal");
            for (index, time) in found {
                assert!((time - crossings[index]).abs() < 1e-13, "{name}: {time} {}", crossings[index]);
            }
        }
    }
    for seed in [1, 2, 3] {
        with_every_method!(check, seed);
    }
}

#[test]
fn thousands_of_events_at_one_instant_are_one_set() {
    const E: usize = 2000;
    // Every third at one, every seventh of these but at 1e-15 from it; the others later, and all in any order.
    let functions: [Function; E] = core::array::from_fn(|i| {
        let at = if i % 3 == 0 { 1.0 } else { 1.0 + 1e-6 * i as f64 };
        Box::new(move |_: f64, x: &[f64; 1]| at - x[0]) as Box<_>
    });
    let mut reported = Vec::new();
    let done = Integration::<_, _, 1>::new(&Clock, 0.0, &[0.0])
        .events::<E>(core::array::from_fn(|i| Event::new(&*functions[i]).terminal()), &mut |event| {
            reported.push((event.index, event.time));
            ControlFlow::Continue(())
        })
        .run(&Rk4::new(0.3), 2.0)
        .unwrap();
    assert_eq!(done.outcome, Outcome::Event(0));
    assert_eq!(reported, (0..E).step_by(3).map(|i| (i, done.time)).collect::<Vec<_>>());
}

#[test]
fn a_receiver_that_stops_a_run_is_told_of_what_has_crossed_and_of_nothing_else() {
    let (early, late) = (|_: f64, x: &[f64; 1]| x[0] - 1.0, |_: f64, x: &[f64; 1]| x[0] - 1.5);
    let near = |_: f64, x: &[f64; 1]| x[0] - 1.0 - 1e-9;
    let mut seen = Vec::new();
    let done = Integration::<_, _, 1>::new(&Clock, 0.0, &[0.0])
        .events([Event::new(&late).terminal(), Event::new(&near), Event::new(&early)], &mut |event| {
            seen.push(event.index);
            ControlFlow::Break(())
        })
        .run(&Rk4::new(0.7), 2.0)
        .unwrap();
    assert_eq!((done.outcome, seen), (Outcome::Stopped, vec![2]));
    assert!((done.time - 1.0).abs() < 1e-15);
}

#[test]
fn a_dip_between_two_looks_is_seen_where_a_run_ends_in_it() {
    // Below zero from 0.9 to 1.1, between two looks; the other ends the run at one.
    let dip = |_: f64, x: &[f64; 1]| (x[0] - 1.0) * (x[0] - 1.0) - 0.01;
    let end = |_: f64, x: &[f64; 1]| 1.0 - x[0];
    for terminal in [false, true] {
        let mut seen = Vec::new();
        let event = Event::new(&dip).direction(Direction::Falling);
        let done = Integration::<_, _, 1>::new(&Clock, 0.0, &[0.0])
            .events(
                [Event::new(&end).terminal(), if terminal { event.terminal() } else { event }],
                &mut |event| {
                    seen.push((event.index, (10.0 * event.time).round()));
                    ControlFlow::Continue(())
                },
            )
            .run(&Rk4::new(2.0), 2.0)
            .unwrap();
        if terminal {
            assert_eq!((done.outcome, &seen[..]), (Outcome::Event(1), &[(1, 9.0)][..]));
        } else {
            assert_eq!((done.outcome, &seen[..]), (Outcome::Event(0), &[(1, 9.0), (0, 10.0)][..]));
        }
    }
}

#[test]
fn samples_at_the_instant_of_events_come_before_them_and_later_ones_not_at_all() {
    let one = |_: f64, x: &[f64; 1]| x[0] - 1.0;
    let log = core::cell::RefCell::new(Vec::new());
    Integration::<_, _, 1>::new(&Clock, 0.0, &[0.0])
        .sample(&[0.5, 1.0, 1.5], &mut |k, _, _| log.borrow_mut().push(k))
        .events([Event::new(&one).terminal(), Event::new(&one)], &mut |event| {
            log.borrow_mut().push(10 + event.index);
            ControlFlow::Continue(())
        })
        .run(&Rk4::new(0.5), 2.0)
        .unwrap();
    assert_eq!(*log.borrow(), [0, 1, 10, 11]);
}

#[test]
fn a_function_that_is_undefined_for_a_while_loses_no_crossing() {
    // No number between 0.4 and 0.6; falls through zero at 0.9.
    let gap = |_: f64, x: &[f64; 1]| if (0.4..0.6).contains(&x[0]) { f64::NAN } else { 0.9 - x[0] };
    let mut seen = Vec::new();
    Integration::<_, _, 1>::new(&Clock, 0.0, &[0.0])
        .events([Event::new(&gap).with_checks(7)], &mut |event| {
            seen.push(event.time);
            ControlFlow::Continue(())
        })
        .run(&Rk4::new(1.0), 1.0)
        .unwrap();
    assert!(seen.len() == 1 && (seen[0] - 0.9).abs() < 1e-15, "{seen:?}");
}
