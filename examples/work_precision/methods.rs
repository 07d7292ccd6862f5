//! Every method on both forms of a system, ready to be searched and timed.

use std::hint::black_box;
use std::rc::Rc;

use guen::prelude::*;
use guen::steppers::{Done, Method};
use guen::{Differentiable, TaylorSeries};

use super::references::Case;
use super::search::{Lever, Run};

/// What is compared, in the order of the tables; with an apostrophe on the carried form. Methods that solve equations
/// with a Jacobian are not run there: it comes from dual numbers on a carried form, and is larger.
pub const METHODS: [&str; 13] = [
    "Euler", "RK4", "RK4'", "RK8", "RK8'", "Tsit5", "Tsit5'", "DOP853", "DOP853'", "Taylor", "Gauss 4",
    "Gauss 6", "Radau 5",
];

/// The finest accuracy that a method has to reach wherever doubles do; a method of low order would take too long.
pub fn reach(method: &str) -> f64 {
    match method.trim_end_matches('\'') {
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
    pub lever: Lever,
    /// A setting that takes more evaluations than these is not tried.
    pub most: u64,
    /// A run with a setting, and what came of it; none if it failed.
    pub judge: Box<dyn Fn(u32) -> Option<Run>>,
    /// The same run, of which nothing is asked.
    pub run: Box<dyn Fn(u32)>,
}

/// A form of a system with its state at the beginning, and what is to come of it.
pub struct Form<S, const M: usize, const N: usize> {
    pub system: S,
    pub start: [f64; M],
    pub case: Rc<Case<N>>,
}

impl<S: System<f64, M> + Clone + 'static, const M: usize, const N: usize> Form<S, M, N> {
    fn with<K>(
        &self,
        method: &'static str,
        (lever, most): (Lever, u64),
        make: impl Fn(f64) -> K + Copy + 'static,
    ) -> Candidate
    where
        K: Method<f64, S, M> + 'static,
    {
        let (system, start, case) = (self.system.clone(), self.start, self.case.clone());
        let go = move |setting, case: &Case<N>| {
            run(&system, &start, case.span, &make(lever.value(setting, case.span)))
        };
        let (again, same) = (go.clone(), case.clone());
        Candidate {
            method,
            lever,
            most,
            judge: Box::new(move |setting| {
                let done = go(setting, &case)?;
                Some(Run { evaluations: done.statistics.evaluations, error: case.error(&done.state) })
            }),
            run: Box::new(move |setting| {
                black_box(again(setting, &same));
            }),
        }
    }
}

/// What is timed: a run under the guards that are there by default.
#[inline(never)]
fn run<S, K, const M: usize>(system: &S, start: &[f64; M], span: f64, method: &K) -> Option<Done<f64, M>>
where
    S: System<f64, M>,
    K: Method<f64, S, M>,
{
    Integration::new(system, 0.0, black_box(start)).run(method, span).ok()
}

/// All methods on a system and on its carried form.
pub fn candidates<S, C, const M: usize, const N: usize>(
    whole: Form<S, N, N>,
    carried: Form<C, M, N>,
) -> Vec<Candidate>
where
    S: Differentiable<f64, N> + TaylorSeries<f64, N> + Clone + 'static,
    C: System<f64, M> + Clone + 'static,
{
    // As many as take some 25 ms.
    const EXPLICIT: (Lever, u64) = (Lever::Steps, 1_000_000);
    const IMPLICIT: (Lever, u64) = (Lever::Steps, 100_000);
    const ADAPTIVE: (Lever, u64) = (Lever::Tolerance, 200_000);
    vec![
        whole.with("Euler", EXPLICIT, |step| Euler { step }),
        whole.with("RK4", EXPLICIT, |step| Rk4 { step }),
        whole.with("RK8", EXPLICIT, Rk8::new),
        whole.with("Tsit5", ADAPTIVE, |tolerance| Tsit5::new(tolerance, tolerance)),
        whole.with("DOP853", ADAPTIVE, |tolerance| Dop853::new(tolerance, tolerance)),
        whole.with("Taylor", ADAPTIVE, Taylor::new),
        whole.with("Gauss 4", IMPLICIT, Gauss4::new),
        whole.with("Gauss 6", IMPLICIT, Gauss6::new),
        whole.with("Radau 5", ADAPTIVE, |tolerance| Radau5::new(tolerance, tolerance)),
        carried.with("RK4'", EXPLICIT, |step| Rk4 { step }),
        carried.with("RK8'", EXPLICIT, Rk8::new),
        carried.with("Tsit5'", ADAPTIVE, |tolerance| Tsit5::new(tolerance, tolerance)),
        carried.with("DOP853'", ADAPTIVE, |tolerance| Dop853::new(tolerance, tolerance)),
    ]
}
