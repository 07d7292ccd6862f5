//! The levers there are for every system, and those for systems that can do more.

use std::ops::Range;
use std::rc::Rc;

use guen_runtime::steppers::{Bounded, Euler, Gauss4, Gauss6, LaneMethod, Radau5, Rk4, Rk8, Statistics};
use guen_runtime::{
    Choice, ConstantsError, Differentiable, Digits7, Digits7Functions, Digits13, Fused, Laned, Ordered, Real,
    Recast, Std, System,
};

use super::code::{self, Origin};
use super::digits31::Digits31;
use super::lever::{Argument, Lever, Settings, Task, explicit_levers, lever, run_bounded};
use super::row::Failure;
use super::{Digits71, Study, reference};
use crate::Ensemble;

/// The explicit methods over a real, or a lever that failed if the constants cannot be prepared there.
fn over<R, S, const N: usize>(real: &'static str, system: &S, span: (f64, f64)) -> Vec<Lever<N>>
where
    R: Ordered,
    S: Recast<N>,
{
    match system.recast::<R>() {
        Ok(system) => explicit_levers::<R, S::In<R>, N>(real, &Rc::new(system), span, Origin::Recast),
        Err(error) => vec![Lever {
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
) -> Vec<Lever<N>>
where
    D: System<f64, N> + 'static,
{
    let mut levers = explicit_levers::<f64, D, N>(real, system, span, origin);
    levers.push(lever::<f64, D, _, N>(
        ["Euler", real, "declared"],
        system,
        Settings::Steps,
        |step| Euler { step },
        move |h| code::run(origin, "f64", "Euler", Argument::Field, h, span),
    ));
    let bounded = |name: &str, constructor: &'static str, formula: fn(u32) -> Bounded| {
        let system = Rc::clone(system);
        Lever {
            method: name.to_owned(),
            real: real.to_owned(),
            form: "declared".to_owned(),
            settings: Settings::Evaluations,
            make: Ok(Box::new(move |n| run_bounded(Rc::clone(&system), formula, n))),
            code: Box::new(move |n| code::bounded(origin, constructor, n, span)),
        }
    };
    levers.push(bounded("Bounded DOP853", "dop853", Bounded::dop853));
    levers.push(bounded("Bounded Tsit5", "tsit5", Bounded::tsit5));
    levers
}

/// The implicit methods, in doubles.
fn implicit<D, const N: usize>(system: &Rc<D>, span: (f64, f64)) -> Vec<Lever<N>>
where
    D: Differentiable<f64, N> + 'static,
{
    let names = |method| [method, "f64", "declared"];
    let code = move |constructor: &'static str, argument| {
        move |setting| code::run(Origin::Recast, "f64", constructor, argument, setting, span)
    };
    vec![
        lever::<f64, D, _, N>(
            names("Gauss 4"),
            system,
            Settings::Steps,
            Gauss4::new,
            code("Gauss4", Argument::Step),
        ),
        lever::<f64, D, _, N>(
            names("Gauss 6"),
            system,
            Settings::Steps,
            Gauss6::new,
            code("Gauss6", Argument::Step),
        ),
        lever::<f64, D, _, N>(
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
    S: Recast<N>,
    S::In<f64>: Differentiable<f64, N>,
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
        let doubles = Rc::new(system.recast::<f64>()?);
        let long = Rc::new(system.recast::<Digits71>()?);
        // Constants that this real cannot hold leave the study without it.
        let shorter = system.recast::<Digits31>().ok();
        let ends = (span.start, span.end);
        let mut levers = of_doubles("f64", &doubles, ends, Origin::Recast);
        levers.extend(over::<Digits13, S, N>("Digits13", &system, ends));
        levers.extend(over::<Digits7, S, N>("Digits7", &system, ends));
        levers.extend(over::<Fused, S, N>("Fused", &system, ends));
        levers.extend(over::<Std, S, N>("Std", &system, ends));
        levers.extend(over::<f32, S, N>("f32", &system, ends));
        levers.extend(implicit(&doubles, ends));
        let mut study = Self::bare(system, &doubles, &long, start.into(), span);
        study.levers = levers;
        study.shorter = shorter.map(|system| {
            reference::references_in::<Digits31, _, N>(&Rc::new(system), reference::SHORTER_TOLERANCE)
        });
        Ok(study)
    }

    /// The same with RK4 and RK8 in lanes, in doubles and with the functions of `Digits7`: several initial states at once, on one
    /// thread. Costs are for one state, so lanes are worth nothing for a single one.
    ///
    /// # Errors
    ///
    /// Those of `prepare`.
    pub fn with_lanes(mut self) -> Result<Self, ConstantsError>
    where
        S::In<f64>: Laned<N> + Sync + Clone,
    {
        let system = self.system.recast::<f64>()?;
        let span = self.span();
        let four = |step| Rk4 { step };
        let names = |method| [method, "f64 lanes", "f64"];
        self.levers.push(in_lanes::<_, guen_runtime::Own, _, N>(names("RK4"), &system, span, four));
        self.levers.push(in_lanes::<_, guen_runtime::Own, _, N>(names("RK8"), &system, span, Rk8::new));
        let names = |method| [method, "Digits7 lanes", "Digits7"];
        self.levers.push(in_lanes::<_, Digits7Functions, _, N>(names("RK4"), &system, span, four));
        self.levers.push(in_lanes::<_, Digits7Functions, _, N>(names("RK8"), &system, span, Rk8::new));
        Ok(self)
    }
}

/// A method in lanes, by its name, that of the real, and that of the choice of functions.
fn in_lanes<D, C, M, const N: usize>(
    [method, real, choice]: [&'static str; 3],
    system: &D,
    span: (f64, f64),
    of_step: impl Fn(f64) -> M + Copy + 'static,
) -> Lever<N>
where
    D: Laned<N> + Sync + Clone + 'static,
    C: Choice,
    M: LaneMethod + Sync,
{
    let system = system.clone();
    let make = move |step: f64| -> super::Run<N> {
        let system = system.clone();
        Box::new(move |task: &Task<'_, N>, out| {
            let ensemble = Ensemble::of_states(system.clone(), task.starts.to_vec());
            let ensemble = ensemble.with_choice::<C>().with_threads(1);
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
    Lever {
        method: method.to_owned(),
        real: real.to_owned(),
        form: "declared".to_owned(),
        settings: Settings::Steps,
        make: Ok(Box::new(make)),
        code: Box::new(move |step| code::lanes(choice, method, step, span)),
    }
}
