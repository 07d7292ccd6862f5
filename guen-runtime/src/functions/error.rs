//! The reasons why points make no table and values no grid.

use core::error::Error;
use core::fmt;

/// The reason why no [`Table`](crate::Table) goes through some points, or no [`Grid`](crate::Grid) through some values.
///
/// ```
/// use guen_runtime::{Table, TableError};
/// let unsorted = Table::new([(0.0, 1.0), (0.0, 2.0)]);
/// assert_eq!(unsorted, Err(TableError::NotIncreasing { index: 1, before: 0.0, value: 0.0 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TableError {
    /// There are fewer than two points along an axis.
    TooFew {
        /// The number of points.
        points: usize,
    },
    /// There are more points than the table holds.
    TooMany {
        /// The number of points.
        points: usize,
        /// The most that it holds.
        capacity: usize,
    },
    /// An argument is not larger than the one before it.
    NotIncreasing {
        /// The index of the point.
        index: usize,
        /// The argument before it.
        before: f64,
        /// The argument.
        value: f64,
    },
    /// An argument or a value is infinite or NaN.
    NotFinite {
        /// The index of the point.
        index: usize,
    },
    /// The slope between two points is beyond the range of the real.
    TooSteep {
        /// The index of the second point.
        index: usize,
    },
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { points } => {
                write!(f, "a table has two points or more along each axis, and these are {points}")
            }
            Self::TooMany { points, capacity } => {
                write!(f, "these are {points} points, and the table holds {capacity}")
            }
            Self::NotIncreasing { index, before, value } => {
                write!(f, "arguments increase: {value} at index {index} stands behind {before}")
            }
            Self::NotFinite { index } => write!(f, "the point at index {index} is infinite or NaN"),
            Self::TooSteep { index } => {
                write!(f, "the slope in front of the point at index {index} is not finite")
            }
        }
    }
}

impl Error for TableError {}
