//! The variants there are for every system, and those for systems that can do more.

use std::ops::Range;
use std::rc::Rc;

use guen_runtime::steppers::{Bounded, Euler, Gauss4, Gauss6, LaneMethod, Radau5, Rk4, Rk8, Statistics};
use guen_runtime::{
    Approx7, Approx7Functions, Approx13, ConstantsError, Differentiable, Fused, LaneScalar, Laned, Ordered,
    Real, Std, System, WithScalar,
};

use super::code::Argument;
use super::code::{self, Origin};
use super::digits31::Digits31;
use super::row::Failure;
use super::variant::{Settings, Task, Variant, explicit_variants, run_bounded, variant};
use super::{Digits71, Study, reference};
use crate::Ensemble;

/// The explicit methods over a real, or a variant that failed if the constants cannot be prepared there.
fn over<R, S, const N: usize>(real: &'static str, system: &S, span: (f64, f64)) -> Vec<Variant<N>>
where
    R: Ordered,
    S: WithScalar<N>,
{
    match system.with_scalar::<R>() {
        Ok(system) => explicit_variants::<R, S::Over<R>, N>(real, &Rc::new(system), span, Origin::WithScalar),
        Err(error) => vec![Variant {
            method: "all".to_owned(),
            real: real.to_owned(),
            form: "declared".to_owned(),
            settings: Settings::Steps,
            make: Err(Failure::of_constants(&error)),
            code: Box::new(|_| String::new()),
        }],
    }
}

/// The explicit methods in doubles, with those that are there in doubles only.
pub(super) fn of_doubles<D, const N: usize>(
    real: &'static str,
    system: &Rc<D>,
    span: (f64, f64),
    origin: Origin,
) -> Vec<Variant<N>>
where
    D: System<f64, N> + 'static,
{
    let mut variants = explicit_variants::<f64, D, N>(real, system, span, origin);
    variants.push(variant::<f64, D, _, N>(
        ["Euler", real, "declared"],
        system,
        Settings::Steps,
        Euler::new,
        move |h| code::run(origin, "f64", "Euler", Argument::Step, h, span),
    ));
    let bounded = |name: &str, constructor: &'static str, formula: fn(u32) -> Bounded| {
        let system = Rc::clone(system);
        Variant {
            method: name.to_owned(),
            real: real.to_owned(),
            form: "declared".to_owned(),
            settings: Settings::Evaluations,
            make: Ok(Box::new(move |n| run_bounded(Rc::clone(&system), formula, n))),
            code: Box::new(move |n| code::bounded(origin, constructor, n, span)),
        }
    };
    variants.push(bounded("Bounded DOP853", "dop853", Bounded::dop853));
    variants.push(bounded("Bounded Tsit5", "tsit5", Bounded::tsit5));
    variants
}

/// The implicit methods, in doubles.
fn implicit<D, const N: usize>(system: &Rc<D>, span: (f64, f64)) -> Vec<Variant<N>>
where
    D: Differentiable<f64, N> + 'static,
{
    let names = |method| [method, "f64", "declared"];
    let code = move |constructor: &'static str, argument| {
        move |setting| code::run(Origin::WithScalar, "f64", constructor, argument, setting, span)
    };
    vec![
        variant::<f64, D, _, N>(
            names("Gauss 4"),
            system,
            Settings::Steps,
            Gauss4::new,
            code("Gauss4", Argument::Step),
        ),
        variant::<f64, D, _, N>(
            names("Gauss 6"),
            system,
            Settings::Steps,
            Gauss6::new,
            code("Gauss6", Argument::Step),
        ),
        variant::<f64, D, _, N>(
            names("Radau 5"),
            system,
            Settings::Tolerances,
            |tol| Radau5::new(tol, tol),
            code("Radau5", Argument::Tolerances),
        ),
    ]
}

