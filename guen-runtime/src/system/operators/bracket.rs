//! The coefficients of brackets of operators, as far as they are known before the program runs.

use core::fmt;

/// A structure coefficient, as far as it is known at compile time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Coefficient {
    /// Proved to vanish identically.
    Zero,
    /// A rational number other than zero, in lowest terms.
    Number {
        /// The numerator, with the sign.
        numerator: i64,
        /// The denominator, positive.
        denominator: i64,
    },
    /// Constant in time and position: a function of the physical constants, or a number that is no ratio of two
    /// `i64`.
    Constant,
    /// A function of time or position, or of unknown nature.
    Variable,
}

impl Coefficient {
    /// Whether the coefficient is known to be the same at all times and positions.
    pub const fn is_constant(self) -> bool {
        !matches!(self, Self::Variable)
    }
}

impl fmt::Display for Coefficient {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Zero => f.write_str("0"),
            Self::Number { numerator, denominator: 1 } => write!(f, "{numerator}"),
            Self::Number { numerator, denominator } => write!(f, "{numerator}/{denominator}"),
            Self::Constant => f.write_str("constant"),
            Self::Variable => f.write_str("variable"),
        }
    }
}
