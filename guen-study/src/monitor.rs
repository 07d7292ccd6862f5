//! Monitors of invariants: how well a run keeps the energy and the holonomic constraints that its exact motion would
//! keep.

use std::fmt;

use guen_runtime::Monitored;

use crate::recording::Recording;
use crate::table::significant;

/// The digits of an error that mean something.
const ERROR_DIGITS: usize = 2;

/// The largest errors of the invariants over a run.
///
/// ```text
/// energy_error = max_t |h(t) - h(t_0)| / h_scale        residual = max_t max_i |f_i(t)|
/// ```
///
/// - `h`: the energy integral, `f_i`: the left sides of the holonomic constraints, both as
///   [`Monitored`] computes them.
/// - `h_scale`: `|h(t_0)|`, or one if that is zero: then the error is absolute. A system whose energy passes
///   near zero needs a scale of its own: [`Monitor::with_scale`].
/// - A quantity that is not finite counts as an infinite error.
///
/// The energy says something only of a system that keeps it; it tells nothing of errors along the level set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvariantErrors {
    /// The number of states looked at.
    pub samples: u64,
    /// The energy that all others are compared with: that of the first state.
    pub energy_start: f64,
    /// The energy by which differences of energies are divided.
    pub energy_scale: f64,
    /// The largest relative error of the energy.
    pub energy_error: f64,
    /// The time at which it occurred first.
    pub energy_error_time: f64,
    /// The largest residual of the holonomic constraints.
    pub residual: f64,
    /// The time at which it occurred first.
    pub residual_time: f64,
}

impl InvariantErrors {
    /// The invariants along the samples that a recording kept; `None` if it is empty.
    ///
    /// Samples that a bounded recording dropped are not looked at; a [`Monitor`] beside the recording sees all.
    ///
    /// Cost: one energy and one residual for each sample.
    pub fn along<S, const N: usize>(system: &S, recording: &Recording<N>) -> Option<Self>
    where
        S: Monitored<f64, N> + ?Sized,
    {
        let (t0, x0) = recording.first()?;
        let mut monitor = Monitor::new(system, t0, x0);
        recording.iter().skip(1).for_each(|(t, x)| monitor.at(t, x));
        Some(monitor.invariants())
    }

    /// Whether both errors are at most what is allowed.
    pub fn within(&self, energy_error: f64, residual: f64) -> bool {
        self.energy_error <= energy_error && self.residual <= residual
    }

    fn record(&mut self, t: f64, energy: f64, residual: f64) {
        let error = or_infinite((energy - self.energy_start) / self.energy_scale);
        if error > self.energy_error {
            (self.energy_error, self.energy_error_time) = (error, t);
        }
        let residual = or_infinite(residual);
        if residual > self.residual {
            (self.residual, self.residual_time) = (residual, t);
        }
        self.samples += 1;
    }
}

impl fmt::Display for InvariantErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fn largest(f: &mut fmt::Formatter<'_>, what: &str, error: f64, time: f64) -> fmt::Result {
            write!(f, "largest {what}: {}", significant(error, ERROR_DIGITS))?;
            if error > 0.0 { write!(f, " at t = {}", significant(time, 4)) } else { Ok(()) }
        }
        let absolute = self.energy_start == 0.0 && self.energy_scale == 1.0;
        let energy = if absolute { "energy error" } else { "relative energy error" };
        largest(f, energy, self.energy_error, self.energy_error_time)?;
        f.write_str("; ")?;
        largest(f, "residual", self.residual, self.residual_time)
    }
}

/// Watches the invariants of a system while it is integrated, step by step and in constant memory.
///
/// ```
/// use guen_runtime::{Monitored, System, steppers::Rk4};
/// use guen_study::Monitor;
/// use std::ops::ControlFlow;
///
/// struct Oscillator;
/// impl System<f64, 2> for Oscillator {
///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -x]
///     }
/// }
/// impl Monitored<f64, 2> for Oscillator {
///     fn energy(&self, _t: f64, &[x, v]: &[f64; 2]) -> f64 {
///         (v * v + x * x) / 2.0
///     }
///     fn residual(&self, _t: f64, _state: &[f64; 2]) -> f64 {
///         0.0
///     }
/// }
///
/// let start = [1.0, 0.0];
/// let mut monitor = Monitor::new(&Oscillator, 0.0, &start);
/// Rk4::new(0.01)
///     .integrate(&Oscillator, 0.0, &start, 10.0, |t, x| {
///         monitor.at(t, x);
///         ControlFlow::Continue(())
///     })
///     .unwrap();
/// let invariants = monitor.invariants();
/// assert!(invariants.within(1e-10, 0.0), "{invariants}");
/// assert_eq!(invariants.samples, 1001);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Monitor<S> {
    system: S,
    found: InvariantErrors,
}

impl<S> Monitor<S> {
    /// Begins with the state that all others are compared with. A reference to a system serves as one.
    pub fn new<const N: usize>(system: S, t: f64, state: &[f64; N]) -> Self
    where
        S: Monitored<f64, N>,
    {
        let energy = system.energy(t, state);
        let size = energy.abs();
        let mut found = InvariantErrors {
            samples: 0,
            energy_start: energy,
            energy_scale: if size > 0.0 && size.is_finite() { size } else { 1.0 },
            energy_error: 0.0,
            energy_error_time: t,
            residual: 0.0,
            residual_time: t,
        };
        found.record(t, energy, system.residual(t, state));
        Self { system, found }
    }

