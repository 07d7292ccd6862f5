//! Units: powers of two change nothing, not a bit; other units nothing beyond the errors of the methods.

use super::growth::{allowed, growth};
use super::methods::{self, Promise, Settings, Visitor};
use super::motion::refusal;
use super::reference::Reference;
use super::systems::{Sled, sled};
use super::{Answer, Line, Task, Verdict};
use crate::both;
use guen::prelude::*;
use guen::steppers::Method;

const SPAN: f64 = 2.0;
const STEP: f64 = 1.0 / 1024.0;
/// The state in metres and seconds: heading, place, turning, speed.
const START: [f64; 5] = [0.3, 0.0, 0.0, 0.7, 0.5];

/// How long a metre, a second, a kilogram are in some units.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    time: f64,
    mass: f64,
}

impl Units {
    fn system(self) -> sled::Prepared {
        let Units { length, time, mass } = self;
        let g = 9.81 * length / (time * time);
        Sled { m: 2.0 * mass, alpha: 0.2 * length, beta: 0.3 * length, k: 0.4 * length, incline: 0.3, g }
            .prepare()
            .expect("positive constants")
    }

    /// What the entries of the state are multiplied by.
    fn factors(self) -> [f64; 5] {
        let Units { length, time, .. } = self;
        [1.0, length, length, 1.0 / time, length / time]
    }
}

/// Where a method arrived, in metres and seconds, and after how many steps.
type End = (&'static str, Promise, Result<([f64; 5], u64), Verdict>);

/// The ends of all methods.
struct Ends {
    units: Units,
    ends: Vec<End>,
}

impl Visitor<f64, sled::Prepared, 5> for Ends {
    fn visit<M: Method<f64, sled::Prepared, 5>>(&mut self, by: &'static str, promise: Promise, method: &M) {
        let factors = self.units.factors();
        let start = std::array::from_fn(|i| START[i] * factors[i]);
        let run = Integration::new(&self.units.system(), 0.0, &start).run(method, SPAN * self.units.time);
        let end = match run {
            Ok(done) => Ok((std::array::from_fn(|i| done.state[i] / factors[i]), done.statistics.accepted)),
            Err(error) => Err(refusal(&error, true)),
        };
        self.ends.push((by, promise, end));
    }
}

fn ends(units: Units) -> Ends {
    let settings = Settings { step: STEP * units.time, relative: 1e-11, absolute: 1e-20 };
    let mut ends = Ends { units, ends: Vec::new() };
    methods::all::<f64, _, _, 5>(settings, &mut ends);
    ends
}

/// The largest relative difference of the ends of a motion in two systems of units.
///
/// Adaptive methods are off by what both runs may be off by; those with a fixed step by `fixed` roundings of every step.
fn compare(asked: &str, one: Units, other: Units, fixed: fn(&str) -> f64) -> Line {
    let (double, long) = both!(Sled { m: 2.0, alpha: 0.2, beta: 0.3, k: 0.4, incline: 0.3, g: 9.81 });
    let growth = Reference::new(&long, &START, (0.0, SPAN), 1e-3)
        .and_then(|reference| growth::<f64, _, 5>(&double, &reference))
        .unwrap_or(f64::NAN);
    let answers = ends(one).ends.into_iter().zip(ends(other).ends).map(|((by, promise, a), (_, _, b))| {
        let verdict = match (a, b) {
            (Ok((a, steps)), Ok((b, further))) => {
                let off = (0..5).map(|i| (a[i] - b[i]).abs() / a[i].abs()).fold(0.0, f64::max);
                let allowed = match promise {
                    Promise::Fixed => fixed(by) * steps as f64 * growth * 0.5 * f64::EPSILON,
                    Promise::Adaptive(tolerance) => allowed::<5>(steps + further, growth, tolerance),
                };
                Verdict::of(off, allowed)
            }
            (Err(verdict), _) | (_, Err(verdict)) => verdict,
        };
        Answer { by, verdict }
    });
    Line {
        system: "units",
        asked: asked.to_owned(),
        against: "each other".to_owned(),
        answers: answers.collect(),
    }
}

pub fn tasks() -> Vec<Task> {
    const USUAL: Units = Units { length: 1.0, time: 1.0, mass: 1.0 };
    let power = |n: i32| 2.0_f64.powi(n);
    let powers = Units { length: power(30), time: power(-17), mass: power(-41) };
    vec![
        Task::new("units", true, move || {
            // Implicit methods solve their equations to rounding, on a way that depends on units.
            let fixed = |by: &str| if by.starts_with("Gauss") { 1.0 } else { 0.0 };
            compare(
                "the sled in units that are 2^30, 2^-17 and 2^-41 of metre, second and kilogram",
                USUAL,
                powers,
                fixed,
            )
        }),
        Task::new("units", true, move || {
            let small = Units { length: 1e3, time: 1.0, mass: 1e6 };
            let large = Units { length: 1e-3, time: 1.0, mass: 1e-3 };
            compare(
                "the sled in millimetres and milligrams, and in kilometres and tonnes",
                small,
                large,
                |_| 1.0,
            )
        }),
    ]
}
