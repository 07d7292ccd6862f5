//! The reason why an integration ended before its time, with the facts needed to act on it.

use core::error::Error;
use core::fmt;

use super::statistics::Statistics;
use crate::numbers::real::Real;
use crate::system::constraints::positions_error::PositionsError;

/// The reason why an integration could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// A state or a rate is infinite or NaN: the motion left the domain of the chart or of a force, or grew out
    /// of range. An adaptive stepper reports this only after shorter steps did not avoid it.
    NotFinite,
    /// The step became too small to move time. With an adaptive stepper: a singularity, a discontinuous right
    /// side, or a tolerance below rounding. With a fixed step: the step is below the spacing of numbers.
    StepUnderflow,
    /// The allowed number of trial steps is used up.
    TooManySteps {
        /// The number allowed.
        limit: u64,
    },
    /// The state could not be put back onto the constraints on positions.
    Positions,
    /// The system has contacts, and the run is not one through its modes: nothing would touch, grip or lock. `simulate` and
    /// [`Hybrid`](crate::hybrid::Hybrid) run through them, and `in_mode(mode)` is the system in one mode, for every method. The time
    /// and state beside this cause are those before the first step.
    Contacts,
    /// The equations of an implicit step were not solved: the step is too long for them, or the Jacobian is singular
    /// or not finite. An adaptive stepper reports this only after shorter steps did not avoid it.
    NoConvergence,
    /// An energy that the exact motion keeps has changed by more than the guard allows. The time and state beside
    /// this cause are the last at which it was within the bound.
    Energy {
        /// The time at which the change was found.
        found: f64,
        /// The change, relative to the scale of the energy.
        change: f64,
        /// The limit.
        limit: f64,
    },
    /// A constraint on positions is violated by more than the guard allows. The time and state beside this cause are
    /// the last at which it was not.
    Residual {
        /// The time at which the violation was found.
        found: f64,
        /// The largest left side of the constraints, relative to the size of its terms.
        residual: f64,
        /// The limit.
        limit: f64,
    },
    /// Functions that are carried as states are further from what they stand for than the guard allows. The time and state
    /// beside this cause are the last at which they were not.
    Carried {
        /// The time at which it was found.
        found: f64,
        /// The largest distance, relative to one and the function's size.
        drift: f64,
        /// The limit.
        limit: f64,
    },
    /// The motion came to the edge of the chart, where the equations divide by zero. The time and state beside this
    /// cause are the last on this side of the limit.
    ChartSingularity {
        /// The time at which it was found.
        found: f64,
        /// The index of the function that must not vanish; a generated system has the formulas in `DOMAIN`.
        function: usize,
        /// The certainty of the function there: its value relative to what a relative change of one in everything
        /// that enters would make of it, with every entry of the state at the largest value it has had. Negative if
        /// the function has changed its sign.
        distance: f64,
        /// The limit.
        limit: f64,
    },
    /// A fixed step is too long next to the edge of the chart: over one step a function that must not vanish changed so much
    /// that the pole of what divides by it is not resolved. The time and state beside this cause are those of the last check that
    /// found no such step.
    ApproachingSingularity {
        /// The time at which it was found.
        found: f64,
        /// The index of the function that must not vanish; a generated system has the formulas in `DOMAIN`.
        function: usize,
        /// The factor by which it changed, above one.
        ratio: f64,
        /// The limit.
        limit: f64,
    },
    /// The mass matrix is so ill conditioned that rounding leaves the accelerations too few digits. The time and state
    /// beside this cause are the last at which it was not, or the start.
    Condition {
        /// The time at which it was found.
        found: f64,
        /// The condition there, as [`Guarded::condition`](crate::Guarded::condition) defines it.
        condition: f64,
        /// The limit.
        limit: f64,
    },
    /// A fixed step is too long for the motion. The time and state beside this cause are the last at which it was not
    /// found to be.
    Step {
        /// The time at which it was found.
        found: f64,
        /// The entry of the state that is off by most.
        entry: usize,
        /// The estimate of its error, relative to its largest value.
        defect: f64,
        /// The limit.
        limit: f64,
    },
    /// The way back does not lead to the start: rounding errors would grow beyond the limit. The time and state beside
    /// this cause are the last from which it does.
    Irreversible {
        /// The time at which it was found.
        found: f64,
        /// The factor by which relative rounding errors grow on the way back.
        growth: f64,
        /// The limit, of roundings that have grown so, relative to the start.
        limit: f64,
    },
    /// A switch of a piecewise function drives the motion back to where it came from, on both sides: it would slide along the zero of
    /// the switching function, where the rates have no value. Declare a `contact` or a `grip` if it is one that sticks.
    Sliding {
        /// The time at which it was found.
        found: f64,
        /// The index of the switching function; a generated system has the formulas in `SWITCHES`.
        switch: usize,
    },
    /// The function of an event is NaN, at the time and state beside this cause: crossings from there on would not be seen.
    EventFunction {
        /// The position of the event among those that were asked for.
        event: usize,
    },
    /// The trajectory of a simulation (`Simulate::simulate`) does not fit into the memory that it may take.
    Memory {
        /// The limit, in bytes.
        limit: usize,
    },
    /// A setting or an argument makes no sense: nothing was integrated with it.
    Setting(Setting),
}

