//! Errors of a sweep. A motion that fails is none: it is a row with its cause.

use std::error::Error;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::design::{DesignFault, UnknownAxis, UnknownEntry};
use crate::error::StudyError;

/// The manifest, of which an error says something else than of other files.
pub(super) const MANIFEST: &str = "sweep.txt";

/// The reason why a sweep was refused or could not go on. Nothing of what it has finished is lost: a further run into the same folder
/// goes on.
#[derive(Debug)]
#[non_exhaustive]
pub enum SweepError {
    /// The design makes no sense.
    Design {
        /// The axis, if it is that of one.
        axis: Option<String>,
        /// The reason.
        fault: DesignFault,
    },
    /// The closure that makes a motion of a point asks for an axis that the design does not have.
    UnknownAxis(UnknownAxis),
    /// An axis of the design should replace an entry of the state that there is not.
    UnknownEntry(UnknownEntry),
    /// A statistic is asked for a column that there is not.
    UnknownColumn {
        /// The name that was asked for.
        name: String,
        /// The names of the columns.
        known: Vec<String>,
    },
    /// Two columns of the rows would have this name.
    DuplicateColumn {
        /// The name.
        name: String,
    },
    /// A histogram needs a range with finite ends, the lower one first, and 1 to 1,000,000 bins; a column has one histogram at most.
    Histogram {
        /// The column.
        column: String,
    },
    /// A sweep has no part of this number.
    Part {
        /// The number that was asked for, from zero on.
        part: u64,
        /// The number of parts.
        parts: u64,
    },
    /// A file or folder could not be read or written: the disk is full, the folder cannot be written, or it has no locks.
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// Another process is at work on the same part in the same folder.
    Busy {
        /// The folder.
        path: PathBuf,
        /// The part.
        part: u64,
        /// The number of parts.
        parts: u64,
    },
    /// The folder has the results of another declaration: the text of the system or scene was edited since.
    OtherDeclaration {
        /// The manifest in the folder.
        path: PathBuf,
        /// The digest of the declaration there: [`Simulate::DECLARATION`](guen_runtime::Simulate::DECLARATION).
        found: String,
        /// The digest of the declaration that was to be run.
        expected: String,
    },
    /// The folder has the results of another sweep: of another design, method or closure.
    OtherSweep {
        /// The manifest in the folder.
        path: PathBuf,
        /// The first line in which it differs.
        found: String,
        /// The line of the sweep that was to be run.
        expected: String,
    },
    /// The folder has the results of this sweep in another number of parts.
    OtherParts {
        /// The manifest in the folder.
        path: PathBuf,
        /// The number of parts there.
        found: u64,
        /// The number of parts that was asked for.
        asked: u64,
    },
    /// A file has been damaged, or cut short.
    Corrupt {
        /// The file.
        path: PathBuf,
        /// The damage.
        reason: &'static str,
    },
    /// Parts are to be merged, of which some are not finished.
    Unfinished {
        /// The first motion that is missing.
        first: u64,
        /// The number of motions that are missing.
        missing: u64,
    },
    /// Folders are to be merged, of which two have the same motions.
    Overlap {
        /// The first motion that is there twice.
        first: u64,
    },
    /// A motion that was computed again has other bits: the closure does not make the same motion of the same point, or the machine errs.
    NotReproducible {
        /// The first motion of the chunk that differs.
        first: u64,
    },
    /// A message between a coordinator and a worker cannot be used.
    Message {
        /// The reason.
        reason: &'static str,
    },
    /// The library that writes Parquet has failed.
    #[cfg(feature = "parquet")]
    Parquet {
        /// The error of the library.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl fmt::Display for SweepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Design { axis: Some(axis), fault } => write!(f, "axis `{axis}` of the design: {fault}"),
            Self::Design { axis: None, fault } => write!(f, "the design: {fault}"),
            Self::UnknownAxis(error) => error.fmt(f),
            Self::UnknownEntry(error) => error.fmt(f),
            Self::UnknownColumn { name, known } => {
                write!(f, "the rows have no column `{name}`, but {}", known.join(", "))
            }
            Self::DuplicateColumn { name } => write!(f, "two columns of the rows are called `{name}`"),
            Self::Histogram { column } => write!(
                f,
                "the histogram of `{column}` needs a range with finite ends, the lower one first, and 1 to 1000000 bins; a column has one at most"
            ),
            Self::Part { part, parts } => {
                write!(f, "there is no part {part} of {parts}: parts count from 0 to one below their number")
            }
            Self::Io { path, source } => write!(f, "`{}`: {source}", path.display()),
            Self::Busy { path, part, parts } => write!(
                f,
                "another process is at work on part {part} of {parts} in `{}`: wait for its end, or take another part or folder",
                path.display()
            ),
            Self::OtherDeclaration { path, found, expected } => write!(
                f,
                "`{}` belongs to another declaration: its digest there is {found}, and that of the declared system is {expected}; take another folder, or undo the change of the declaration",
                path.display()
            ),
            Self::OtherSweep { path, found, expected } => write!(
                f,
                "`{}` belongs to another sweep: it says `{found}`, where this one has `{expected}`; take another folder",
                path.display()
            ),
            Self::OtherParts { path, found, asked } => write!(
                f,
                "`{}` has this sweep in {found} parts, not in {asked}: go on with {found}, or take another folder",
                path.display()
            ),
            Self::Corrupt { path, reason } => {
                write!(f, "`{}` is damaged: {reason}; ", path.display())?;
                f.write_str(if path.file_name().is_some_and(|name| name == MANIFEST) {
                    "remove it and run again: what is finished is kept"
                } else {
                    "a further run of its part computes anew what is missing"
                })
            }
            Self::Unfinished { first, missing } => {
                write!(f, "{missing} motions are not computed yet, the first of them is motion {first}")
            }
            Self::Overlap { first } => {
                write!(f, "two of the folders have the same motions, from motion {first} on")
            }
            Self::NotReproducible { first } => write!(
                f,
                "motions from {first} on have other bits than before: the closure does not make the same motion of the same point, or the machine errs"
            ),
            Self::Message { reason } => {
                write!(f, "a message between the coordinator and a worker cannot be used: {reason}")
            }
            #[cfg(feature = "parquet")]
            Self::Parquet { source } => write!(f, "cannot write Parquet: {source}"),
        }
    }
}

impl Error for SweepError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            Self::UnknownAxis(error) => Some(error),
            Self::UnknownEntry(error) => Some(error),
            #[cfg(feature = "parquet")]
            Self::Parquet { source } => Some(&**source),
            _ => None,
        }
    }
}

impl From<StudyError> for SweepError {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Io { path, source } => Self::Io { path, source },
            other => Self::Io { path: PathBuf::new(), source: io::Error::other(other) },
        }
    }
}

/// Attaches the file or folder.
pub(super) fn at(path: &Path) -> impl FnOnce(io::Error) -> SweepError {
    let path = path.to_path_buf();
    move |source| SweepError::Io { path, source }
}
