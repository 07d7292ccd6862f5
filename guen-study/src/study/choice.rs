//! Chooses a setting of a report, or says why there is none to choose: the one way to a choice, for reports of
//! studies and for those that come back from files.

use std::fmt;

use super::reference::{NO_ENERGY, NO_MOTION, NO_SCALES};
use super::report::{StudyReport, Unit};
use super::row::{Nearby, Row};

/// A setting may err this many times what was asked for from states nearby; ten times is what is promised.
const NEARBY: f64 = 2.0;
/// The multiple of the reference's error below which the error of a setting is uncertain.
const LIMITED: f64 = 10.0;
/// The error of a reference that limits nothing: a sixteenth of the rounding of doubles.
const EXACT: f64 = f64::EPSILON / 32.0;

/// The least error that can be told from that of the reference, whose stated error this is; infinite where it has none.
pub(super) fn least_certain(reference: Option<f64>) -> f64 {
    match reference {
        Some(error) if error <= EXACT => 0.0,
        Some(error) => LIMITED * error,
        None => f64::INFINITY,
    }
}

/// A chosen setting.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Choice<'a> {
    /// The position among the rows.
    pub index: usize,
    /// The setting, with the code to write.
    pub row: &'a Row,
    /// The error that was asked for; that of the setting where a time was given.
    pub asked: f64,
    /// Settings that fulfil the same and whose costs cannot be told from that of the choice.
    pub ties: Vec<&'a Row>,
    /// A setting that is quicker and was passed over, because it errs too much from states nearby.
    pub passed_over: Option<&'a Row>,
    /// The questions that the study could not check; the promise does not cover them.
    pub caveats: Vec<Caveat>,
    unit: Unit,
}

/// Something that a study could not check and its promise does not cover.
///
/// ```
/// use guen_study::Caveat;
///
/// assert_eq!(Caveat::NotTriedNearby.to_string(), "not tried from states nearby");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Caveat {
    /// The motion could not be followed closely, or not in time, as stiff ones cannot: what lasts less than a step may have been
    /// stepped over, by the setting and by what it was compared with.
    NotScanned,
    /// The setting was not tried from states nearby: none were asked for, there was no time, or the motion from them has no
    /// reference.
    NotTriedNearby,
    /// The setting failed from a state nearby. Only where a cost was given: a setting that is chosen for an error
    /// holds nearby.
    FailsNearby,
}

impl fmt::Display for Caveat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotScanned => {
                "nobody looked for what lasts less than a step: it may have been stepped over"
            }
            Self::NotTriedNearby => "not tried from states nearby",
            Self::FailsNearby => "fails from a state nearby",
        })
    }
}

/// The reason why there is no choice.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoChoice {
    /// No setting was measured: the study was cancelled, or no run came to its end.
    NothingMeasured,
    /// There is no motion to measure: the span is empty, or one of its ends or a number of a start is not finite.
    NoMotion,
    /// The change of the energy was to be measured, and the system keeps none.
    NoEnergy,
    /// One of the sizes of [`Study::scales`](super::Study::scales) is not a positive number.
    NoScales,
    /// There is no reference, so that no error is known: the report has the reason.
    NoReference,
    /// The reference was not checked by a second method, so that no error is certain.
    Unchecked,
    /// The reference and its check differ too much for the errors that were measured against them.
    ReferencesDisagree {
        /// The difference of the two, in the measure of the study.
        difference: f64,
    },
    /// No setting is that accurate; the most accurate one errs this much.
    NotThatAccurate {
        /// The least error measured.
        least: f64,
    },
    /// Settings are that accurate from the initial states, and none of them from all states nearby.
    NotNearby {
        /// The least error of theirs from the worst of these states; infinite if all of them fail from one.
        least: f64,
    },
    /// No setting is that cheap; the cheapest one costs this much.
    NotThatCheap {
        /// The least cost measured.
        least: f64,
    },
}

