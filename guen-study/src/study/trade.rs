//! A finished study: its report, and whether a choice holds elsewhere.

use std::ops::Range;
use std::rc::Rc;

use super::choice::{Caveat, NoChoice};
use super::digits71::Digits71;
use super::known::{self, Scanner};
use super::measure::{Measure, Scales, Tells, against, kept};
use super::probes::{Probe, error_of, times_for, with_references};
use super::reference::{Named, Problem};
use super::report::StudyReport;
use super::row::Failure;
use super::variant::{Run, Task};
use super::{lengthened, probes};

/// The factor of the promise: elsewhere a choice errs by at most so many times the error that was asked for.
const PROMISE: f64 = 10.0;
/// A forecast leaves a tenth of that to what it does not know.
const CERTAIN: f64 = 0.9 * PROMISE;

/// A finished study.
pub struct Trade<const N: usize> {
    /// The report.
    pub report: StudyReport,
    pub(super) means: Means<N>,
}

impl<const N: usize> std::fmt::Debug for Trade<N> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Trade").field("report", &self.report).finish_non_exhaustive()
    }
}

/// The means to run settings again.
pub(super) struct Means<const N: usize> {
    pub runs: Vec<Option<Rc<Run<N>>>>,
    pub samples: usize,
    pub measure: Measure<N>,
    pub scales: Scales<N>,
    pub tells: Tells<N>,
    pub tight: Rc<dyn Fn(f64) -> Run<N>>,
    pub scanner: Scanner<N>,
    /// The times at which references from the states of the study land.
    pub landings: Vec<f64>,
    /// The times at which a forecast looks at the rates.
    pub points: usize,
    pub reference: Named<N>,
    pub check: Option<Named<N>>,
}

/// The expectation of a setting from another state or over another span.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Forecast {
    /// The error is estimated to stay within ten times what was asked for.
    Holds {
        /// The estimate.
        estimate: f64,
        /// The question that could not be checked, if any.
        caveat: Option<Caveat>,
    },
    /// The promise is not made: the estimate, or the uncertainty of the estimate, is too large.
    WillNot {
        /// The estimate.
        estimate: f64,
        /// The difference between the run that the estimate was made with and a coarser one.
        uncertainty: f64,
    },
    /// The row has no forecast: its error is not certain where it was measured.
    Refused(NoChoice),
    /// The setting fails there, or nothing can be estimated, because the tighter run fails.
    Fails(Failure),
}

impl Forecast {
    /// Whether the promise is made.
    pub fn holds(&self) -> bool {
        matches!(self, Self::Holds { .. })
    }
}

/// A setting tried from another state, with the truth from there.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tried<const N: usize> {
    /// The state.
    pub start: [f64; N],
    /// The forecast that was made before.
    pub forecast: Forecast,
    /// The error against a reference of its own; infinite if the run failed.
    pub error: f64,
    /// Whether what was said came true: the error is at most ten times what was asked for, or it was not promised.
    pub kept: bool,
}

/// The promise, if estimate and uncertainty together leave room for it.
fn judged(estimate: f64, uncertainty: f64, asked: f64) -> Forecast {
    if estimate + uncertainty <= CERTAIN * asked {
        Forecast::Holds { estimate, caveat: None }
    } else {
        Forecast::WillNot { estimate, uncertainty }
    }
}

