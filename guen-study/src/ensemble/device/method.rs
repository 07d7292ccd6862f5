//! The methods that kernels have.

use guen_runtime::steppers::{Dop853, Integration, LaneMethod, Rk4, Rk8};
use guen_runtime::{KernelMethod, Laned};

use crate::ensemble::{Ensemble, Sampled};

/// A method that integrates on devices: [`Rk4`], [`Rk8`] and [`Dop853`]. There are no others.
///
/// ```
/// use guen_study::DeviceMethod;
/// use guen_runtime::steppers::{Dop853, Rk4, Rk8};
/// fn is_for_devices(_: &impl DeviceMethod) {}
/// is_for_devices(&Rk4::new(0.01));
/// is_for_devices(&Rk8::new(0.1));
/// is_for_devices(&Dop853::new(1e-9, 1e-9));
/// ```
pub trait DeviceMethod: HasKernel + Sync {}

impl<M: HasKernel + Sync> DeviceMethod for M {}

/// The kernel of a method, and its work without one: out of reach of other crates, which cannot add methods to kernels.
pub trait HasKernel {
    /// The method of the kernel, with its settings.
    fn in_kernel(&self) -> (KernelMethod, [f64; 4]);

    /// The motions of an ensemble on the CPU, through the times and with the states there, if they are to be kept.
    fn on_cpu<S: Laned<N> + Sync, const N: usize>(
        &self,
        ensemble: &Ensemble<S, N>,
        t0: f64,
        times: &[f64],
        keep: bool,
    ) -> Vec<Sampled<N>>;
}

/// Motions with a fixed step, in lanes.
fn in_lanes<M: LaneMethod + Sync, S: Laned<N> + Sync, const N: usize>(
    method: &M,
    ensemble: &Ensemble<S, N>,
    t0: f64,
    times: &[f64],
    keep: bool,
) -> Vec<Sampled<N>> {
    match times {
        [t1] if !keep => {
            let ends = ensemble.integrate(method, t0, *t1).into_iter();
            ends.map(|end| Sampled { states: Vec::new(), end }).collect()
        }
        _ => ensemble.sample(method, t0, times),
    }
}

macro_rules! fixed {
    ($($Method:ident)*) => {
        $(impl HasKernel for $Method {
            fn in_kernel(&self) -> (KernelMethod, [f64; 4]) {
                (KernelMethod::$Method, [self.step(), 0.0, 0.0, 0.0])
            }

            fn on_cpu<S: Laned<N> + Sync, const N: usize>(
                &self,
                ensemble: &Ensemble<S, N>,
                t0: f64,
                times: &[f64],
                keep: bool,
            ) -> Vec<Sampled<N>> {
                in_lanes(self, ensemble, t0, times, keep)
            }
        })*
    };
}
fixed!(Rk4 Rk8);

impl HasKernel for Dop853 {
    fn in_kernel(&self) -> (KernelMethod, [f64; 4]) {
        /// Numbers of steps that a double counts, more than any run makes.
        const COUNTABLE: u64 = 1 << 53;
        // A first step of zero is an error here, and asks for an estimate there.
        let first = self.first_step.map_or(0.0, |step| if step > 0.0 { step } else { -1.0 });
        let most = self.max_steps.min(COUNTABLE) as f64;
        (KernelMethod::Dop853, [self.rtol, self.atol, first, most])
    }

    fn on_cpu<S: Laned<N> + Sync, const N: usize>(
        &self,
        ensemble: &Ensemble<S, N>,
        t0: f64,
        times: &[f64],
        keep: bool,
    ) -> Vec<Sampled<N>> {
        let until = times.last().copied().unwrap_or(t0);
        let asked = if keep { times } else { &[] };
        ensemble.each(|system, start| {
            let mut states = Vec::new();
            let end = Integration::new(system, t0, start)
                .sample(asked, &mut |_, _, state: &[f64; N]| states.push(*state))
                .run(self, until);
            Sampled { states, end }
        })
    }
}
