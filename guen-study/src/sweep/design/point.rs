//! Points of designs, and names that they do not have.

use std::error::Error;
use std::fmt;

/// A point of a design, for the closure that makes a motion of it.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    pub(in crate::sweep) index: u64,
    pub(in crate::sweep) names: &'a [String],
    pub(in crate::sweep) values: &'a [f64],
}

impl Point<'_> {
    /// The number of the point among those of the design, which is that of the motion.
    pub fn index(&self) -> u64 {
        self.index
    }

    /// The values, one for each axis.
    pub fn values(&self) -> &[f64] {
        self.values
    }

    /// The value along the axis of this name.
    ///
    /// # Errors
    ///
    /// [`UnknownAxis`]: a sweep whose closure passes it on is refused before any motion is computed.
    pub fn get(&self, name: &str) -> Result<f64, UnknownAxis> {
        let place = self.names.iter().position(|own| own == name);
        place
            .and_then(|place| self.values.get(place).copied())
            .ok_or_else(|| UnknownAxis { name: name.to_owned(), known: self.names.to_vec() })
    }
}

/// A name that is none of a design's axes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownAxis {
    /// The name that was asked for.
    pub name: String,
    /// The names of the axes.
    pub known: Vec<String>,
}

impl fmt::Display for UnknownAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the design has no axis `{}`, but {}", self.name, self.known.join(", "))
    }
}

impl Error for UnknownAxis {}

/// An axis that should replace an entry of the state and has another name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownEntry {
    /// The name of the axis.
    pub name: String,
    /// The names of the state's entries.
    pub known: &'static [&'static str],
}

impl fmt::Display for UnknownEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the state has no entry `{}` for the axis of this name, but {}",
            self.name,
            self.known.join(", ")
        )
    }
}

impl Error for UnknownEntry {}
