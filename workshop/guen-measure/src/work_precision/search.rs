//! The cheapest setting of a method that holds an accuracy.
//!
//! The error is no monotone function of the setting: where two parts of it cancel, one step size is better than its
//! neighbours, by luck. So a setting *holds* an accuracy if it does and the next [`NEXT`] finer ones do too, each some 3 percent
//! further in steps, or an eighth of a decade in tolerance. Settings are tried from coarse to fine until one holds;
//! numbers of steps, of which not all were tried, are then bisected between it and the last that did not.

use std::collections::BTreeMap;

/// How many finer settings have to be as good.
const NEXT: u32 = 4;
/// From one number of steps to the next one that is tried, and to the ones that have to hold too.
const STRIDE: f64 = 1.06;
const FINER: f64 = 1.03;
/// Bisection ends at this part of a number of steps, or at a single step.
const RESOLUTION: f64 = 0.004;
/// Where the search begins: four steps, or half a decade.
const COARSEST: u32 = 4;
/// Tolerances tried per decade.
const PER_DECADE: f64 = 8.0;

/// What a method is set by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Knob {
    /// Equal steps, as many as the setting says.
    Steps,
    /// A tolerance, of so many eighths of a decade below one.
    Tolerance,
}

/// The work and the error of one run.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub evaluations: u64,
    pub error: f64,
}

impl Knob {
    /// The `j`-th of the finer settings that have to hold.
    fn finer(self, setting: u32, j: u32) -> u32 {
        match self {
            Knob::Steps => (setting + j).max((f64::from(setting) * FINER.powi(j as i32)).ceil() as u32),
            Knob::Tolerance => setting + j,
        }
    }

    fn next(self, setting: u32) -> u32 {
        match self {
            Knob::Steps => (setting + 1).max((f64::from(setting) * STRIDE) as u32),
            Knob::Tolerance => setting + 1,
        }
    }

    /// The step or tolerance of a setting.
    pub fn value(self, setting: u32, span: f64) -> f64 {
        match self {
            Knob::Steps => span / f64::from(setting),
            Knob::Tolerance => 10.0_f64.powf(-f64::from(setting) / PER_DECADE),
        }
    }
}

/// What was tried of one method.
pub struct Search<F> {
    knob: Knob,
    run: F,
    /// The run of each setting, if that did not fail.
    tried: BTreeMap<u32, Option<Run>>,
}

impl<F: Fn(u32) -> Option<Run>> Search<F> {
    pub fn new(knob: Knob, run: F) -> Self {
        Self { knob, run, tried: BTreeMap::new() }
    }

    /// The settings that were tried and did not fail, from coarse to fine.
    pub fn tried(&self) -> impl Iterator<Item = (u32, Run)> {
        self.tried.iter().filter_map(|(setting, run)| Some((*setting, (*run)?)))
    }

    pub fn at(&mut self, setting: u32) -> Option<Run> {
        *self.tried.entry(setting).or_insert_with(|| (self.run)(setting))
    }

    fn holds(&mut self, setting: u32, accuracy: f64) -> bool {
        (0..=NEXT).all(|j| {
            let finer = self.knob.finer(setting, j);
            self.at(finer).is_some_and(|run| run.error <= accuracy)
        })
    }

    /// Finds for each accuracy, from coarse to fine, the cheapest setting that holds it; none if that takes more than `most`
    /// evaluations.
    pub fn cheapest<const K: usize>(&mut self, accuracies: [f64; K], most: u64) -> [Option<u32>; K] {
        /// Beyond this no tolerance means anything in doubles.
        const FINEST: u32 = 18 * PER_DECADE as u32;

        let mut found = [None; K];
        let mut setting = COARSEST;
        for (place, accuracy) in found.iter_mut().zip(accuracies) {
            let mut below = setting;
            while !self.holds(setting, accuracy) {
                (below, setting) = (setting, self.knob.next(setting));
                let dear = self.at(setting).is_some_and(|run| run.evaluations > most);
                if dear || self.knob == Knob::Tolerance && setting > FINEST {
                    return found;
                }
            }
            while setting - below > 1.max((RESOLUTION * f64::from(setting)) as u32) {
                let middle = below.midpoint(setting);
                let part = if self.holds(middle, accuracy) { &mut setting } else { &mut below };
                *part = middle;
            }
            *place = Some(setting);
        }
        found
    }
}
