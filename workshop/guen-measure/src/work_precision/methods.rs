//! Every method on both forms of a system, ready to be searched and timed.

use std::hint::black_box;
use std::rc::Rc;

use guen::prelude::*;
use guen::steppers::{IntegrationResult, Method};
use guen::{Differentiable, Fused, TaylorSeries};

use super::references::Case;
use super::search::{Knob, Run};

/// What is compared, in the order of the tables: with an apostrophe on the carried form, with two on that form in `Fused`. Methods
/// that solve equations with a Jacobian are not run there: it comes from dual numbers on a carried form, and is larger.
#[rustfmt::skip]
pub const METHODS: [&str; 17] = [
    "Euler", "RK4", "RK4'", "RK4\"", "RK8", "RK8'", "RK8\"", "Tsit5", "Tsit5'", "Tsit5\"", "DOP853", "DOP853'", "DOP853\"",
    "Taylor", "Gauss 4", "Gauss 6", "Radau 5",
];

/// The finest accuracy that a method has to reach wherever doubles do; a method of low order would take too long.
pub fn reach(method: &str) -> f64 {
    match method.trim_end_matches(['\'', '"']) {
        "Euler" => 1.0,
        "RK4" => 1e-9,
        "Gauss 4" => 1e-6,
        "Radau 5" => 1e-9,
        _ => 1e-12,
    }
}

/// One method on one form of a system.
pub struct Candidate {
    pub method: &'static str,
    pub knob: Knob,
    /// A setting that takes more evaluations than these is not tried.
    pub most: u64,
    /// A run with a setting, and what came of it; none if it failed.
    pub judge: Box<dyn Fn(u32) -> Option<Run>>,
    /// The same run with a method that was made before, of which nothing is asked.
    pub made: Box<dyn Fn(u32) -> Box<dyn Fn()>>,
}

/// A form of a system over a real, with its state at the beginning and what is to come of it.
pub struct Form<S, R, const M: usize, const N: usize> {
    pub system: S,
    pub start: [R; M],
    pub case: Rc<Case<N>>,
}

impl<S, R, const M: usize, const N: usize> Form<S, R, M, N>
where
    S: System<R, M> + Clone + 'static,
    R: Real + 'static,
{
    fn with<K>(
        &self,
        method: &'static str,
        (knob, most): (Knob, u64),
        make: impl Fn(f64) -> K + Copy + 'static,
    ) -> Candidate
    where
        K: Method<R, S, M> + 'static,
    {
        let (system, start, case) = (self.system.clone(), self.start, self.case.clone());
        let span = case.span;
        let method_of = move |setting| make(knob.value(setting, span));
        let (same_system, same_start) = (system.clone(), start);
        Candidate {
            method,
            knob,
            most,
            judge: Box::new(move |setting| {
                let done = run(&system, &start, span, &method_of(setting))?;
                let state = done.state.map(R::to_f64);
                Some(Run { evaluations: done.statistics.evaluations, error: case.error(&state) })
            }),
            made: Box::new(move |setting| {
                let (system, start, method) = (same_system.clone(), same_start, method_of(setting));
                Box::new(move || {
                    black_box(run(&system, &start, span, &method));
                })
            }),
        }
    }

    /// The explicit methods, under the names that they have on this form.
    fn explicit(&self, [rk4, rk8, tsit5, dop853]: [&'static str; 4]) -> [Candidate; 4]
    where
        R: Ordered,
    {
        [
            self.with(rk4, EXPLICIT, |step| Rk4::new(R::from_f64(step))),
            self.with(rk8, EXPLICIT, |step| Rk8::new(R::from_f64(step))),
            self.with(tsit5, ADAPTIVE, |tolerance| Tsit5::new(tolerance, tolerance)),
            self.with(dop853, ADAPTIVE, |tolerance| Dop853::new(tolerance, tolerance)),
        ]
    }
}

/// What is timed: a run under the guards that are there by default.
#[inline(never)]
fn run<S, K, R, const M: usize>(
    system: &S,
    start: &[R; M],
    span: f64,
    method: &K,
) -> Option<IntegrationResult<R, M>>
where
    S: System<R, M>,
    K: Method<R, S, M>,
    R: Real,
{
    Integration::new(system, R::zero(), black_box(start)).run(method, R::from_f64(span)).ok()
}

// As many evaluations as take some 25 ms.
const EXPLICIT: (Knob, u64) = (Knob::Steps, 1_000_000);
const IMPLICIT: (Knob, u64) = (Knob::Steps, 100_000);
const ADAPTIVE: (Knob, u64) = (Knob::Tolerance, 200_000);

/// All methods on a system, and the explicit ones on its carried form and on that in `Fused`.
pub fn candidates<S, C, F, const M: usize, const N: usize>(
    whole: Form<S, f64, N, N>,
    carried: Form<C, f64, M, N>,
    fused: Form<F, Fused, M, N>,
) -> Vec<Candidate>
where
    S: Differentiable<f64, N> + TaylorSeries<f64, N> + Clone + 'static,
    C: System<f64, M> + Clone + 'static,
    F: System<Fused, M> + Clone + 'static,
{
    let mut all = vec![
        whole.with("Euler", EXPLICIT, Euler::new),
        whole.with("Taylor", ADAPTIVE, |tolerance| Taylor::new(tolerance, tolerance)),
        whole.with("Gauss 4", IMPLICIT, Gauss4::new),
        whole.with("Gauss 6", IMPLICIT, Gauss6::new),
        whole.with("Radau 5", ADAPTIVE, |tolerance| Radau5::new(tolerance, tolerance)),
    ];
    all.extend(whole.explicit(["RK4", "RK8", "Tsit5", "DOP853"]));
    all.extend(carried.explicit(["RK4'", "RK8'", "Tsit5'", "DOP853'"]));
    all.extend(fused.explicit(["RK4\"", "RK8\"", "Tsit5\"", "DOP853\""]));
    all
}
