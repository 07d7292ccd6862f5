//! A simulation that ended before its time.

use alloc::boxed::Box;
use core::fmt;

use crate::numbers::real::{Ordered, Real};
use crate::simulation::trajectory::Trajectory;
use crate::steppers::{Cause, Dense, Names};
use crate::system::simulate::Simulate;

/// A failed simulation: why it stopped, and the motion until then.
///
/// ```
/// use guen_runtime::{Simulate, from_fn};
///
/// // x' = x^2 is infinite at t = 1.
/// let explosion = from_fn(|_t: f64, &[x]: &[f64; 1]| [x * x]);
/// let error = explosion.simulate(&[1.0], 0.0..2.0).unwrap_err();
/// assert!(error.time < 1.0 + 1e-6 && error.trajectory.end_time() == error.time);
/// assert!((error.trajectory.at(0.5)[0] - 2.0).abs() < 1e-7);
/// ```
pub struct SimulationError<S, const N: usize, R = f64, P = Dense<R, N>>
where
    R: Real,
    S: Simulate<R, N>,
{
    /// The last good time, at which the trajectory ends.
    pub time: R,
    /// The reason why the simulation could not go on from there.
    pub cause: Cause,
    /// The motion up to there.
    pub trajectory: Box<Trajectory<S, N, R, P>>,
}

impl<R: Real, S: Simulate<R, N>, P, const N: usize> fmt::Debug for SimulationError<S, N, R, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The message, because `main` and `unwrap` show an error so; the motion until then would hide it.
        write!(f, "SimulationError({self})")
    }
}

impl<R: Real, S: Simulate<R, N>, P, const N: usize> fmt::Display for SimulationError<S, N, R, P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "simulation stopped at t = {}: ", self.time.to_f64())?;
        self.cause.describe(f, Names::of::<R, S, N>())
    }
}

impl<R: Ordered, S: Simulate<R, N>, P, const N: usize> core::error::Error for SimulationError<S, N, R, P> {}
