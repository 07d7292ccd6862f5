//! The two short ways to run a method, `integrate` and `sample`, which every method offers by itself.

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
            /// back. The same as [`Integration::run_through`](crate::steppers::Integration::run_through).
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
                crate::steppers::Integration::new(system, t0, x0).run_through(self, times, visit)
            }
        }
    };
}
pub(in crate::steppers) use short_ways;
