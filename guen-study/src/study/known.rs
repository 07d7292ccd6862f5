//! Uses a scan in a study: where its references land, whether they agree with a motion that landed there, and what
//! the report says.

use std::fmt;
use std::rc::Rc;

use super::reference::Problem;
use super::scan::{self, ScanDepth, Seen};
use crate::significant;

/// Looks at a motion of the system in doubles; told whether to go on.
pub(super) type Scanner<const N: usize> =
    Rc<dyn Fn(&Problem<'_, N>, ScanDepth, &mut dyn FnMut() -> bool) -> Option<Seen<N>>>;

/// The evaluations of the rates along a motion in all.
pub(super) const SCANNED_POINTS: usize = 1 << 20;
/// The evaluations in the first pass, and the factor by which they grow while there is time.
const FIRST: usize = 1 << 12;
const GROWTH: usize = 16;
/// States nearby and forecasts have this part of them.
const PART_ELSEWHERE: usize = 16;
/// The tolerance of the coarser motion, which tells the uncertainty of the finer one, a hundred times as accurate.
const COARSER: f64 = 1e-11;
/// The further uncertainty of the finer motion: this much in any case, and so many times what jumps leave uncertain.
const FINER_UNCERTAINTY: f64 = 1e-10;
const OF_JUMPS: f64 = 10.0;

/// The search for kicks and steep layers that a method might step over, and what it found.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ScanReport {
    /// Whatever lasts so long was seen, wherever it lies: twice the time between neighbouring evaluations. None if the motions could
    /// not be followed, or not in time.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact::option"))]
    pub width: Option<f64>,
    /// The width for states nearby and for forecasts.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact::option"))]
    pub width_elsewhere: Option<f64>,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// The number of places where the rates jump, or a method in doubles stepped over what they do.
    pub abrupt: usize,
    /// The number of times that references landed on for that.
    pub landings: usize,
}

impl fmt::Display for ScanReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Some(width), Some(elsewhere)) = (self.width, self.width_elsewhere) else {
            return f.write_str("scan: none; what lasts less than a step may have been stepped over");
        };
        let [width, elsewhere] = [width, elsewhere].map(|width| significant(width, 2));
        write!(f, "scan: whatever lasts {width} or longer was seen, {elsewhere} from other states")?;
        if self.abrupt > 0 {
            write!(f, "; {} abrupt, {} landings there", places(self.abrupt), self.landings)?;
        }
        Ok(())
    }
}

fn places(count: usize) -> String {
    if count == 1 { "1 place".to_owned() } else { format!("{count} places") }
}

/// The scanned motions from all initial states.
pub(super) struct Known<const N: usize> {
    pub report: ScanReport,
    /// The evaluations of the rates along motions elsewhere.
    pub points_elsewhere: usize,
    pub motions: Vec<Motion<N>>,
}

/// The states of a motion in doubles at the times, those of a coarser one, and what both leave uncertain.
pub(super) struct Motion<const N: usize> {
    pub fine: Vec<[f64; N]>,
    pub coarse: Vec<[f64; N]>,
    /// The times that references land on.
    pub landings: Vec<f64>,
    uncertain: f64,
}

impl<const N: usize> Motion<N> {
    /// Returns the uncertainty of the finer motion, given its difference from the coarser one.
    pub fn uncertainty(&self, from_coarser: f64) -> f64 {
        from_coarser + OF_JUMPS * self.uncertain
    }

    /// Returns the error of a reference that this motion contradicts, given the differences of the finer motion from it and from the
    /// coarser one: zero, where the motion may be off by as much.
    pub fn contradicts(&self, from_reference: f64, from_coarser: f64) -> f64 {
        let allowed = self.uncertainty(from_coarser) + FINER_UNCERTAINTY;
        if from_reference <= allowed { 0.0 } else { from_reference }
    }
}

/// Looks at a motion, and follows it once more at a coarser tolerance.
pub(super) fn motion<const N: usize>(
    scanner: &Scanner<N>,
    problem: &Problem<'_, N>,
    points: usize,
    coarser: f64,
    watch: &mut dyn FnMut() -> bool,
) -> Option<(Motion<N>, Seen<N>)> {
    let mut seen = scanner(problem, ScanDepth::At(points), watch)?;
    let landings: Vec<f64> = problem.landings.iter().chain(&seen.landings).copied().collect();
    let again = Problem { landings: &landings, ..*problem };
    let coarse = scanner(&again, ScanDepth::Nowhere(coarser), watch)?;
    seen.evaluations += coarse.evaluations;
    let fine = std::mem::take(&mut seen.states);
    let landings = std::mem::take(&mut seen.landings);
    Some((Motion { fine, coarse: coarse.states, landings, uncertain: seen.uncertain }, seen))
}

impl<const N: usize> Known<N> {
    /// Returns the report of a search in which nothing was looked at.
    pub fn nothing(points: usize) -> Self {
        let report =
            ScanReport { width: None, width_elsewhere: None, evaluations: 0, abrupt: 0, landings: 0 };
        Self { report, points_elsewhere: elsewhere(points), motions: Vec::new() }
    }

    /// Returns the times at which references from the `k`th initial state land.
    pub fn landings(&self, k: usize) -> &[f64] {
        self.motions.get(k).map_or(&[], |motion| &motion.landings)
    }

    /// Looks at the motions from all initial states, more and more closely while `watch` says, given the part that is
    /// done, that there is time.
    pub fn refine(
        scanner: &Scanner<N>,
        starts: &[[f64; N]],
        (t0, times): (f64, &[f64]),
        points: usize,
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Self {
        let mut found = Self::nothing(points);
        let mut now = FIRST.min(points);
        while let Some(next) = Self::once(scanner, starts, (t0, times), now, &mut |part| {
            let before = now as f64 / GROWTH as f64;
            watch((before + part * (now as f64 - before)) / points as f64)
        }) {
            found = next;
            if now == points {
                break;
            }
            now = (GROWTH * now).min(points);
        }
        found
    }

    fn once(
        scanner: &Scanner<N>,
        starts: &[[f64; N]],
        (t0, times): (f64, &[f64]),
        points: usize,
        watch: &mut dyn FnMut(f64) -> bool,
    ) -> Option<Self> {
        let mut found = Self::nothing(points);
        let span = times.last().map_or(0.0, |end| (end - t0).abs());
        for (k, start) in starts.iter().enumerate() {
            let problem = Problem { start, t0, times, landings: &[] };
            let part = k as f64 / starts.len() as f64;
            let (motion, seen) = motion(scanner, &problem, points, COARSER, &mut || watch(part))?;
            found.report.evaluations += seen.evaluations;
            found.report.abrupt += seen.abrupt;
            found.report.landings += motion.landings.len();
            found.motions.push(motion);
        }
        found.report.width = Some(scan::width(span, points));
        found.report.width_elsewhere = Some(scan::width(span, found.points_elsewhere));
        Some(found)
    }
}

fn elsewhere(points: usize) -> usize {
    (points / PART_ELSEWHERE).max(1)
}

/// The times that a reference elsewhere has to land on; none if the motion there cannot be looked at.
pub(super) fn landings_elsewhere<const N: usize>(
    scanner: &Scanner<N>,
    problem: &Problem<'_, N>,
    points: usize,
    watch: &mut dyn FnMut() -> bool,
) -> Option<Vec<f64>> {
    let seen = scanner(problem, ScanDepth::At(points), watch)?;
    Some(problem.landings.iter().copied().chain(seen.landings).collect())
}
