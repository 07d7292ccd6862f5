//! A candidate of a study: integrator, scalar type and formulation, with a series of settings.

use std::ops::ControlFlow;
use std::rc::Rc;

use guen_runtime::steppers::{Bounded, Integration, Method, Outcome, Statistics};
use guen_runtime::{Ordered, Real, System};

use super::code::{Argument, Origin};
use super::row::{Failure, Knob};
use super::timing::Deadline;

/// The task of a variant: all initial states, over the same span, and where to look at them.
#[derive(Clone, Copy)]
pub(super) struct Task<'a, const N: usize> {
    pub starts: &'a [[f64; N]],
    pub t0: f64,
    /// The times in order; the last one is the end of the span.
    pub times: &'a [f64],
    /// The instant at which to give up. Watching costs a little, so runs that are timed are not watched.
    pub deadline: Option<Deadline<'a>>,
}

impl<const N: usize> Task<'_, N> {
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(self.t0)
    }
}

/// A variant at a setting: fills in the states at the times of each start, one start after the other.
pub(super) type Run<const N: usize> =
    Box<dyn Fn(&Task<'_, N>, &mut Vec<[f64; N]>) -> Result<Statistics, Failure>>;

/// The settings to try, from coarse to fine.
#[derive(Clone, Debug, PartialEq)]
pub enum Settings {
    /// Steps: the span divided by 8, 11, 16, .., by the square root of two each, until they no longer gain anything.
    Steps,
    /// Tolerances 1e-2, 3e-3, .. to 1e-15.
    Tolerances,
    /// Evaluations allowed: 24, 48, ..
    Evaluations,
    /// The values given, from coarse to fine.
    List(Knob, Vec<f64>),
}

impl Settings {
    pub(super) fn knob(&self) -> Knob {
        match self {
            Self::Steps => Knob::Step,
            Self::Tolerances => Knob::Tolerance,
            Self::Evaluations => Knob::Evaluations,
            Self::List(knob, _) => *knob,
        }
    }

    /// The settings for a span of this length. The list of steps is long; a study stops on the way.
    pub(super) fn values(&self, span: f64) -> Vec<f64> {
        const SETTINGS: i32 = 50;
        let half_powers = |base: f64, count: i32| (0..count).map(move |k| base.powf(0.5 * f64::from(k)));
        match self {
            Self::Steps => {
                half_powers(2.0, SETTINGS).map(|factor| span.abs() / (8.0 * factor).round()).collect()
            }
            Self::Tolerances => {
                // By their decimals: a power would be off by a rounding, and long to write.
                let pair = |k: u32| [format!("1e-{k}"), format!("3e-{}", k + 1)];
                let texts = (2..15).flat_map(pair).chain(["1e-15".to_owned()]);
                texts.filter_map(|text| text.parse().ok()).collect()
            }
            Self::Evaluations => half_powers(2.0, SETTINGS).map(|factor| (24.0 * factor).round()).collect(),
            Self::List(_, values) => values.clone(),
        }
    }
}

/// A variant with its settings.
pub(super) struct Variant<const N: usize> {
    pub method: String,
    pub real: String,
    pub form: String,
    pub settings: Settings,
    pub make: Result<Box<dyn Fn(f64) -> Run<N>>, Failure>,
    pub code: Box<dyn Fn(f64) -> String>,
}

impl<const M: usize> Variant<M> {
    /// Returns the variant for states that are carried there and back.
    pub fn of_form<A, B, const N: usize>(self, form: &str, way: Rc<(A, B)>) -> Variant<N>
    where
        A: Fn(&[f64; N]) -> [f64; M] + 'static,
        B: Fn(&[f64; M]) -> [f64; N] + 'static,
    {
        let Self { method, real, settings, make, code, .. } = self;
        let make = make.map(|make| -> Box<dyn Fn(f64) -> Run<N>> {
            Box::new(move |setting| {
                let (run, way) = (make(setting), Rc::clone(&way));
                Box::new(move |task, out| {
                    let starts: Vec<[f64; M]> = task.starts.iter().map(&way.0).collect();
                    let &Task { t0, times, deadline, .. } = task;
                    let mut states = Vec::new();
                    let outcome = run(&Task { starts: &starts, t0, times, deadline }, &mut states);
                    out.extend(states.iter().map(&way.1));
                    outcome
                })
            })
        });
        let name = form.to_owned();
        let code = Box::new(move |setting| {
            format!("// `system` and `start` are those of the form `{name}`\n{}", code(setting))
        });
        Variant { method, real, form: form.to_owned(), settings, make, code }
    }
}

/// Deadlines are looked at after so many steps.
const STEPS_BETWEEN_LOOKS: u32 = 64;

/// Integrates from every start with a method.
pub(super) fn run_method<R, S, M, const N: usize>(
    system: &S,
    method: &M,
    task: &Task<'_, N>,
    out: &mut Vec<[f64; N]>,
) -> Result<Statistics, Failure>
where
    R: Real,
    S: System<R, N>,
    M: Method<R, S, N>,
{
    let times: Vec<R> = task.times.iter().map(|t| R::from_f64(*t)).collect();
    // The end alone needs no dense output.
    let samples = if times.len() > 1 { &times[..] } else { &[] };
    let mut total = Statistics::default();
    for start in task.starts {
        let mut visit = |_: usize, _: R, x: &[R; N]| out.push(x.map(R::to_f64));
        let mut steps = 0_u32;
        let mut look = |_: R, _: &[R; N]| {
            steps = steps.wrapping_add(1);
            let late =
                steps.is_multiple_of(STEPS_BETWEEN_LOOKS) && task.deadline.is_some_and(Deadline::is_over);
            if late { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let mut integration = Integration::new(system, R::from_f64(task.t0), &start.map(R::from_f64));
        if !samples.is_empty() {
            integration = integration.sample(samples, &mut visit);
        }
        if task.deadline.is_some() {
            integration = integration.observe(&mut look);
        }
        let done = integration
            .run(method, R::from_f64(task.end()))
            .map_err(|error| Failure::of_run(error.time.to_f64(), &error.cause))?;
        if done.outcome != Outcome::Arrived {
            return Err(Failure::out_of_time(Some(done.time.to_f64())));
        }
        total += done.statistics;
        if samples.is_empty() {
            out.push(done.state.map(R::to_f64));
        }
    }
    Ok(total)
}

/// A method on a system as a run.
pub(super) fn run_of<R, S, M, const N: usize>(system: Rc<S>, method: M) -> Run<N>
where
    R: Real,
    S: System<R, N> + 'static,
    M: Method<R, S, N> + 'static,
{
    Box::new(move |task, out| run_method::<R, S, M, N>(&system, &method, task, out))
}

/// A number of evaluations as a run: as many for each part of the span between two times.
pub(super) fn run_bounded<S, const N: usize>(
    system: Rc<S>,
    formula: fn(u32) -> Bounded,
    evaluations: f64,
) -> Run<N>
where
    S: System<f64, N> + 'static,
{
    Box::new(move |task, out| {
        let parts = task.times.len().max(1) as f64;
        let method = formula((evaluations / parts) as u32);
        let mut total = Statistics::default();
        for start in task.starts {
            let (mut t, mut x) = (task.t0, *start);
            for &next in task.times {
                if task.deadline.is_some_and(Deadline::is_over) {
                    return Err(Failure::out_of_time(Some(t)));
                }
                let bound = method
                    .advance(&*system, t, &x, next)
                    .map_err(|error| Failure::of_run(error.time, &error.cause))?;
                (t, x) = (next, bound.state);
                total += bound.statistics;
                out.push(x);
            }
        }
        Ok(total)
    })
}

/// The variant of a method that is made of a setting.
pub(super) fn variant<R, S, M, const N: usize>(
    names: [&str; 3],
    system: &Rc<S>,
    settings: Settings,
    make: impl Fn(f64) -> M + 'static,
    code: impl Fn(f64) -> String + 'static,
) -> Variant<N>
where
    R: Real,
    S: System<R, N> + 'static,
    M: Method<R, S, N> + 'static,
{
    let [method, real, form] = names.map(str::to_owned);
    let system = Rc::clone(system);
    let make = Box::new(move |setting| run_of::<R, S, M, N>(Rc::clone(&system), make(setting)));
    Variant { method, real, form, settings, make: Ok(make), code: Box::new(code) }
}

/// The limits of `Ordered` are those of methods whose steps follow the error.
pub(super) fn explicit_variants<R, S, const N: usize>(
    real: &'static str,
    system: &Rc<S>,
    span: (f64, f64),
    origin: Origin,
) -> Vec<Variant<N>>
where
    R: Ordered,
    S: System<R, N> + 'static,
{
    use guen_runtime::steppers::{Dop853, Rk4, Rk8, Tsit5};
    let code = move |constructor: &'static str, argument: Argument| {
        move |setting| super::code::run(origin, real, constructor, argument, setting, span)
    };
    let step = |setting: f64| R::from_f64(setting);
    let names = |method| [method, real, "declared"];
    vec![
        variant::<R, S, _, N>(
            names("RK4"),
            system,
            Settings::Steps,
            move |h| Rk4::new(step(h)),
            code("Rk4", Argument::Step),
        ),
        variant::<R, S, _, N>(
            names("RK8"),
            system,
            Settings::Steps,
            move |h| Rk8::new(step(h)),
            code("Rk8", Argument::Step),
        ),
        variant::<R, S, _, N>(
            names("Tsit5"),
            system,
            Settings::Tolerances,
            |tol| Tsit5::<R>::new(tol, tol),
            code("Tsit5", Argument::Tolerances),
        ),
        variant::<R, S, _, N>(
            names("DOP853"),
            system,
            Settings::Tolerances,
            |tol| Dop853::<R>::new(tol, tol),
            code("Dop853", Argument::Tolerances),
        ),
    ]
}