impl<S, const N: usize> Study<S, N>
where
    S: WithScalar<N>,
    S::Over<f64>: Differentiable<f64, N>,
{
    /// A study of a system from an initial state over a span, with every method over every real.
    ///
    /// The system is the constants of a generated one, a prepared one, one with its inputs held
    /// (`system.driven(inputs)`), or equations written for every real, `generic(..)`. The span may run backwards.
    ///
    /// # Errors
    ///
    /// The constants cannot be prepared, in doubles or in 71 digits.
    pub fn new(system: S, start: impl Into<[f64; N]>, span: Range<f64>) -> Result<Self, ConstantsError> {
        let doubles = Rc::new(system.with_scalar::<f64>()?);
        let long = Rc::new(system.with_scalar::<Digits71>()?);
        // Constants that this real cannot hold leave the study without it.
        let shorter = system.with_scalar::<Digits31>().ok();
        let ends = (span.start, span.end);
        let mut variants = of_doubles("f64", &doubles, ends, Origin::WithScalar);
        variants.extend(over::<Approx13, S, N>("Approx13", &system, ends));
        variants.extend(over::<Approx7, S, N>("Approx7", &system, ends));
        variants.extend(over::<Fused, S, N>("Fused", &system, ends));
        variants.extend(over::<Std, S, N>("Std", &system, ends));
        variants.extend(over::<f32, S, N>("f32", &system, ends));
        variants.extend(implicit(&doubles, ends));
        let mut study = Self::bare(system, &doubles, &long, start.into(), span);
        study.variants = variants;
        study.shorter = shorter.map(|system| {
            reference::references_in::<Digits31, _, N>(&Rc::new(system), reference::SHORTER_TOLERANCE)
        });
        Ok(study)
    }

    /// Adds RK4 and RK8 in lanes, in doubles and with the functions of `Approx7`: several initial states at once, on
    /// one thread. Costs are for one state, so lanes are worth nothing for a single one.
    ///
    /// # Errors
    ///
    /// Those of `prepare`.
    pub fn with_lanes(mut self) -> Result<Self, ConstantsError>
    where
        S::Over<f64>: Laned<N> + Sync + Clone,
    {
        let system = self.system.with_scalar::<f64>()?;
        let span = self.span();
        let four = Rk4::new;
        let names = |method| [method, "f64 lanes", "f64"];
        self.variants.push(in_lanes::<_, guen_runtime::PlainLanes, _, N>(names("RK4"), &system, span, four));
        self.variants.push(in_lanes::<_, guen_runtime::PlainLanes, _, N>(
            names("RK8"),
            &system,
            span,
            Rk8::new,
        ));
        let names = |method| [method, "Approx7 lanes", "Approx7"];
        self.variants.push(in_lanes::<_, Approx7Functions, _, N>(names("RK4"), &system, span, four));
        self.variants.push(in_lanes::<_, Approx7Functions, _, N>(names("RK8"), &system, span, Rk8::new));
        Ok(self)
    }
}

/// A method in lanes, by its name, that of the real, and that of the choice of functions.
fn in_lanes<D, C, M, const N: usize>(
    [method, real, choice]: [&'static str; 3],
    system: &D,
    span: (f64, f64),
    of_step: impl Fn(f64) -> M + Copy + 'static,
) -> Variant<N>
where
    D: Laned<N> + Sync + Clone + 'static,
    C: LaneScalar,
    M: LaneMethod + Sync,
{
    let system = system.clone();
    let make = move |step: f64| -> super::Run<N> {
        let system = system.clone();
        Box::new(move |task: &Task<'_, N>, out| {
            let ensemble = Ensemble::of_states(system.clone(), task.starts.to_vec());
            let ensemble = ensemble.with_scalar::<C>().with_threads(1);
            let mut total = Statistics::default();
            // It lands on every time, for lanes share their steps.
            for sampled in ensemble.sample(&of_step(step), task.t0, task.times) {
                let done = sampled.end.map_err(|error| Failure::of_run(error.time.to_f64(), &error.cause))?;
                total += done.statistics;
                out.extend(sampled.states);
            }
            Ok(total)
        })
    };
    Variant {
        method: method.to_owned(),
        real: real.to_owned(),
        form: "declared".to_owned(),
        settings: Settings::Steps,
        make: Ok(Box::new(make)),
        code: Box::new(move |step| code::lanes(choice, method, step, span)),
    }
}
