//! Sweeps of guen systems over the ranks of MPI.
//!
//! [`run`] shares a [`Sweep`] between all ranks, chunk by chunk: a rank that is done with one gets the next, so that slow motions and slow machines
//! hold nobody up. The folder has the files of a run in one part, to the bit, however many ranks there were; and a run that was killed is gone on with by the
//! same call, with any number of ranks.
//!
//! ```no_run
//! use guen_mpi::mpi::{self, Threading};
//! use guen_runtime::from_fn;
//! use guen_study::{Design, Sweep};
//!
//! let (universe, _) = mpi::initialize_with_threading(Threading::Funneled).expect("MPI is not initialised yet");
//! // Any sweep: those of declared systems in lanes are the quickest.
//! let sweep = Sweep::over(Design::random(1_000_000, 1).uniform("k", 1.0, 9.0), |point| {
//!     let k = point.get("k")?;
//!     Ok((from_fn(move |_t: f64, &[x, v]: &[f64; 2]| [v, -k * x]), [1.0, 0.0]))
//! })
//! .simulations([("x", "m")], |simulation| simulation.run(0.0..10.0).map(|motion| [motion.end()[0]]));
//! let share = guen_mpi::run(&sweep, "/scratch/study", &universe.world())?;
//! if let Some((_, summary)) = share.whole {
//!     println!("{}", summary.digest());
//! }
//! # Ok::<(), guen_mpi::Error>(())
//! ```
//!
//! It needs a library of MPI and, to be built, libclang: `workshop/cluster/install_mpi` of the repository installs both.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod error;
mod messages;
mod pool;
mod rank;

use std::path::Path;

use guen_study::{PartReport, Summary, Sweep};
pub use mpi;
use mpi::Threading;
use mpi::topology::Communicator;

pub use error::Error;

/// The work of one rank, and on rank 0 the result.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// The chunks that this rank has computed.
    pub computed: u64,
    /// On rank 0 the work of all ranks, and the statistics of all motions; none on the others.
    pub whole: Option<(PartReport, Summary)>,
}

/// Computes the motions of a sweep that are missing in a folder, on all ranks of a communicator; and puts them together.
///
/// Every rank calls it with the same sweep and a folder that all of them see. Rank 0 hands out chunks, and keeps the record, beside its own motions. A rank
/// computes on as many threads as the sweep asks for, or has processors: `mpirun` gives each rank one of its own, unless it is told otherwise.
///
/// | what happens | what is left |
/// | --- | --- |
/// | a rank is killed, or its machine dies | MPI ends the other ranks. The same call goes on: it computes the chunks that were at work, and those of the last two seconds, again, and no others |
/// | a motion fails | a row with its cause |
/// | a rank cannot write, or is of another program | all ranks end with an error, when their chunks are finished and counted |
/// | a closure of the sweep panics | the rank ends all others by `MPI_Abort` |
///
/// ```no_run
/// # use guen_study::{Sweep, Summary};
/// # use guen_mpi::mpi::topology::SimpleCommunicator;
/// # fn study(sweep: &Sweep, world: &SimpleCommunicator) -> Result<Option<Summary>, guen_mpi::Error> {
/// let share = guen_mpi::run(sweep, "/scratch/study", world)?;
/// println!("{} chunks here", share.computed);
/// # Ok(share.whole.map(|(_, summary)| summary))
/// # }
/// ```
///
/// # Errors
///
/// - [`Error::Sweep`]: this rank's own, as a folder that cannot be written.
/// - [`Error::Elsewhere`]: another rank's.
/// - [`Error::Threads`]: MPI was not initialised for programs with threads.
pub fn run(sweep: &Sweep<'_>, folder: impl AsRef<Path>, world: &impl Communicator) -> Result<Share, Error> {
    if mpi::environment::threading_support() < Threading::Funneled {
        return Err(Error::Threads);
    }
    // Messages of the caller cannot be taken for ours.
    let world = world.duplicate();
    if world.rank() == 0 {
        rank::first(sweep, folder.as_ref(), &world)
    } else {
        rank::other(sweep, folder.as_ref(), &world)
    }
}
