//! Rows of a report: settings of variants, each with its error and cost.

use guen_runtime::{Cause, ConstantsError};

use super::timing::Cost;

/// The quantity that a setting of a variant sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Knob {
    /// The length of a step, in units of time.
    Step,
    /// The relative and absolute tolerance.
    Tolerance,
    /// The number of evaluations allowed.
    Evaluations,
}

impl Knob {
    /// The letter that stands for it in tables.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Step => "h",
            Self::Tolerance => "tol",
            Self::Evaluations => "n",
        }
    }
}

/// The reason why a setting has no result.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Failure {
    /// The kind of failure.
    pub kind: FailureKind,
    /// The time that the run had reached, if it had begun.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact::option"))]
    pub time: Option<f64>,
    /// The whole message.
    pub message: String,
}

/// The kinds of failures, as far as a choice depends on them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum FailureKind {
    /// The state was no longer finite.
    NotFinite,
    /// The step became too short, or there were too many of them.
    Steps,
    /// The equations of an implicit step were not solved.
    NoConvergence,
    /// A guard found that energy, constraints or chart were violated: the setting is too coarse.
    Guard,
    /// The setting makes no sense for this method.
    Setting,
    /// The constants cannot be prepared in this real.
    Constants,
    /// The run took longer than the study had for it.
    OutOfTime,
}

impl Failure {
    pub(super) fn of_run(time: f64, cause: &Cause) -> Self {
        let kind = match cause {
            Cause::NotFinite => FailureKind::NotFinite,
            Cause::NoConvergence => FailureKind::NoConvergence,
            Cause::Energy { .. }
            | Cause::Residual { .. }
            | Cause::ChartSingularity { .. }
            | Cause::Carried { .. }
            | Cause::Sliding { .. }
            | Cause::Positions => FailureKind::Guard,
            Cause::Setting(_) | Cause::Contacts | Cause::EventFunction { .. } => FailureKind::Setting,
            _ => FailureKind::Steps,
        };
        Self { kind, time: Some(time), message: cause.to_string() }
    }

    pub(super) fn of_constants(error: &ConstantsError) -> Self {
        Self { kind: FailureKind::Constants, time: None, message: error.to_string() }
    }

    pub(super) fn out_of_time(time: Option<f64>) -> Self {
        let message = "it took longer than the study had for it".to_owned();
        Self { kind: FailureKind::OutOfTime, time, message }
    }
}

/// The error of a setting from states in the neighbourhood of those that the study was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Nearby {
    /// The largest error.
    Error(#[cfg_attr(feature = "serde", serde(with = "crate::exact"))] f64),
    /// A run failed.
    Failed,
}

impl Nearby {
    /// The larger of the two; a failure is the largest.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        match (self, other) {
            (Self::Error(a), Self::Error(b)) => Self::Error(a.max(b)),
            _ => Self::Failed,
        }
    }

    /// Whether it is an error of at most this size.
    pub fn is_within(self, error: f64) -> bool {
        matches!(self, Self::Error(found) if found <= error)
    }
}

/// A row of the table: a setting of a variant with its error and its cost.
///
/// Fields that were not measured are `None`: a cancelled study, or one whose reference failed, has such rows.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Row {
    /// The method, such as `DOP853`.
    pub method: String,
    /// The real that it computes with, such as `f64` or `Approx7`.
    pub real: String,
    /// The form of the right-hand side: `declared` unless the variant brings another one.
    pub form: String,
    /// The quantity that the setting sets.
    pub knob: Knob,
    /// The setting.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub setting: f64,
    /// The largest error over the initial states, in the study's measure.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact::option"))]
    pub error: Option<f64>,
    /// Whether the error is so small that the reference's own error may be a tenth of it, or more. Such a row is not
    /// chosen, and nothing is promised of it.
    pub limited: bool,
    /// The error from states nearby, for rows that may be chosen.
    pub nearby: Option<Nearby>,
    /// Evaluations of the right-hand side, for one initial state in the mean.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub evaluations: f64,
    /// Evaluations of the Jacobian, likewise.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub jacobians: f64,
    /// The cost, for one initial state.
    pub cost: Option<Cost>,
    /// The reason why there is no result.
    pub failure: Option<Failure>,
    /// The Rust code for this setting.
    pub code: String,
}

impl Row {
    /// Method, real and form, as far as they are not the usual ones.
    ///
    /// `DOP853`, `RK8 in Approx7`, `DOP853, carried`.
    pub fn variant(&self) -> String {
        let real = if self.real == "f64" { String::new() } else { format!(" in {}", self.real) };
        let form = if self.form == "declared" { String::new() } else { format!(", {}", self.form) };
        format!("{}{real}{form}", self.method)
    }

    /// The variant with its setting: `RK8 in Approx7, h = 0.05`.
    pub fn name(&self) -> String {
        format!("{}, {} = {}", self.variant(), self.knob.symbol(), crate::significant(self.setting, 3))
    }

    /// Error and cost, if both were measured and the setting did not fail.
    pub fn measured(&self) -> Option<(f64, &Cost)> {
        let error = self.error.filter(|error| error.is_finite())?;
        self.failure.is_none().then_some(())?;
        Some((error, self.cost.as_ref()?))
    }
}
