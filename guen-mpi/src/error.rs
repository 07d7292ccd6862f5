//! Errors of a run over ranks.

use std::fmt;

use guen_study::SweepError;
use mpi::Rank;

/// The reason why a run over ranks has ended. All ranks end with an error if one does; what is finished is not lost.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// The sweep was refused on this rank, or could not go on.
    Sweep(SweepError),
    /// The sweep has ended on another rank.
    Elsewhere {
        /// The rank.
        rank: Rank,
        /// The error there, in words.
        cause: String,
    },
    /// MPI has been initialised for programs of one thread.
    Threads,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sweep(error) => error.fmt(f),
            Self::Elsewhere { rank, cause } => write!(f, "rank {rank} has ended the run: {cause}"),
            Self::Threads => f.write_str(
                "MPI was initialised for one thread: call `mpi::initialize_with_threading(Threading::Funneled)`",
            ),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Sweep(error) => Some(error),
            _ => None,
        }
    }
}

impl From<SweepError> for Error {
    fn from(error: SweepError) -> Self {
        Self::Sweep(error)
    }
}