impl fmt::Display for NoChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingMeasured => f.write_str("no setting has a measured error and a measured cost"),
            Self::NoMotion => write!(f, "there is no motion to measure: {NO_MOTION}"),
            Self::NoEnergy => f.write_str(NO_ENERGY),
            Self::NoScales => f.write_str(NO_SCALES),
            Self::Unchecked => {
                f.write_str("the reference was not checked by a second method, so no error is certain")
            }
            Self::ReferencesDisagree { difference } => write!(
                f,
                "the reference and its check differ by {difference:.1e}, so errors below {:.1e} are not certain",
                LIMITED * difference
            ),
            Self::NotThatAccurate { least } => {
                write!(f, "no setting is that accurate; the least error measured is {least:.1e}")
            }
            Self::NoReference => f.write_str(
                "there is no reference, so no error is known; where time or steps did not suffice, `within`, a shorter \
                 span or, for stiff systems, `reference_by` help",
            ),
            Self::NotNearby { least } => {
                f.write_str("settings are that accurate from the initial states, but not from all states nearby: ")?;
                if least.is_finite() {
                    write!(f, "the least error from the worst of these is {least:.1e}")?;
                } else {
                    f.write_str("from one of these all of them fail")?;
                }
                f.write_str("; `probes` with a smaller spread asks less")
            }
            Self::NotThatCheap { least } => {
                write!(f, "no setting is that cheap; the least cost measured is {least:.2e}")
            }
        }
    }
}

impl std::error::Error for NoChoice {}

/// A row that may be chosen, with its position, its error and its cost.
struct Certain<'a> {
    index: usize,
    row: &'a Row,
    error: f64,
    median: f64,
    high: f64,
}

impl StudyReport {
    /// The reason why nothing may be concluded from a row, whatever it shows: its error is not certain. Nothing where it is.
    ///
    /// The marks of the rows are not relied upon: what the report says of its reference counts, so that a report from
    /// a file is judged as a new one.
    pub(super) fn doubt(&self, row: &Row) -> Option<NoChoice> {
        let Some(error) = row.error.filter(|error| error.is_finite()) else {
            return Some(NoChoice::NothingMeasured);
        };
        let Some(reference) = &self.reference else {
            // A measure that needs no reference marks no row.
            return row.limited.then_some(NoChoice::Unchecked);
        };
        let Some(difference) = reference.error else { return Some(NoChoice::Unchecked) };
        // Not `<`: of an error that is not a number nothing is certain.
        let certain = !row.limited && error >= least_certain(Some(difference));
        (!certain).then_some(NoChoice::ReferencesDisagree { difference })
    }