impl<const N: usize> Trade<N> {
    /// Forecasts the error of a row from another state or over another span, before it is relied upon: runs the
    /// setting and compares with DOP853 in doubles at a tolerance of 1e-13, which looks for kicks and steep layers as
    /// the report's [`scan`](StudyReport::scan) says, and lands in those that the study found. That run is compared with
    /// one at a hundredth of the error asked for, so that a motion is noticed whose errors grow beyond what doubles
    /// can tell. The promise is made if estimate and uncertainty together are at most nine times what was asked for.
    ///
    /// Where these two cannot tell, two methods in extended precision decide, the reference of the study and its check, from this
    /// state.
    ///
    /// A row whose error is not certain is refused, as it is for a choice. Where the motion cannot be looked at closely, the
    /// promise leaves out what lasts less than a step, and says so: [`Caveat::NotScanned`].
    ///
    /// Costs those evaluations, 65,536 by default, and some times a run of the setting; a reference and its check where doubles
    /// cannot tell. Errors of energy and constraints are measured
    /// and not estimated.
    pub fn forecast(&self, row: usize, asked: f64, start: &[f64; N], span: Range<f64>) -> Forecast {
        if let Some(doubt) = self.report.rows.get(row).and_then(|row| self.report.doubt(row)) {
            return Forecast::Refused(doubt);
        }
        let Means { samples, measure, scales, tells, .. } = &self.means;
        let times = times_for(&span, *samples);
        let starts = [*start];
        let task = Task { starts: &starts, t0: span.start, times: &times, deadline: None };
        let states = match self.states(row, &task) {
            Ok(states) => states,
            Err(failure) => return Forecast::Fails(failure),
        };
        if !measure.needs_reference() {
            return judged(kept(measure, tells, (span.start, start), &times, &states), 0.0, asked);
        }
        let off = |states: &[[f64; N]], truth: &[[Digits71; N]]| {
            against(measure, scales, &times, states.iter().map(lengthened), truth)
        };
        let tolerance = (1e-3 * asked).clamp(1e-14, 1e-4);
        let Means { scanner, landings, points, .. } = &self.means;
        let problem = Problem { start, t0: span.start, times: &times, landings };
        let seen = known::motion(scanner, &problem, *points, 10.0 * tolerance, &mut || true);
        let caveat = seen.is_none().then_some(Caveat::NotScanned);
        let judged = |estimate, uncertainty| match judged(estimate, uncertainty, asked) {
            Forecast::Holds { estimate, .. } => Forecast::Holds { estimate, caveat },
            other => other,
        };
        let jumps = seen.as_ref().map_or(0.0, |(motion, _)| motion.uncertainty(0.0));
        let (fine, coarse) = match seen {
            Some((motion, _)) => (motion.fine, motion.coarse),
            // What cannot be looked at is a motion that fails, or a long or stiff one.
            None => match (self.tight(tolerance, &task), self.tight(10.0 * tolerance, &task)) {
                (Ok(fine), Ok(coarse)) => (fine, coarse),
                (Err(failure), _) | (_, Err(failure)) => {
                    let certified = self.certified(&problem, &states);
                    return certified.map_or(Forecast::Fails(failure), |(estimate, difference)| {
                        judged(estimate, difference)
                    });
                }
            },
        };
        let truth: Vec<_> = fine.iter().map(lengthened).collect();
        let (estimate, uncertainty) = (off(&states, &truth), off(&coarse, &truth) + jumps);
        let said = judged(estimate, uncertainty);
        // What errs by more than the promise, whatever is uncertain, needs no better reference.
        if said.holds() || estimate - uncertainty > PROMISE * asked {
            return said;
        }
        let landings = known::landings_elsewhere(scanner, &problem, *points, &mut || true);
        let problem = Problem { landings: landings.as_deref().unwrap_or(problem.landings), ..problem };
        let certified = self.certified(&problem, &states);
        certified.map_or(said, |(estimate, difference)| judged(estimate, difference))
    }

    /// Returns the difference of these states from the reference of the study, and that of its check.
    fn certified(&self, problem: &Problem<'_, N>, states: &[[f64; N]]) -> Option<(f64, f64)> {
        let Means { measure, scales, reference, check, .. } = &self.means;
        let run = |named: &Named<N>| (named.source)(problem, &mut |_| true).ok();
        let (truth, check) = (run(reference)?, run(check.as_ref()?)?);
        let off = |states: &mut dyn Iterator<Item = [Digits71; N]>| {
            against(measure, scales, problem.times, states, &truth)
        };
        Some((off(&mut states.iter().map(lengthened)), off(&mut check.into_iter())))
    }

    /// Makes the forecast of a row from each of these states, then measures its error there, against a reference in 71
    /// digits for each. States are left out from which there is no reference, or whose motions cannot be looked at closely where the
    /// study's could.
    pub fn trial(
        &self,
        row: usize,
        asked: f64,
        starts: impl IntoIterator<Item = [f64; N]>,
        span: Range<f64>,
    ) -> Vec<Tried<N>> {
        let Means { samples, measure, scales, tells, reference, scanner, landings, points, .. } = &self.means;
        let times = times_for(&span, *samples);
        let (at, known) =
            ((span.start, &times[..]), (scanner, &landings[..], *points, self.report.is_scanned()));
        let probes = with_references(starts, measure, at, &reference.source, known, &mut || true);
        let tried = |probe: &Probe<N>| {
            let forecast = self.forecast(row, asked, &probe.start, span.clone());
            let starts = [probe.start];
            let task = Task { starts: &starts, t0: span.start, times: &times, deadline: None };
            let error = self
                .states(row, &task)
                .map_or(f64::INFINITY, |states| error_of(probe, &states, measure, scales, tells, at));
            let kept = !forecast.holds() || error <= PROMISE * asked;
            Tried { start: probe.start, forecast, error, kept }
        };
        probes.iter().map(tried).collect()
    }

    /// States around one, each entry moved by at most `spread max(|x|, 1/3)`: the same for the same seed. For trials; they
    /// may violate constraints on positions.
    pub fn around(state: &[f64; N], count: usize, spread: f64, seed: u64) -> Vec<[f64; N]> {
        let mut draw = probes::Draw::new(seed);
        (0..count).map(|_| probes::moved(state, spread, &mut draw)).collect()
    }

    /// DOP853 in doubles.
    fn tight(&self, tolerance: f64, task: &Task<'_, N>) -> Result<Vec<[f64; N]>, Failure> {
        let mut states = Vec::new();
        (self.means.tight)(tolerance)(task, &mut states)?;
        Ok(states)
    }

    fn states(&self, row: usize, task: &Task<'_, N>) -> Result<Vec<[f64; N]>, Failure> {
        let Some(run) = self.means.runs.get(row).and_then(Option::as_ref) else {
            let failed = self.report.rows.get(row).and_then(|row| row.failure.clone());
            return Err(failed.unwrap_or_else(|| Failure::out_of_time(None)));
        };
        let mut states = Vec::new();
        run(task, &mut states)?;
        Ok(states)
    }
}