/// A setting or argument of an integration that was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Setting {
    /// The step is not positive and finite.
    Step,
    /// A tolerance is negative or not finite, or both are zero.
    Tolerance,
    /// The time to start from, or one to go to, is not finite.
    Time,
    /// The times of samples do not run in order from the start to the end.
    Samples,
    /// An event's tolerance is not a nonnegative number.
    Event,
    /// A limit of the guard is negative or no number.
    Guard,
    /// The number of evaluations allowed is not enough for one step.
    Budget,
    /// The order of the method is none that it has.
    Order,
    /// The error of the time at which impacts come to rest is not a nonnegative number.
    Accuracy,
    /// The period of a controller is not positive and finite.
    Period,
    /// A run with a controller, or through modes, goes backwards in time.
    Backwards,
}

/// The names of a system for messages; empty where it has none.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Names {
    /// The entries of a state.
    pub states: &'static [&'static str],
    /// The functions that must not vanish.
    pub domain: &'static [&'static str],
    /// The functions at whose zeros the rates change.
    pub switches: &'static [&'static str],
}

impl Names {
    fn function(&self, f: &mut fmt::Formatter<'_>, function: usize) -> fmt::Result {
        match self.domain.get(function) {
            Some(formula) => write!(f, "`{formula}`"),
            None => write!(f, "function {function} of the domain"),
        }
    }

    fn switch(&self, f: &mut fmt::Formatter<'_>, switch: usize) -> fmt::Result {
        match self.switches.get(switch) {
            Some(formula) => write!(f, "`{formula}`"),
            None => write!(f, "switching function {switch}"),
        }
    }

    fn entry(&self, f: &mut fmt::Formatter<'_>, entry: usize) -> fmt::Result {
        match self.states.get(entry) {
            Some(name) => write!(f, "`{name}`"),
            None => write!(f, "entry {entry} of the state"),
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.describe(f, Names::default())
    }
}

impl Cause {
    /// The cause that a state could not be put back to where it belongs.
    pub(crate) fn of_positions(error: PositionsError) -> Self {
        match error {
            PositionsError::Contacts => Self::Contacts,
            _ => Self::Positions,
        }
    }

