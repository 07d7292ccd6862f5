//! The two short ways to run a method, `integrate` and `sample`, which every method offers by itself.

use crate::numbers::real::Real;
use crate::steppers::driver::error::{Cause, IntegrationError, Setting};
use crate::steppers::driver::integration::finished;
use crate::steppers::driver::run::{Checkpoint, IntegrationResult, Method, Outcome, StepperRun};
use crate::steppers::guard::{Guard, Watch};
use crate::system::System;

/// Goes through the given times in their order, whatever it is, landing on each of them exactly.
pub(in crate::steppers) fn visit_times<M, R, S, V, const N: usize>(
    method: &M,
    system: &S,
    t0: R,
    x0: &[R; N],
    times: &[R],
    mut visit: V,
) -> Result<IntegrationResult<R, N>, IntegrationError<R, N>>
where
    M: Method<R, S, N>,
    R: Real,
    S: System<R, N> + ?Sized,
    V: FnMut(usize, R, &[R; N]),
{
    let start = Checkpoint::new(t0, x0);
    let mut run = method.start(&start);
    let mut watch =
        Watch::new::<M::Run<'_>, S>(Guard::default(), system, &start).map_err(|cause| start.failed(cause))?;
    let (mut before, mut kept) = (start, false);
    for (index, &time) in times.iter().enumerate() {
        if !t0.is_finite() || !time.is_finite() {
            return Err(run.checkpoint().failed(Cause::Setting(Setting::Time)));
        }
        while run.checkpoint().time != time {
            kept = watch.wants_before(index + 1 == times.len() && run.is_last(time));
            if kept {
                before = *run.checkpoint();
            }
            let from = run.checkpoint().statistics.accepted;
            let made = if kept {
                run.advance(system, time, kept)
            } else {
                run.go_on(system, time, watch.patience())
            };
            if let Err(cause) = made {
                return Err(watch.stopped(system, &run, cause));
            }
            if let Err(cause) = watch.step(system, from, kept.then_some(&before), &run) {
                return Err(watch.good(run.checkpoint()).failed(cause));
            }
        }
        visit(index, time, &run.checkpoint().state);
    }
    let done = run.checkpoint().done(Outcome::Arrived);
    finished(&mut watch, system, kept.then_some(&before), &run, done)
}

/// The methods `integrate` and `sample` of a method over the real `R`, for systems with the given bounds.
macro_rules! short_ways {
    ($Method:ident over $Real:ident, systems $($bound:tt)+) => {
        impl<R: $Real> $Method<R> {
            /// Integrates from `x0` at `t0` to `t1`, forwards or backwards, calling the observer after each accepted
            /// step; when it breaks, the run ends with [`Outcome::Stopped`](crate::steppers::Outcome::Stopped). The last step
            /// lands on `t1`. A span of zero is no step at all. The same as an
            /// [`Integration`](crate::steppers::Integration) with an observer and nothing else.
            ///
            /// # Errors
            ///
            /// Settings that make no sense; else what stopped the method, or what the default
            /// [`Guard`](crate::steppers::Guard) found. The error carries the last good time and state.
            pub fn integrate<S, O, const N: usize>(
                &self,
                system: &S,
                t0: R,
                x0: &[R; N],
                t1: R,
                mut observer: O,
            ) -> Result<crate::steppers::IntegrationResult<R, N>, $crate::IntegrationError<R, N>>
            where
                S: $($bound)+<R, N> + ?Sized,
                O: FnMut(R, &[R; N]) -> core::ops::ControlFlow<()>,
            {
                crate::steppers::Integration::new(system, t0, x0).observe(&mut observer).run(self, t1)
            }

            /// Integrates from `x0` at `t0` through the given times, and calls `visit` with the index, the time and
            /// the state at each of them, exactly: steps are shortened to land there, so many times make many steps
            /// (an [`Integration`](crate::steppers::Integration) samples without landing). The times may repeat and may turn
            /// back.
            ///
            /// # Errors
            ///
            /// Those of `integrate`; times visited before stay visited.
            pub fn sample<S, V, const N: usize>(
                &self,
                system: &S,
                t0: R,
                x0: &[R; N],
                times: &[R],
                visit: V,
            ) -> Result<crate::steppers::IntegrationResult<R, N>, $crate::IntegrationError<R, N>>
            where
                S: $($bound)+<R, N> + ?Sized,
                V: FnMut(usize, R, &[R; N]),
            {
                crate::steppers::driver::stop_times::visit_times(self, system, t0, x0, times, visit)
            }
        }
    };
}
pub(in crate::steppers) use short_ways;
