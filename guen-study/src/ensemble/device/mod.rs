//! Ensembles on graphics processors: the same motions, one for each thread of the device, by the text of C that the system provides.
//!
//! Motions that end in order are those of the CPU, to the bit. One that does not, or in whose states a guard finds a fault, is computed again on
//! the CPU, which tells the cause.

#[cfg(feature = "cuda")]
mod cuda;
mod engine;
mod fault;
mod method;

use std::fmt;
use std::ops::Range;

use guen_runtime::steppers::{Guard, IntegrationResult, Outcome, Statistics};
use guen_runtime::{Kernel, Laned, Sourced};

use super::threads::{in_turn, processors};
use super::{End, Ensemble, Sampled};
pub use engine::{KernelBatch, KernelEngine, KernelOutcome};
pub use fault::DeviceFault;
pub use method::DeviceMethod;

/// The device that computes motions.
///
/// ```
/// use guen_study::Device;
/// assert_eq!(Device::default(), Device::Cpu);
/// assert_eq!(Device::Cuda(1).to_string(), "CUDA device 1");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Device {
    /// The processor of this machine, with its lanes and threads.
    #[default]
    Cpu,
    /// The graphics processor of this number, counted from zero, through CUDA: with the feature `cuda`.
    Cuda(usize),
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cpu => f.write_str("CPU"),
            Self::Cuda(number) => write!(f, "CUDA device {number}"),
        }
    }
}

/// Results of motions, with the device that computed them.
#[derive(Clone, Debug)]
pub struct DeviceRun<T> {
    /// The results, in the order of the members.
    pub motions: Vec<T>,
    /// The device that computed them.
    pub device: Device,
    /// The reason for which that is not the device that was asked for.
    pub fault: Option<DeviceFault>,
    /// The number of motions that were computed again on the CPU, because they failed on the device or a guard found a fault.
    pub again: usize,
}

/// An ensemble on a device, which [`Ensemble::on`] returns.
pub struct OnDevice<S, const N: usize> {
    ensemble: Ensemble<S, N>,
    /// The device that was asked for.
    asked: Device,
    engine: Result<Option<Box<dyn KernelEngine>>, DeviceFault>,
    batch: Option<usize>,
}

impl<S: fmt::Debug, const N: usize> fmt::Debug for OnDevice<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OnDevice")
            .field("ensemble", &self.ensemble)
            .field("device", &self.device())
            .field("fault", &self.fault())
            .finish_non_exhaustive()
    }
}

impl<S: Laned<N> + Sourced<N> + Sync, const N: usize> Ensemble<S, N> {
    /// Puts the ensemble on a device. Its systems are those that provide a text of C: `provide source;`.
    ///
    /// - Motions have the same bits as on the CPU, where the text promises that: sums, products, quotients, square roots, sines and cosines.
    /// - If there is no such device, motions are computed on the CPU. A line on standard error says why, unless the environment variable `GUEN_PROGRESS` is
    ///   `never`, and so do [`OnDevice::fault`] and [`DeviceRun::fault`].
    /// - Of the checks of a [`Guard`] a device makes two after every step: that the state is finite, and that functions that must not vanish
    ///   keep their sign and do not change too fast. The others are made on the CPU at both ends of a motion and at the states that are kept, but for that of the
    ///   errors of single steps. A motion with a fault is computed again on the CPU, with all checks, and has that result. An energy that is
    ///   off and back again at the next of these states, or a step that is too long and shows in none of them, stops the motion on the CPU alone.
    ///
    /// ```
    /// use guen_runtime::lanes::Lanes;
    /// use guen_runtime::steppers::Rk4;
    /// use guen_runtime::{Laned, Real, Source, Sourced, System};
    /// use guen_study::{Device, Ensemble};
    ///
    /// /// What the macro generates for a declared system: here `x' = -rate x`.
    /// #[derive(Clone, Copy)]
    /// struct Decay<R>(R);
    /// impl<R: Real> System<R, 1> for Decay<R> {
    ///     fn rhs(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
    ///         [-self.0 * x]
    ///     }
    /// }
    /// impl Laned<1> for Decay<f64> {
    ///     type Over<L: Lanes> = Decay<L>;
    ///     fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Decay<L> {
    ///         Decay(L::from_fn(|lane| member(lane).0))
    ///     }
    /// }
    /// impl Sourced<1> for Decay<f64> {
    ///     const SOURCE: Source = Source {
    ///         name: "decay",
    ///         program: "#define decay_CONSTANTS 1\n#define decay_PREPARED 0\n#define decay_STATES 1\n#define decay_INPUTS 0\n#define decay_DOMAIN 0\n\
    ///             GUEN_FUNCTION void decay_rhs(const double *c, const double *k, double t, const double *s, const double *u, double *r)\n\
    ///             {\n    (void)k;\n    (void)t;\n    (void)u;\n    r[0] = -c[0] * s[0];\n}\n\
    ///                 GUEN_FUNCTION void decay_domain(const double *c, const double *k, double t, const double *s, double *d)\n\
    ///                 {\n    (void)c;\n    (void)k;\n    (void)t;\n    (void)s;\n    (void)d;\n}\n",
    ///         steps: true,
    ///         adaptive: true,
    ///         series: false,
    ///     };
    ///     const NUMBERS: usize = 1;
    ///     fn numbers(&self) -> impl Iterator<Item = f64> {
    ///         [self.0].into_iter()
    ///     }
    /// }
    ///
    /// let members = (0..100).map(|i| (Decay(f64::from(i) / 10.0), [1.0]));
    /// let run = Ensemble::of_systems(members).on(Device::Cuda(0)).integrate(&Rk4::new(0.01), 0.0, 1.0);
    /// if let Some(fault) = &run.fault {
    ///     println!("computed on the CPU: {fault}");
    /// }
    /// assert!((run.motions[10].as_ref().unwrap().state[0] - f64::exp(-1.0)).abs() < 1e-9);
    /// ```
    pub fn on(self, device: Device) -> OnDevice<S, N> {
        let engine = match device {
            Device::Cpu => Ok(None),
            Device::Cuda(number) => cuda(number).map(Some),
        };
        if let Err(fault) = &engine
            && !self.silent
            && std::env::var_os("GUEN_PROGRESS").is_none_or(|word| word != "never")
        {
            eprintln!("guen: {fault}; motions are computed on the CPU");
        }
        OnDevice { ensemble: self, asked: device, engine, batch: None }
    }

