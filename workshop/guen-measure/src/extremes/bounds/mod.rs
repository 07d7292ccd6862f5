//! The errors of right-hand sides against what the arithmetic allows.
//!
//! ```text
//! |f_computed - f| <= 8 u (cond + kappa_inf(M)) |f|,   cond = | sum_j |df/dz_j| |z_j| | / |f|
//! ```
//!
//! in the largest entry, with the unit roundoff `u`, the entries `z` of state and constants, and the mass matrix `M`. The
//! condition is computed with duals in 71 digits, and so is `f`. For systems with up to three parameters the same holds of
//! every entry by itself. Inputs are held and time is exact: neither is an entry of `z`.

mod measure;
mod systems;

use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use guen::Real;
use guen_study::Digits71;

use super::threads::on_threads;

/// The factor of the bound.
pub const FACTOR: f64 = 8.0;
/// Systems with more parameters are bounded as a whole only.
const BOUNDED_ENTRIES: usize = 3;

const REALS: [&str; 2] = ["f64", "f32"];
const PLACES: [&str; 2] = ["random", "to the edge"];

/// Ratios of errors to `u (cond + kappa)`, in one real and of one kind of states.
#[derive(Clone, Debug, Default)]
pub struct Ratios(Vec<f64>);

impl Ratios {
    fn push(&mut self, error: Digits71, allowed: f64) -> f64 {
        let error = error.abs().to_f64();
        // No error is none, whatever is allowed.
        let ratio = if error == 0.0 { 0.0 } else { error / allowed };
        self.0.push(ratio);
        ratio
    }

    /// The ratios below which these parts of them lie.
    fn quantiles<const Q: usize>(&self, parts: [f64; Q]) -> [f64; Q] {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        parts.map(|part| sorted.get((part * last as f64) as usize).copied().unwrap_or(f64::NAN))
    }

    /// The largest; no number of no states.
    pub fn largest(&self) -> f64 {
        self.quantiles([1.0])[0]
    }
}

/// What was found of a system.
#[derive(Clone, Debug)]
pub struct Found {
    pub system: &'static str,
    pub parameters: usize,
    /// In `f64` and `f32`, at random states and along paths: of the largest entry, and of every entry.
    pub whole: [[Ratios; 2]; 2],
    pub entries: [[Ratios; 2]; 2],
    /// States whose rates are no numbers: in none of the ratios.
    pub not_finite: [[usize; 2]; 2],
    /// The reason why the constants are refused in single precision, if they are: then there are no ratios for it.
    pub refused: Option<String>,
    /// Where an entry was worst.
    pub worst: Worst,
    pub seconds: f64,
}

/// A state at which an entry of the rates has the largest ratio.
#[derive(Clone, Debug, Default)]
pub struct Worst {
    pub ratio: f64,
    pub real: usize,
    pub entry: usize,
    pub time: f64,
    pub state: Vec<f64>,
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ratio, real, entry, time, state } = self;
        write!(f, "entry {entry} has {ratio:.3} in {} at t = {time}, {state:?}", REALS[*real])
    }
}

impl Found {
    /// Whether every entry by itself has to be within the bound.
    pub fn by_entries(&self) -> bool {
        self.parameters <= BOUNDED_ENTRIES
    }

    /// Whether everything is within the bound that has to be.
    pub fn holds(&self) -> bool {
        let reals = if self.refused.is_some() { 1 } else { 2 };
        let within =
            |ratios: &[[Ratios; 2]; 2]| ratios[..reals].iter().flatten().all(|r| r.largest() <= FACTOR);
        self.not_finite == [[0; 2]; 2] && within(&self.whole) && (!self.by_entries() || within(&self.entries))
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, real) in REALS.into_iter().enumerate() {
            if let (1, Some(refused)) = (k, &self.refused) {
                writeln!(f, "| {} | {real} | refused: {refused} | | | | | | | | |", self.system)?;
                continue;
            }
            for (p, place) in PLACES.into_iter().enumerate() {
                write!(f, "| {} | {real} | {place}", self.system)?;
                match self.not_finite[k][p] {
                    0 => write!(f, " |")?,
                    count => write!(f, ", {count} not finite |")?,
                }
                for ratios in [&self.whole[k][p], &self.entries[k][p]] {
                    for ratio in ratios.quantiles([0.5, 0.9, 0.999, 1.0]) {
                        write!(f, " {} |", figure(ratio))?;
                    }
                }
                writeln!(f)?;
            }
        }
        Ok(())
    }
}

/// Two digits, also of what is far below one.
fn figure(ratio: f64) -> String {
    if ratio == 0.0 || (0.01..1e4).contains(&ratio) { format!("{ratio:.2}") } else { format!("{ratio:.0e}") }
}

/// The head of the table that [`Found`] displays rows of.
pub const HEAD: &str = "| system | real | states | norm: median | 90 % | 99.9 % | largest | entries: median | 90 % | 99.9 % | largest |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
";

/// A system to measure, at so many states of either kind.
type Job = Box<dyn Fn(usize) -> Found + Sync>;

/// All systems, or those whose names have this in them, so many states of either kind, on so many threads; `done` is told
/// of each when it is done.
pub fn all(states: usize, threads: usize, named: Option<&str>, done: impl Fn(&Found) + Sync) -> Vec<Found> {
    let wanted = |name: &str| named.is_none_or(|part| name.contains(part));
    let jobs: Vec<Job> =
        systems::jobs().into_iter().filter(|(name, _)| wanted(name)).map(|(_, job)| job).collect();
    let found: Vec<Mutex<Option<Found>>> = jobs.iter().map(|_| Mutex::new(None)).collect();
    let next = AtomicUsize::new(0);
    on_threads(threads.clamp(1, jobs.len().max(1)), || {
        while let Some((job, place)) = {
            let index = next.fetch_add(1, Ordering::Relaxed);
            jobs.get(index).zip(found.get(index))
        } {
            let found = job(states);
            done(&found);
            if let Ok(mut place) = place.lock() {
                *place = Some(found);
            }
        }
    });
    found.into_iter().map(|found| found.into_inner().ok().flatten().expect("every job was done")).collect()
}
