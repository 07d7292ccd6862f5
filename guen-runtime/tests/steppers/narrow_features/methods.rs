//! The methods that are asked, lanes and bounded work among them.

use guen_runtime::Generic;
use guen_runtime::lanes::{LaneTask, Lanes, Width, dispatch};
use guen_runtime::prelude::*;
use guen_runtime::steppers::{Bounded, Method};

use super::{END, Expanded, Hidden, PERIOD, START};

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fate {
    Right,
    Refused,
    Wrong(f64),
}

/// What became of a run that ended at this state, if it did.
fn fate(state: Option<[f64; 2]>, exact: &[f64; 2], allowed: f64) -> Fate {
    let Some(state) = state else { return Fate::Refused };
    let off = (state[0] - exact[0]).abs().max((state[1] - exact[1]).abs());
    if off <= allowed { Fate::Right } else { Fate::Wrong(off) }
}

fn end<M: Method<f64, Expanded, 2>>(method: &M, system: &Expanded) -> Option<[f64; 2]> {
    Integration::new(system, 0.0, &START).run(method, END).ok().map(|done| done.state)
}

/// Bounded work: refused where nothing is known of the error, and right where it is within its bound.
fn bounded(work: &Bounded, system: &Expanded, exact: &[f64; 2], allowed: f64) -> Fate {
    let done = work.advance(system, 0.0, &START, PERIOD);
    let Some((state, bound)) = done.ok().and_then(|done| Some((done.state, done.error?))) else {
        return Fate::Refused;
    };
    let off = [0, 1].map(|i| (state[i] - exact[i]).abs());
    let beyond = [0, 1].map(|i| off[i] - bound[i]);
    if beyond[0].max(beyond[1]) <= allowed { Fate::Right } else { Fate::Wrong(off[0].max(off[1])) }
}

/// Four motions in lanes, the first of which is that of the other methods.
struct InLanes {
    of: Generic<Hidden>,
    step: f64,
    /// By RK8 in place of RK4.
    eight: bool,
}

fn start(lane: usize) -> [f64; 2] {
    let apart = 0.02 * lane as f64;
    [START[0] - apart, START[1] + apart]
}

impl LaneTask for InLanes {
    /// The end of the first.
    type Output = Option<[f64; 2]>;

    /// Runs them, and each alone: what happens in a lane is to be what happens alone, to the bit.
    fn run<L: Lanes>(self) -> Self::Output {
        let Self { of, step, eight } = self;
        let state = [0, 1].map(|i| L::from_fn(|lane| start(lane)[i]));
        let ends = if eight {
            Rk8::new(step).integrate_in_lanes(&of, 0.0, &state, END)
        } else {
            Rk4::new(step).integrate_in_lanes(&of, 0.0, &state, END)
        };
        for lane in 0..L::COUNT {
            let run = Integration::new(&of, 0.0, &start(lane));
            let alone = if eight { run.run(&Rk8::new(step), END) } else { run.run(&Rk4::new(step), END) };
            match (ends.lane(lane).expect("a lane"), alone) {
                (Ok(here), Ok(alone)) => assert_eq!(here.state, alone.state),
                (Err(here), Err(alone)) => assert_eq!((here.cause, here.time), (alone.cause, alone.time)),
                (here, alone) => panic!("{here:?} in lane {lane}, {alone:?} alone"),
            }
        }
        ends.lane(0)?.as_ref().ok().map(|done| done.state)
    }
}

/// The methods, with the longest step that each makes of the oscillator alone, and the error that counts as right.
pub const METHODS: [(&str, f64, f64); 15] = [
    ("euler", 0.01, 6e-2),
    ("rk4", 0.05, 1e-5),
    ("rk4 in lanes", 0.05, 1e-5),
    ("rk8", 0.2, 1e-7),
    ("rk8 in lanes", 0.2, 1e-7),
    ("gauss4", 0.05, 1e-5),
    ("gauss6", 0.1, 1e-6),
    ("tsit5 1e-6", 0.25, 1e-3),
    ("tsit5 1e-9", 0.06, 1e-6),
    ("dop853 1e-9", 0.55, 1e-6),
    ("radau5 1e-8", 0.2, 1e-5),
    ("taylor 1e-8", 1.6, 1e-5),
    ("taylor 1e-15", 2.0, 1e-9),
    // Of the reference's error.
    ("bounded tsit5", 0.1, 1e-9),
    ("bounded dop853", 0.25, 1e-9),
];

/// How many methods have a fixed step, lanes among them; then come those that judge their steps, and bounded work from here on.
pub const FIXED: usize = 7;
pub const BOUNDED: usize = 13;

pub fn run(method: usize, system: &Expanded, exact: &[f64; 2]) -> Fate {
    let (name, step, allowed) = METHODS[method];
    let max = 20_000;
    let in_lanes = |eight| dispatch(Width::Four, InLanes { of: system.0, step, eight });
    let state = match name {
        "euler" => end(&Euler::new(step), system),
        "rk4" => end(&Rk4::new(step), system),
        "rk4 in lanes" => in_lanes(false),
        "rk8" => end(&Rk8::new(step), system),
        "rk8 in lanes" => in_lanes(true),
        "gauss4" => end(&Gauss4::new(step), system),
        "gauss6" => end(&Gauss6::new(step), system),
        "tsit5 1e-6" => end(&Tsit5::new(1e-6, 1e-6).with_max_steps(max), system),
        "tsit5 1e-9" => end(&Tsit5::new(1e-9, 1e-9).with_max_steps(max), system),
        "dop853 1e-9" => end(&Dop853::new(1e-9, 1e-9).with_max_steps(max), system),
        "radau5 1e-8" => end(&Radau5::new(1e-8, 1e-8).with_max_steps(max), system),
        "taylor 1e-8" => end(&Taylor::new(1e-8, 1e-8).with_max_steps(max), system),
        "taylor 1e-15" => end(&Taylor::new(1e-15, 1e-15).with_max_steps(max), system),
        // Ten steps, and four.
        "bounded tsit5" => return bounded(&Bounded::tsit5(61), system, exact, allowed),
        _ => return bounded(&Bounded::dop853(48), system, exact, allowed),
    };
    fate(state, exact, allowed)
}