    /// Puts the ensemble on a stand-in for a device.
    #[doc(hidden)]
    pub fn on_engine(self, engine: Box<dyn KernelEngine>) -> OnDevice<S, N> {
        OnDevice { ensemble: self, asked: Device::Cuda(0), engine: Ok(Some(engine)), batch: None }
    }
}

#[cfg(feature = "cuda")]
fn cuda(number: usize) -> Result<Box<dyn KernelEngine>, DeviceFault> {
    Ok(Box::new(cuda::Cuda::open(number)?))
}

#[cfg(not(feature = "cuda"))]
fn cuda(_number: usize) -> Result<Box<dyn KernelEngine>, DeviceFault> {
    Err(DeviceFault::NotBuilt)
}

impl<S, const N: usize> OnDevice<S, N> {
    /// Computes so many motions at a time on the device. By default as many as take half a gigabyte there, and at most a million.
    pub fn with_batch(self, motions: usize) -> Self {
        Self { batch: Some(motions.max(1)), ..self }
    }

    /// The device that computes the motions.
    pub fn device(&self) -> Device {
        if self.fault().is_some() { Device::Cpu } else { self.asked }
    }

    /// The reason for which that is not the device that was asked for.
    pub fn fault(&self) -> Option<&DeviceFault> {
        self.engine.as_ref().err()
    }
}

impl<S: Laned<N> + Sourced<N> + Sync, const N: usize> OnDevice<S, N> {
    /// Integrates every member from `t0` to `t1`, as [`Ensemble::integrate`] does.
    pub fn integrate<M: DeviceMethod>(&self, method: &M, t0: f64, t1: f64) -> DeviceRun<End<N>> {
        self.run(method, t0, &[t1], false, |sampled| sampled.end)
    }

    /// Integrates every member from `t0` through the given times and keeps the states at them, as [`Ensemble::sample`] does. Methods with a fixed step
    /// land on the times, which may turn back. [`Dop853`](guen_runtime::steppers::Dop853) goes to the last one and interpolates; its times run in order.
    pub fn sample<M: DeviceMethod>(&self, method: &M, t0: f64, times: &[f64]) -> DeviceRun<Sampled<N>> {
        self.run(method, t0, times, true, |sampled| sampled)
    }

    fn run<M: DeviceMethod, T>(
        &self,
        method: &M,
        t0: f64,
        times: &[f64],
        keep: bool,
        result: impl Fn(Sampled<N>) -> T,
    ) -> DeviceRun<T> {
        let on_cpu = |fault| {
            let motions = method.on_cpu(&self.ensemble, t0, times, keep).into_iter().map(&result).collect();
            DeviceRun { motions, device: Device::Cpu, fault, again: 0 }
        };
        let engine = match &self.engine {
            Ok(Some(engine)) => engine.as_ref(),
            Ok(None) => return on_cpu(None),
            Err(fault) => return on_cpu(Some(fault.clone())),
        };
        let (kind, settings) = method.in_kernel();
        let Some(kernel) = S::SOURCE.kernel(kind) else {
            return on_cpu(Some(DeviceFault::NoMethod { method: kind.stepper() }));
        };
        let task = Task { ensemble: &self.ensemble, kernel, settings, t0, times, keep };
        let mut all = match task.on_device(engine, self.batch) {
            Ok(all) => all,
            Err(fault) => return on_cpu(Some(fault)),
        };
        // The motions without a result here have one there.
        let missing: Vec<usize> =
            all.iter().enumerate().filter(|(_, motion)| motion.is_none()).map(|(place, _)| place).collect();
        let again = missing.len();
        let Ensemble { starts, threads, backend, width, .. } = &self.ensemble;
        let mut rest = Ensemble::of_systems(missing.iter().map(|i| (self.ensemble.system(*i), starts[*i])));
        (rest.threads, rest.backend, rest.width) = (*threads, *backend, *width);
        let found = method.on_cpu(&rest.silent(), t0, times, keep);
        for (place, motion) in missing.into_iter().zip(found) {
            all[place] = Some(motion);
        }
        let motions = all.into_iter().flatten().map(result).collect();
        DeviceRun { motions, device: self.asked, fault: None, again }
    }
}