    /// Sets an energy that is typical of the motion, for errors to be relative to. To be set before further states
    /// are looked at.
    pub fn with_scale(mut self, energy: f64) -> Self {
        self.found.energy_scale = energy.abs();
        self
    }

    /// Looks at a further state.
    pub fn at<const N: usize>(&mut self, t: f64, state: &[f64; N])
    where
        S: Monitored<f64, N>,
    {
        self.found.record(t, self.system.energy(t, state), self.system.residual(t, state));
    }

    /// Returns the largest errors found so far.
    pub fn invariants(&self) -> InvariantErrors {
        self.found
    }
}

/// The relative error of the energy over time, with its sign: a curve for a [`Plot`](crate::Plot). Scaled as in
/// [`InvariantErrors`]; empty if the recording is.
///
/// Cost: one energy for each sample, when the iterator is asked for it.
pub fn drift<'a, S, const N: usize>(
    system: &'a S,
    recording: &'a Recording<N>,
) -> impl Iterator<Item = (f64, f64)> + 'a
where
    S: Monitored<f64, N> + ?Sized,
{
    let start = recording.first().map(|(t, x)| Monitor::new(system, t, x).invariants());
    recording.iter().filter_map(move |(t, x)| {
        let InvariantErrors { energy_start, energy_scale, .. } = start?;
        Some((t, (system.energy(t, x) - energy_start) / energy_scale))
    })
}

/// The largest residual of the holonomic constraints over time: a curve for a [`Plot`](crate::Plot).
///
/// Cost: one residual for each sample, when the iterator is asked for it.
pub fn residuals<'a, S, const N: usize>(
    system: &'a S,
    recording: &'a Recording<N>,
) -> impl Iterator<Item = (f64, f64)> + 'a
where
    S: Monitored<f64, N> + ?Sized,
{
    recording.iter().map(move |(t, x)| (t, system.residual(t, x)))
}

/// The size of a number; of one that is not finite, infinity, so that a comparison cannot pass over a NaN.
fn or_infinite(value: f64) -> f64 {
    if value.is_finite() { value.abs() } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use guen_runtime::System;

    /// A system whose state holds energy and residual themselves.
    struct Given;

    impl System<f64, 2> for Given {
        fn rhs(&self, _t: f64, _state: &[f64; 2]) -> [f64; 2] {
            [0.0; 2]
        }
    }

    impl Monitored<f64, 2> for Given {
        fn energy(&self, _t: f64, state: &[f64; 2]) -> f64 {
            state[0]
        }

        fn residual(&self, _t: f64, state: &[f64; 2]) -> f64 {
            state[1]
        }
    }

    fn recorded(states: &[[f64; 2]]) -> Recording<2> {
        let mut recording = Recording::new(&["h", "f"]);
        for (k, state) in states.iter().enumerate() {
            recording.record(k as f64, state);
        }
        recording
    }

    #[test]
    fn largest_errors_with_their_times() {
        let recording = recorded(&[[-4.0, 0.0], [-4.5, 1e-3], [-3.0, 2e-3], [-5.0, 1e-3]]);
        let found = InvariantErrors::along(&Given, &recording).unwrap();
        assert_eq!((found.energy_error, found.energy_error_time), (0.25, 2.0));
        assert_eq!((found.residual, found.residual_time), (2e-3, 2.0));
        assert_eq!(found.samples, 4);
        assert!(found.within(0.25, 2e-3) && !found.within(0.2, 2e-3) && !found.within(0.25, 1e-3));
        assert_eq!(
            found.to_string(),
            "largest relative energy error: 0.25 at t = 2; largest residual: 0.002 at t = 2"
        );
    }

    #[test]
    fn the_start_counts_as_well() {
        let found = InvariantErrors::along(&Given, &recorded(&[[1.0, 0.5], [1.0, 0.1]])).unwrap();
        assert_eq!((found.residual, found.residual_time), (0.5, 0.0));
    }

    #[test]
    fn a_zero_energy_makes_absolute_errors() {
        let found = InvariantErrors::along(&Given, &recorded(&[[0.0, 0.0], [1e-3, 0.0]])).unwrap();
        assert_eq!(found.energy_error, 1e-3);
        assert!(found.to_string().starts_with("largest energy error: 0.001 at"));
        let mut monitor = Monitor::new(&Given, 0.0, &[0.0, 0.0]).with_scale(-10.0);
        monitor.at(1.0, &[1.0, 0.0]);
        assert_eq!(monitor.invariants().energy_error, 0.1);
    }

    #[test]
    fn what_is_not_finite_breaks_every_bound() {
        for states in
            [[[1.0, 0.0], [f64::NAN, 0.0]], [[f64::NAN, 0.0], [1.0, 0.0]], [[1.0, 0.0], [1.0, f64::NAN]]]
        {
            let found = InvariantErrors::along(&Given, &recorded(&states)).unwrap();
            assert!(!found.within(f64::MAX, f64::MAX));
        }
    }

    #[test]
    fn an_empty_recording_has_none() {
        let empty = recorded(&[]);
        assert_eq!(InvariantErrors::along(&Given, &empty), None);
        assert_eq!(drift(&Given, &empty).count(), 0);
        assert_eq!(residuals(&Given, &empty).count(), 0);
    }

    #[test]
    fn curves_for_pictures() {
        let recording = recorded(&[[2.0, 0.0], [1.0, 1e-3]]);
        assert_eq!(drift(&Given, &recording).collect::<Vec<_>>(), [(0.0, 0.0), (1.0, -0.5)]);
        assert_eq!(residuals(&Given, &recording).collect::<Vec<_>>(), [(0.0, 0.0), (1.0, 1e-3)]);
    }
}
