//! The border to a device: arrays go in, arrays come out.

use guen_runtime::Kernel;

use super::DeviceFault;

/// Motions for a kernel, with the arrays that it reads. An entry of all motions is a row.
#[derive(Clone, Debug)]
pub struct KernelBatch<'a> {
    /// The number of motions.
    pub motions: usize,
    /// The number of systems: one for all motions, or as many.
    pub systems: usize,
    /// Constants, prepared values and inputs, a row of `systems` for each.
    pub numbers: Vec<f64>,
    /// The states at the beginning, a row of `motions` for each entry.
    pub starts: Vec<f64>,
    /// The time at the beginning.
    pub t0: f64,
    /// The settings of the method.
    pub settings: [f64; 4],
    /// The times to stop at.
    pub times: &'a [f64],
    /// Whether the states at these times are kept.
    pub keep: bool,
    /// The number of entries of a state.
    pub entries: usize,
}

impl KernelBatch<'_> {
    /// The lengths of the arrays of an outcome.
    pub fn lengths(&self) -> [usize; 3] {
        let samples = if self.keep { self.motions * self.times.len() * self.entries } else { 0 };
        [(self.entries + 1) * self.motions, samples, 4 * self.motions]
    }
}

/// The arrays that a kernel has written.
#[derive(Clone, Debug)]
pub struct KernelOutcome {
    /// The states and the times at the end, a row for each entry.
    pub ends: Vec<f64>,
    /// The states at the times to stop at, those of a motion together.
    pub samples: Vec<f64>,
    /// Rows of what stopped each motion, evaluations, accepted and rejected steps.
    pub work: Vec<u64>,
}

/// Something that runs kernels: a device, or a stand-in for one in tests.
pub trait KernelEngine: Send + Sync {
    /// Compiles the kernel, if that is not done yet, and runs it.
    ///
    /// # Errors
    ///
    /// The reason for which there is no outcome.
    fn run(&self, kernel: &Kernel, batch: &KernelBatch<'_>) -> Result<KernelOutcome, DeviceFault>;
}
