//! Reasons for which designs are refused.

use std::fmt;

/// The reason for which a design is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DesignFault {
    /// The design has no point.
    NoPoints,
    /// The design has more than `2^53` points.
    TooManyPoints,
    /// Two axes have this name.
    Duplicate,
    /// An axis has no values.
    NoValues,
    /// A value is not finite.
    NotFinite,
    /// The ends of a range are not finite, or in the wrong order.
    Range,
    /// The ends of a logarithmic range are not positive and finite, or in the wrong order.
    LogarithmicRange,
    /// The mean of a normal distribution is not finite, or its deviation is negative, or so large that values of it are not finite.
    Normal,
    /// A row of a table does not have one number for each name.
    Rows,
    /// The sequence of Sobol has no more than 21,201 axes.
    TooManyAxes,
}

impl fmt::Display for DesignFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoPoints => "there is no point",
            Self::TooManyPoints => "there are more than 2^53 points",
            Self::Duplicate => "two axes have this name",
            Self::NoValues => "it has no values",
            Self::NotFinite => "a value is not finite",
            Self::Range => "the range needs finite ends, the lower one first",
            Self::LogarithmicRange => "a logarithmic range needs positive, finite ends, the lower one first",
            Self::Normal => {
                "a normal distribution needs a finite mean and a deviation that is not negative, and nine of them have to be finite"
            }
            Self::Rows => "every row needs one number for each name",
            Self::TooManyAxes => "the sequence of Sobol has no more than 21201 axes",
        })
    }
}
