//! Taylor series of a motion: recurrences for the coefficients of everything that a program of rates computes.
//!
//! In goes a straight-line program of the rates, out comes a [`SeriesProgram`] that tells, operation by operation, how
//! the coefficient of order `k` follows from coefficients of lower order. With `x = sum_k x_k s^k`, `s` a scaled time
//! since the start of the step, and `h` the scale:
//!
//! | operation | coefficient of order `k >= 1` |
//! | --- | --- |
//! | `x' = f` | `x_k = h f_{k-1} / k` |
//! | `p = a b` | `p_k = a_0 b_k + a_k b_0 + S_k(a, b)` |
//! | `q = a / b` | `q_k = (a_k - q_0 b_k - S_k(q, b)) / b_0` |
//! | `r = sqrt(a)` | `r_k = (a_k - S_k(r, r)) / (2 r_0)` |
//! | `a* = s da/ds` | `a*_k = k a_k` |
//! | `y` with `y* = g` | `y_k = g_k / k` |
//!
//! with `S_k(a, b) = sum_{j=1}^{k-1} a_j b_{k-j}`, which is all the work there is. Elementary functions are the last
//! line: `exp(a)* = exp(a) a*`, `sin(a)* = cos(a) a*`, `ln(a)* = a* / a`, and so on. Where the argument is linear in state
//! and time, its rate is known from the step before, and the function is a further state: no derivative of the argument
//! is needed, and `cos(theta) theta'` is one product whoever asks for it.
//!
//! Source of the recurrences: R. E. Moore, *Interval Analysis*, Prentice-Hall 1966, chapter 11.

mod builder;

use super::{FunctionProgram, Operation, Value};
use crate::algebra::{Function, SymbolId};

/// The behaviour of a symbol during a step.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SymbolInStep {
    /// Constant: a physical constant, or an input that is held.
    Still,
    /// An input that has a series of its own, by its place.
    Input(usize),
    /// Time.
    Time,
    /// A variable of the state, by its place; the program's output of that place is its rate.
    State(usize),
}

/// A value of a series program. Values are numbered by their place in [`SeriesProgram::steps`].
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum SeriesStep {
    /// Constant during the step: an operation on such values alone, as it stands in a program.
    Still(Operation),
    /// Time.
    Time,
    /// A variable whose rate is the entry of [`SeriesProgram::rates`] at this place. It begins with the state, or with a
    /// [`Start`] where it is a function carried along.
    Variable(usize),
    /// An input, by its place: its coefficients come from outside.
    Input(usize),
    /// `a + b`, one of which may be still.
    Add(Value, Value),
    /// `a - b`, one of which may be still.
    Sub(Value, Value),
    /// `-a`
    Neg(Value),
    /// `k a` with a still `k`.
    Scale(Value, Value),
    /// `a b`, with the place of its sum among [`SeriesProgram::sums`]; `a^2` if both are the same.
    Product(Value, Value, usize),
    /// `a* b` with an `a*` that vanishes at order zero, so that the coefficient of `b` of the same order is not needed.
    /// `b` may be defined later.
    Along(Value, Value, usize),
    /// `a / b`
    Quotient(Value, Value, usize),
    /// The square root.
    SquareRoot(Value, usize),
    /// `s da/ds`
    Derivative(Value),
    /// A function that begins with a [`Start`] and has this `s dy/ds`.
    Integral(Start, Value),
}

/// The coefficient of order zero of an elementary function.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Start {
    /// A function of a value.
    Call(Function, Value),
    /// `atan2(y, x)`
    Atan2(Value, Value),
}

/// The program of a system's Taylor series.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SeriesProgram {
    /// Every value, defined before its use but for [`SeriesStep::Along`].
    pub steps: Vec<SeriesStep>,
    /// The rates of the variables: first those of the state, then those of the functions carried along.
    pub rates: Vec<Value>,
    /// The beginnings of the variables that are functions carried along, in the order of their rates.
    pub carried: Vec<Start>,
    /// The factors of each sum of products.
    pub sums: Vec<[Value; 2]>,
}

/// The reason why a program has no Taylor series: a function that is not analytic.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct NotAnalytic {
    /// The call of the function.
    pub operation: Operation,
    /// The first output that needs it.
    pub output: usize,
}

impl SeriesProgram {
    /// The recurrences of a program whose outputs are the rates of the state.
    ///
    /// # Errors
    ///
    /// Piecewise functions of something that moves have no series: they would be continued beyond their
    /// kink by the wrong branch, and nothing would tell. Of functions that the program supplies no series is known.
    pub fn new(
        program: &FunctionProgram,
        source: impl Fn(SymbolId) -> SymbolInStep,
    ) -> Result<Self, NotAnalytic> {
        builder::build(program, &source)
    }

    /// Whether a value is the same throughout a step.
    pub fn is_still(&self, value: Value) -> bool {
        matches!(self.steps[value.index()], SeriesStep::Still(_))
    }

    /// The values that are factors of sums, each once, in order: their coefficients have to be kept.
    pub fn factors(&self) -> Vec<Value> {
        let mut factors: Vec<Value> = self.sums.iter().flatten().copied().collect();
        factors.sort_unstable();
        factors.dedup();
        factors
    }
}

impl SeriesStep {
    /// The values that are read.
    pub fn operands(&self) -> Vec<Value> {
        match self {
            Self::Still(operation) => operation.operands().collect(),
            Self::Time | Self::Variable(_) | Self::Input(_) => Vec::new(),
            Self::Neg(a) | Self::Derivative(a) | Self::SquareRoot(a, _) => vec![*a],
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Scale(a, b)
            | Self::Product(a, b, _)
            | Self::Along(a, b, _)
            | Self::Quotient(a, b, _) => vec![*a, *b],
            Self::Integral(start, rate) => {
                let mut operands = start.operands();
                operands.push(*rate);
                operands
            }
        }
    }
}

impl Start {
    /// The values that are read at order zero.
    pub fn operands(&self) -> Vec<Value> {
        match *self {
            Self::Call(_, a) => vec![a],
            Self::Atan2(y, x) => vec![y, x],
        }
    }
}