    fn certain(&self) -> Vec<Certain<'_>> {
        let rows = self.rows.iter().enumerate().filter(|(_, row)| self.doubt(row).is_none());
        rows.filter_map(|(index, row)| {
            let (error, cost) = row.measured()?;
            Some(Certain { index, row, error, median: cost.median, high: cost.high })
        })
        .collect()
    }

    /// Returns the reason why the rows that would do if they were certain are not: that of the first of them.
    fn doubts(&self, wanted: impl Fn(f64, f64) -> bool) -> Option<NoChoice> {
        let mut would = self
            .rows
            .iter()
            .filter(|row| row.measured().is_some_and(|(error, cost)| wanted(error, cost.high)));
        would.find_map(|row| self.doubt(row))
    }

    /// The cheapest setting whose error was measured to be at most this, and whose error from states nearby was at most
    /// twice this, where it was measured: so that the promise, ten times, has room. Only settings whose errors are
    /// certain: ten times what the reference and its check differ by, or more.
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn fastest_within(&self, error: f64) -> Result<Choice<'_>, NoChoice> {
        let certain = self.certain();
        let cheapest = |wanted: &dyn Fn(&Certain<'_>) -> bool| {
            let found = certain.iter().filter(|one| wanted(one));
            found.min_by(|a, b| a.median.total_cmp(&b.median))
        };
        let accurate = |one: &Certain<'_>| one.error <= error;
        let Some(plain) = cheapest(&accurate) else {
            let doubt = self.doubts(|found, _| found <= error);
            let least = certain.iter().map(|one| one.error).min_by(f64::total_cmp);
            let none = least.map(|least| NoChoice::NotThatAccurate { least });
            return Err(doubt.or(none).unwrap_or_else(|| self.nothing()));
        };
        // Where nearby errors were measured at all, a row without one was not worth measuring, and is not chosen.
        let probed = self.rows.iter().any(|row| row.nearby.is_some());
        let robust = |one: &Certain<'_>| {
            accurate(one) && one.row.nearby.map_or(!probed, |nearby| nearby.is_within(NEARBY * error))
        };
        let Some(chosen) = cheapest(&robust) else {
            let nearby = certain.iter().filter(|one| accurate(one)).filter_map(|one| match one.row.nearby {
                Some(Nearby::Error(error)) => Some(error),
                _ => None,
            });
            return Err(NoChoice::NotNearby { least: nearby.fold(f64::INFINITY, f64::min) });
        };
        let tied = |one: &&Certain<'_>| {
            let costs = (one.row.cost, chosen.row.cost);
            one.index != chosen.index && robust(one) && matches!(costs, (Some(a), Some(b)) if a.ties_with(&b))
        };
        Ok(Choice {
            index: chosen.index,
            row: chosen.row,
            asked: error,
            ties: certain.iter().filter(tied).map(|one| one.row).collect(),
            passed_over: (plain.index != chosen.index).then_some(plain.row),
            caveats: self.caveats(chosen.row),
            unit: self.unit,
        })
    }

    /// The setting with the least measured error among those whose cost is at most this: the upper end of its interval,
    /// so that noise does not choose. In seconds, or in evaluations where the study counts them. Only settings whose errors
    /// are certain, as in [`fastest_within`](StudyReport::fastest_within).
    ///
    /// # Errors
    ///
    /// There is none.
    pub fn most_accurate_within(&self, cost: f64) -> Result<Choice<'_>, NoChoice> {
        let certain = self.certain();
        let best = certain
            .iter()
            .filter(|one| one.high <= cost)
            .min_by(|a, b| a.error.total_cmp(&b.error).then(a.median.total_cmp(&b.median)));
        let Some(best) = best else {
            let doubt = self.doubts(|_, high| high <= cost);
            let least = certain.iter().map(|one| one.high).min_by(f64::total_cmp);
            let none = least.map(|least| NoChoice::NotThatCheap { least });
            return Err(doubt.or(none).unwrap_or_else(|| self.nothing()));
        };
        Ok(Choice {
            index: best.index,
            row: best.row,
            asked: best.error,
            ties: Vec::new(),
            passed_over: None,
            caveats: self.caveats(best.row),
            unit: self.unit,
        })
    }

    /// Returns the questions that the study could not check for this row.
    fn caveats(&self, row: &Row) -> Vec<Caveat> {
        let unseen = self.reference.is_some() && !self.is_scanned();
        let nearby = match row.nearby {
            Some(Nearby::Error(_)) => None,
            Some(Nearby::Failed) => Some(Caveat::FailsNearby),
            None => Some(Caveat::NotTriedNearby),
        };
        unseen.then_some(Caveat::NotScanned).into_iter().chain(nearby).collect()
    }

    /// The reason why no row at all is certain.
    fn nothing(&self) -> NoChoice {
        let why = self.reference.as_ref().and_then(|reference| reference.failure.as_deref());
        match why {
            Some(NO_MOTION) if self.rows.is_empty() => return NoChoice::NoMotion,
            Some(NO_ENERGY) if self.rows.is_empty() => return NoChoice::NoEnergy,
            Some(NO_SCALES) if self.rows.is_empty() => return NoChoice::NoScales,
            _ => {}
        }
        let failed = self.reference.as_ref().is_some_and(|reference| reference.error.is_none());
        let none =
            if failed && !self.rows.is_empty() { NoChoice::NoReference } else { NoChoice::NothingMeasured };
        self.doubts(|_, _| true).unwrap_or(none)
    }
}

impl fmt::Display for Choice<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cost = self.row.cost.map_or_else(String::new, |cost| self.unit.show(cost.median));
        let error = self.row.error.unwrap_or(f64::NAN);
        write!(f, "{}: error {error:.1e}, {cost}", self.row.name())?;
        if let Some(Nearby::Error(nearby)) = self.row.nearby {
            write!(f, ", from states nearby at most {nearby:.1e}")?;
        }
        for caveat in &self.caveats {
            write!(f, "\n  {caveat}")?;
        }
        if let Some(row) = self.passed_over {
            write!(f, "\n  quicker, but not as accurate from states nearby: {}", row.name())?;
        }
        if !self.ties.is_empty() {
            const SHOWN: usize = 4;
            let names: Vec<String> = self.ties.iter().take(SHOWN).map(|row| row.name()).collect();
            write!(f, "\n  a tie, the machine was too noisy to rank them: {}", names.join("; "))?;
            if self.ties.len() > SHOWN {
                write!(f, "; and {} more", self.ties.len() - SHOWN)?;
            }
        }
        Ok(())
    }
}