    /// Writes the cause in the names of a system.
    pub(crate) fn describe(&self, f: &mut fmt::Formatter<'_>, names: Names) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("the state or its rate is not finite"),
            Self::StepUnderflow => f.write_str("the step is too small to move time"),
            Self::TooManySteps { limit } => write!(f, "{limit} steps were not enough"),
            Self::Positions => f.write_str("the constraints on positions cannot be restored"),
            Self::Contacts => write!(f, "{}", PositionsError::Contacts),
            Self::Setting(Setting::Step) => f.write_str("the step is not a positive number"),
            Self::Setting(Setting::Tolerance) => f.write_str(
                "the absolute tolerance is not a positive number, or the relative one not a nonnegative one",
            ),
            Self::NoConvergence => f.write_str("the equations of an implicit step cannot be solved"),
            Self::Energy { found, change, limit } => {
                write!(
                    f,
                    "by t = {found} the energy had changed by {change:e} of its scale, and {limit:e} is allowed"
                )
            }
            Self::Residual { found, residual, limit } => {
                write!(
                    f,
                    "by t = {found} a constraint was off by {residual:e} of its terms, and {limit:e} is allowed"
                )
            }
            Self::Carried { found, drift, limit } => {
                write!(f, "by t = {found} a carried function was off by {drift:e}, and {limit:e} is allowed")
            }
            Self::ChartSingularity { found, function, distance, limit } => {
                write!(f, "by t = {found} the motion had come to the edge of the chart: ")?;
                names.function(f, *function)?;
                write!(f, " must not vanish, and was {distance:e} of its terms; the limit is {limit:e}")
            }
            Self::ApproachingSingularity { found, function, ratio, limit } => {
                write!(f, "by t = {found} a fixed step was too long this close to the edge of the chart: ")?;
                names.function(f, *function)?;
                write!(
                    f,
                    " must not vanish, and one step changed it by a factor of {ratio:e}; {limit:e} is allowed"
                )
            }
            Self::Condition { found, condition, limit } => {
                write!(
                    f,
                    "at t = {found} the mass matrix had a condition of {condition:e}, and {limit:e} is allowed"
                )
            }
            Self::Irreversible { found, growth, limit } => {
                write!(
                    f,
                    "from t = {found} the run cannot be undone: roundings grow {growth:e} times on the way back, "
                )?;
                write!(f, "beyond {limit:e} of the start")
            }
            Self::Step { found, entry, defect, limit } => {
                write!(f, "by t = {found} the fixed step was too long: ")?;
                names.entry(f, *entry)?;
                f.write_str(" is off by about ")?;
                write!(f, "{defect:e} of its size, and {limit:e} is allowed")
            }
            Self::Sliding { found, switch } => {
                write!(f, "at t = {found} the motion would slide where ")?;
                names.switch(f, *switch)?;
                f.write_str(
                    " = 0: the rates on both sides lead back there, and none are given for the motion between. \
                     What sticks is declared under `contacts`; a law that is smooth, as `tanh(v/small)`, creeps instead",
                )
            }
            Self::EventFunction { event } => write!(f, "the function of event {event} is not a number here"),
            Self::Memory { limit } => write!(f, "the trajectory does not fit into {limit} bytes"),
            Self::Setting(Setting::Time) => f.write_str("a time to start from or to go to is not finite"),
            Self::Setting(Setting::Samples) => {
                f.write_str("the times of samples do not run in order from the start to the end")
            }
            Self::Setting(Setting::Event) => {
                f.write_str("the tolerance of an event is not a nonnegative number")
            }
            Self::Setting(Setting::Guard) => f.write_str("a limit of the guard is not a nonnegative number"),
            Self::Setting(Setting::Order) => f.write_str("the order is not between 2 and 32"),
            Self::Setting(Setting::Accuracy) => {
                f.write_str("the accuracy of the time of rest is not a nonnegative number")
            }
            Self::Setting(Setting::Period) => {
                f.write_str("the period of the controller is not a positive number")
            }
            Self::Setting(Setting::Backwards) => {
                f.write_str("a run through modes, or with a controller that holds its inputs, cannot go backwards in time")
            }
            Self::Setting(Setting::Budget) => {
                f.write_str("the number of evaluations is not enough for one step")
            }
        }
    }
}

/// A failed integration: where it stopped, why, and what had been reached.
///
/// `time` and `state` are those of the last accepted step, or the last that a guard found in order, so the part of the
/// motion before the failure is not lost: continue from there with other settings, or take it as the result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationError<R, const N: usize> {
    /// The time that was reached.
    pub time: R,
    /// The state at that time. It is the initial state, finite or not, if no step succeeded.
    pub state: [R; N],
    /// The reason why the integration could not go on from there.
    pub cause: Cause,
    /// The work done until then.
    pub statistics: Statistics,
}

impl<R: Real, const N: usize> fmt::Display for IntegrationError<R, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "integration stopped at t = {}: {}", self.time.to_f64(), self.cause)
    }
}

impl<R: Real, const N: usize> Error for IntegrationError<R, N> {}

/// An error of a run with the names of its system.
pub(crate) struct NamedError {
    pub(crate) time: f64,
    pub(crate) cause: Cause,
    pub(crate) names: Names,
}

impl fmt::Display for NamedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "integration stopped at t = {}: ", self.time)?;
        self.cause.describe(f, self.names)
    }
}
