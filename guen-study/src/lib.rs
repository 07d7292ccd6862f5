//! Recordings, tables and pictures of the motion of guen systems.
//!
//! A stepper hands out states; this crate is what a program does with them:
//!
//! | question | answer |
//! | --- | --- |
//! | what happened? | [`Recording`]: times and states, in bounded memory if wanted, and CSV |
//! | what becomes of a `Trajectory`? | [`Export`]: recordings, tables, plots and pages of it |
//! | what of a motion through modes? | [`ExportModes`]: the same with its transitions, contacts and their forces |
//! | how long will it take? | [`Progress`]: a line on the terminal, or a few in a log file, during long runs |
//! | how good is it? | [`Monitor`] and its [`InvariantErrors`]; [`drift`] and [`residuals`] as curves |
//! | what are the numbers? | [`Table`], aligned for a terminal; [`significant`] for one number |
//! | where does it go? | [`replace_file`]: files that are written whole or not at all, as every writer here does |
//! | what does it look like? | [`Plot`], an SVG picture |
//! | how does it move? | `Viewer`, an HTML page that plays a recording; feature `viewer` |
//! | what if it begins elsewhere? | [`Ensemble`]: many motions in lanes and on threads |
//! | what if there is a graphics processor? | [`Ensemble::on`]: the same motions on a [`Device`] |
//! | what of a million of them? | [`Sweep`]: designs, rows in files, statistics, in parts that survive a kill |
//! | which method, which real, which step? | `Study`, with the feature `study`: the trade of speed for accuracy, measured |
//! | what did a scene leave out? | [`recover`]: integrals along a recorded run of a scene, with their errors |
//! | what went wrong? | [`StudyError`], [`RecoveryError`] |
//!
//! ```
//! use guen_runtime::{from_fn, steppers::Dop853};
//! use guen_study::{Plot, Progress, Recording, Table};
//!
//! let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
//! let start = [1.0, 0.0];
//! let mut recording = Recording::new(&["x", "v"]);
//! let mut progress = Progress::new(0.0, 10.0);
//! recording.record(0.0, &start);
//! Dop853::new(1e-10, 1e-10)
//!     .integrate(&oscillator, 0.0, &start, 10.0, progress.around(recording.observe()))
//!     .unwrap();
//! progress.finish();
//!
//! let mut table = Table::new(&["t", "x", "v"]);
//! for (t, &[x, v]) in recording.spread(5) {
//!     table.row(&[t, x, v]);
//! }
//! println!("{table}");
//!
//! let picture = Plot::new("oscillator").axes("t", "").line("x", recording.curve(0)).to_svg()?;
//! assert!(picture.starts_with("<svg"));
//! # Ok::<(), guen_study::StudyError>(())
//! ```
#![cfg_attr(docsrs, feature(doc_cfg))]
// Kernels are launched by code that is unsafe, in one file.
#![cfg_attr(not(feature = "cuda"), forbid(unsafe_code))]
#![deny(missing_docs)]

#[cfg(test)]
mod bad_input;
mod cell;
mod ensemble;
mod error;
#[cfg(feature = "serde")]
mod exact;
mod export;
mod file;
mod median;
mod modes;
mod monitor;
mod plot;
mod progress;
mod recording;
mod recovery;
#[cfg(feature = "serde")]
mod stored;
#[cfg(feature = "study")]
mod study;
mod sweep;
mod table;
#[cfg(feature = "viewer")]
mod viewer;

pub use ensemble::{Device, DeviceFault, DeviceMethod, DeviceRun, End, Ensemble, OnDevice, Sampled};
#[doc(hidden)]
pub use ensemble::{KernelBatch, KernelEngine, KernelOutcome};
pub use error::StudyError;
pub use export::Export;
pub use file::replace_file;
pub use median::median_with_interval;
pub use modes::ExportModes;
pub use monitor::{InvariantErrors, Monitor, drift, residuals};
pub use plot::Plot;
pub use progress::Progress;
pub use recording::Recording;
pub use recovery::{Nodes, Recovered, RecoveryError, recover};
#[cfg(feature = "serde")]
pub use stored::StoredRecording;
#[cfg(feature = "study")]
pub use study::{
    Caveat, Choice, Closures, Cost, Digits71, Ending, Failure, FailureKind, Forecast, Knob, Nearby, NoChoice,
    ReferenceReport, Row, ScanReport, Settings, Stopwatch, Study, StudyReport, Trade, Tried, Unit,
    pareto_front,
};
pub use sweep::{
    Assignment, ColumnStatistics, Coordinator, Design, DesignFault, Grid, Motions, Part, PartReport, Point,
    Rows, Sampling, Statistics, Summary, Sweep, SweepError, UnknownAxis, UnknownEntry, Worker,
};
pub use table::{Table, significant};
#[cfg(feature = "viewer")]
pub use viewer::{ContactFrame, Pose, Shape, Viewer};
