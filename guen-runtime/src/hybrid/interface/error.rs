//! The reason why a run through modes ended before its time.

use core::error::Error;
use core::fmt;

use super::mode::Mode;
use crate::steppers::{Cause, Statistics};

/// The reason why a run through modes could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum HybridCause<const C: usize> {
    /// A gap is negative at the start or after a reset; or on the way, where its zero was not seen.
    Penetrating {
        /// The name of the contact.
        contact: &'static str,
        /// The gap.
        gap: f64,
    },
    /// The reaction of a slipping contact has become infinite: `D_nn - mu d D_nt` has fallen to zero.
    Painleve {
        /// The name of the contact.
        contact: &'static str,
        /// The number `(D_nn - mu d D_nt)/D_nn`.
        p: f64,
    },
    /// No mode goes on from here: every one breaks one of its inequalities at once.
    Inconsistent,
    /// Two modes go on from here, and the declaration does not say which.
    Ambiguous {
        /// The modes.
        modes: [Mode<C>; 2],
    },
    /// The motion in the mode that goes on is not determined: it depends on reactions that are not, by the friction of contacts that slip
    /// with different coefficients.
    Undetermined {
        /// The mode.
        mode: Mode<C>,
    },
    /// The mode that goes on is not among the `modes` of the declaration.
    Excluded {
        /// The mode.
        mode: Mode<C>,
    },
    /// Two modes follow each other again and again without an accumulation that could be closed.
    Chattering {
        /// The transitions.
        count: u32,
        /// The time that they took.
        span: f64,
    },
    /// The allowed number of transitions is used up.
    TooManyTransitions {
        /// The number allowed.
        limit: u64,
    },
    /// An impact would gain kinetic energy.
    EnergyGain {
        /// The gain.
        gain: f64,
    },
    /// No impulses were found that satisfy the law of impact.
    NoImpact,
    /// Impulses with different results satisfy the law of impact.
    SeveralImpacts,
    /// A gap, the condition of a contact or latch, or the function of a switch or reset is NaN: its zeros from there on would not be seen.
    NoNumber {
        /// The name of the element, switch or reset.
        function: &'static str,
    },
    /// A reset breaks a contact that is closed.
    BrokenByReset {
        /// The name of the contact.
        contact: &'static str,
    },
    /// A reset breaks a constraint on positions that always holds.
    ConstraintBrokenByReset,
    /// Two resets happen at once, and give one variable different values.
    ContradictingResets {
        /// The names of the resets.
        resets: [&'static str; 2],
    },
    /// More modes fit than are compared at one transition.
    TooManyModes,
    /// The integration of the motion within a mode failed.
    Integration(Cause),
}

impl<const C: usize> fmt::Display for HybridCause<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Penetrating { contact, gap } => write!(f, "the gap of `{contact}` is negative, {gap:e}"),
            Self::Painleve { contact, p } => write!(
                f,
                "the reaction of `{contact}` becomes infinite while it slips: D_nn - mu D_nt is {p:e} of D_nn"
            ),
            Self::Inconsistent => f.write_str("no mode goes on from here"),
            Self::Ambiguous { modes: [first, second] } => {
                write!(f, "two modes go on from here: ({first}) and ({second})")
            }
            Self::Undetermined { mode } => {
                write!(f, "the motion in the mode ({mode}) depends on reactions that are not determined")
            }
            Self::Excluded { mode } => {
                write!(f, "the motion goes on in the mode ({mode}), which is excluded")
            }
            Self::Chattering { count, span } => {
                write!(f, "two modes followed each other {count} times within {span:e}")
            }
            Self::TooManyTransitions { limit } => write!(f, "{limit} transitions were not enough"),
            Self::EnergyGain { gain } => write!(f, "the impact would gain a kinetic energy of {gain:e}"),
            Self::NoNumber { function } => {
                write!(f, "the function of `{function}`, or its condition, is not a number here")
            }
            Self::NoImpact => f.write_str("no impulses satisfy the law of impact"),
            Self::SeveralImpacts => f.write_str("impulses with different results satisfy the law of impact"),
            Self::BrokenByReset { contact } => write!(f, "the reset opens `{contact}`, which is closed"),
            Self::ConstraintBrokenByReset => f.write_str("the reset breaks a constraint on positions"),
            Self::ContradictingResets { resets: [first, second] } => {
                write!(
                    f,
                    "the resets `{first}` and `{second}` happen at once, and give one variable different values"
                )
            }
            Self::TooManyModes => f.write_str("too many elements change at once"),
            Self::Integration(cause) => write!(f, "{cause}"),
        }
    }
}

/// A run through modes that failed: where it stopped, in which mode, why, and what had been reached.
///
/// ```
/// use guen_runtime::hybrid::{ElementState, HybridCause, HybridError, Mode};
/// use guen_runtime::steppers::Statistics;
///
/// let mode = Mode([ElementState::Open]);
/// let cause = HybridCause::Penetrating { contact: "floor", gap: -0.5 };
/// let error = HybridError { t: 0.0, mode, state: [-0.5, 0.0], cause, work: Statistics::default() };
/// assert_eq!(format!("{error}"), "the run stopped at t = 0, in the mode (open): the gap of `floor` is negative, -5e-1");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HybridError<const N: usize, const C: usize> {
    /// The time that was reached.
    pub t: f64,
    /// The mode there; before the first mode was selected, that in which nothing touches.
    pub mode: Mode<C>,
    /// The state at that time.
    pub state: [f64; N],
    /// The reason why the run could not go on.
    pub cause: HybridCause<C>,
    /// The work done until then.
    pub work: Statistics,
}

impl<const N: usize, const C: usize> fmt::Display for HybridError<N, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the run stopped at t = {}, in the mode ({}): {}", self.t, self.mode, self.cause)
    }
}

impl<const N: usize, const C: usize> Error for HybridError<N, C> {}