/// The task of integrating all members on a device.
struct Task<'a, S, const N: usize> {
    ensemble: &'a Ensemble<S, N>,
    kernel: Kernel,
    settings: [f64; 4],
    t0: f64,
    times: &'a [f64],
    keep: bool,
}

impl<S: Laned<N> + Sourced<N> + Sync, const N: usize> Task<'_, S, N> {
    /// The motions that ended in order, batch by batch; none for those that did not.
    fn on_device(
        &self,
        engine: &dyn KernelEngine,
        batch: Option<usize>,
    ) -> Result<Vec<Option<Sampled<N>>>, DeviceFault> {
        let (count, size) = (self.ensemble.len(), batch.unwrap_or_else(|| self.usual_batch()));
        let mut progress = self.ensemble.progress();
        let mut all = Vec::with_capacity(count);
        for first in (0..count).step_by(size) {
            let range = first..count.min(first + size);
            let batch = self.packed(range.clone());
            let outcome = engine.run(&self.kernel, &batch)?;
            let lengths = [outcome.ends.len(), outcome.samples.len(), outcome.work.len()];
            if lengths != batch.lengths() {
                let reason = format!("arrays of {lengths:?} words in place of {:?}", batch.lengths());
                return Err(DeviceFault::Stopped { reason });
            }
            all.extend(self.unpacked(range.clone(), &outcome));
            progress.at(range.end as f64);
        }
        Ok(all)
    }

    /// The number of motions that take half a gigabyte.
    fn usual_batch(&self) -> usize {
        const BYTES: usize = 1 << 29;
        const MOST: usize = 1 << 20;
        let samples = if self.keep { self.times.len() * N } else { 0 };
        let words = S::NUMBERS + N + (N + 1) + 4 + samples;
        (BYTES / (8 * words)).clamp(1, MOST)
    }

    /// The arrays of some members.
    fn packed(&self, range: Range<usize>) -> KernelBatch<'_> {
        let Ensemble { systems, starts, .. } = self.ensemble;
        let systems = if systems.len() == 1 { &systems[..] } else { &systems[range.clone()] };
        let starts = &starts[range];
        let mut numbers = vec![0.0; S::NUMBERS * systems.len()];
        for (place, system) in systems.iter().enumerate() {
            for (row, number) in system.numbers().enumerate() {
                numbers[row * systems.len() + place] = number;
            }
        }
        KernelBatch {
            motions: starts.len(),
            systems: systems.len(),
            numbers,
            starts: (0..N).flat_map(|entry| starts.iter().map(move |start| start[entry])).collect(),
            t0: self.t0,
            settings: self.settings,
            times: self.times,
            keep: self.keep,
            entries: N,
        }
    }

    /// The motions of some members, on all threads; none for those that did not end in order.
    fn unpacked(&self, range: Range<usize>, outcome: &KernelOutcome) -> Vec<Option<Sampled<N>>> {
        /// Motions whose ends take as long to check as a thread to start.
        const PORTION: usize = 64;
        let KernelOutcome { ends, samples, work } = outcome;
        let count = range.len();
        let threads = self.ensemble.threads.unwrap_or_else(processors);
        let of_sample = if self.keep { self.times.len() * N } else { 0 };
        let motion = |place: usize| {
            let row = |row: usize| work[row * count + place];
            let index = range.start + place;
            let (system, start) = (self.ensemble.system(index), &self.ensemble.starts[index]);
            let state: [f64; N] = std::array::from_fn(|entry| ends[entry * count + place]);
            let time = ends[N * count + place];
            if row(0) != 0 {
                return None;
            }
            let states = samples[place * of_sample..(place + 1) * of_sample].as_chunks().0.to_vec();
            let seen = self.times.iter().copied().zip(states.iter().copied()).chain([(time, state)]);
            Guard::default().check_states(system, (self.t0, start), seen).ok()?;
            let [evaluations, accepted, rejected] = [row(1), row(2), row(3)];
            let statistics = Statistics { evaluations, accepted, rejected, ..Statistics::default() };
            let end = IntegrationResult { time, state, outcome: Outcome::Arrived, statistics };
            Some(Sampled { states, end: Ok(end) })
        };
        let progress = crate::progress::Progress::new(0.0, 1.0).silent();
        in_turn(count, PORTION, threads, progress, |range| range.map(motion).collect())
    }
}
