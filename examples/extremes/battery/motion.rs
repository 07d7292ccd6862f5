//! A motion through every method, against a reference in 71 digits.
//!
//! The reference is DOP853 in 71 digits with a tolerance of 1e-18, checked by a run with 1e-16. Errors are those of the end
//! state: the largest over its entries, each relative to the largest value that the entry has in the reference (an entry
//! that stays below a millionth of the largest one: relative to that millionth).

use guen::Differentiable;
use guen::prelude::*;
use guen::steppers::Method;
use guen_study::Digits71;

use super::methods::{self, Promise, Settings, Visitor};
use super::{Answer, Line, Verdict};

/// Values of the reference on the way, for the sizes of entries.
const SAMPLES: usize = 32;
/// What two settings of the reference may differ by.
const REFERENCE: f64 = 1e-11;
/// A fixed step is not to end with an answer that is further off than this times the growth of errors, without a word.
const FIXED: f64 = 0.1;
/// Adaptive methods are off by their tolerance times the growth of errors, this for all their steps, at most.
const STEPS: f64 = 1e4;
/// But never by more than this.
const WORST: f64 = 1e-3;

/// A motion to be asked for.
pub struct Motion<S, G, const N: usize> {
    pub name: &'static str,
    pub system: S,
    pub long: G,
    pub start: [f64; N],
    pub span: (f64, f64),
    /// Steps of RK4 over the span.
    pub steps: u32,
    pub tolerance: f64,
    /// The absolute tolerance relative to the relative one.
    pub absolute: f64,
    /// What adaptive methods must be right to, where that is known better than from the growth of errors.
    pub bound: Option<f64>,
    /// Methods from which an answer is due.
    pub due: &'static [&'static str],
    /// Whether no method may answer.
    pub none: bool,
}

impl<S, G, const N: usize> Motion<S, G, N> {
    /// Over a span of time, in a thousand steps, with an answer due from adaptive methods.
    pub fn new(name: &'static str, system: S, long: G, start: [f64; N], span: (f64, f64)) -> Self {
        Self {
            name,
            system,
            long,
            start,
            span,
            steps: 1000,
            tolerance: 1e-12,
            absolute: 1.0,
            bound: None,
            due: methods::ADAPTIVE,
            none: false,
        }
    }

    /// Whatever is answered must be right; a typed error will do.
    pub fn or_refused(self) -> Self {
        Self { due: &[], ..self }
    }

    /// A typed error is the only right answer.
    pub fn refused(self) -> Self {
        Self { due: &[], none: true, ..self }
    }

    /// Asks every method.
    pub fn ask<R>(self, asked: impl Into<String>) -> Line
    where
        R: Exact,
        S: System<R, N> + Differentiable<R, N>,
        G: System<Digits71, N>,
    {
        self.asked::<R>(asked.into(), |settings, asker| methods::all::<R, S, _, N>(settings, asker))
    }

    /// Asks the explicit methods: for states so large that implicit ones take minutes to compile.
    pub fn ask_explicit<R>(self, asked: impl Into<String>) -> Line
    where
        R: Exact,
        S: System<R, N>,
        G: System<Digits71, N>,
    {
        self.asked::<R>(asked.into(), |settings, asker| methods::explicit::<R, S, _, N>(settings, asker))
    }

    fn asked<R>(self, asked: String, ask: impl for<'a> FnOnce(Settings, &mut Asker<'a, S, G, N>)) -> Line
    where
        R: Exact,
        S: System<R, N>,
        G: System<Digits71, N>,
    {
        let reference = Reference::new(&self.long, &self.start, self.span);
        let growth = growth::<R, _, N>(&self.system, &self.start, self.span, &reference);
        let (t0, t1) = self.span;
        let step = (t1 - t0).abs() / f64::from(self.steps);
        let settings = Settings { step, relative: self.tolerance, absolute: self.tolerance * self.absolute };
        let against = match &reference {
            Ok(reference) => {
                format!(
                    "71 digits, two settings agree to {:.0e}; errors grow {growth:.0e} times",
                    reference.doubt
                )
            }
            Err(text) => format!("71 digits: {text}"),
        };
        let mut asker = Asker { motion: &self, reference: &reference, growth, answers: Vec::new() };
        ask(settings, &mut asker);
        let mut answers = asker.answers;
        if reference.as_ref().is_ok_and(|reference| reference.doubt.is_nan() || reference.doubt > REFERENCE) {
            answers.push(Answer { by: "reference", verdict: Verdict::Failed { text: against.clone() } });
        }
        Line { system: self.name, asked, against, answers }
    }
}

/// The end of a motion, and the size of each entry on the way.
pub struct Reference<const N: usize> {
    pub end: [Digits71; N],
    pub sizes: [f64; N],
    /// What two settings differ by.
    pub doubt: f64,
}

impl<const N: usize> Reference<N> {
    /// Runs it; the text of the error if there is no motion over the whole span.
    pub fn new<G: System<Digits71, N>>(
        long: &G,
        start: &[f64; N],
        (t0, t1): (f64, f64),
    ) -> Result<Self, String> {
        let start: [Digits71; N] = start.map(Digits71::from_f64);
        let times: [Digits71; SAMPLES + 1] = std::array::from_fn(|k| {
            let part = Digits71::from_ratio(k as i64, SAMPLES as i64);
            Digits71::from_f64(t0) + part * (Digits71::from_f64(t1) - Digits71::from_f64(t0))
        });
        let mut sizes = [0.0_f64; N];
        let mut run = |tolerance: f64, sampled: bool| {
            let mut visit = |_: usize, _: Digits71, x: &[Digits71; N]| {
                for (size, x) in sizes.iter_mut().zip(x) {
                    *size = size.max(x.to_f64().abs());
                }
            };
            let run = Integration::new(long, Digits71::from_f64(t0), &start);
            let run = if sampled { run.sample(&times, &mut visit) } else { run };
            run.run(
                &Dop853::new(tolerance, 1e-12 * tolerance).with_max_steps(3_000_000),
                Digits71::from_f64(t1),
            )
        };
        let end = run(1e-18, true).map_err(|error| format!("{error}"))?.state;
        let rough = run(1e-16, false).map_err(|error| format!("{error}"))?.state;
        let largest = sizes.iter().fold(0.0_f64, |most, size| most.max(*size));
        let sizes = sizes.map(|size| size.max(1e-6 * largest).max(f64::MIN_POSITIVE));
        let mut reference = Self { end, sizes, doubt: 0.0 };
        reference.doubt = reference.error(&rough);
        Ok(reference)
    }

    /// The largest relative error of a state.
    pub fn error<R: Exact>(&self, state: &[R; N]) -> f64 {
        let errors = state.iter().zip(&self.end).zip(self.sizes).map(|((x, exact), size)| {
            let off = x.long() - *exact;
            off.to_f64().abs() / size
        });
        errors.fold(0.0, |most, error| if error > most || error.is_nan() { error } else { most })
    }
}

/// By how much relative changes of the start grow until the end.
fn growth<R: Exact, S: System<R, N>, const N: usize>(
    system: &S,
    start: &[f64; N],
    (t0, t1): (f64, f64),
    reference: &Result<Reference<N>, String>,
) -> f64 {
    let Ok(reference) = reference else { return 1.0 };
    // Small against the motion, large against the errors of the run.
    let change = R::epsilon().to_f64().sqrt();
    let tolerance = 100.0 * R::epsilon().to_f64();
    let mut worst = 1.0_f64;
    // Two directions: what grows is seldom orthogonal to both.
    for signs in [0b0110_1001_u64, 0b1010_0011] {
        let moved: [R; N] = std::array::from_fn(|i| {
            let sign = if signs >> (i % 8) & 1 == 1 { 1.0 } else { -1.0 };
            R::from_f64(start[i] * (1.0 + change * sign))
        });
        let run = Integration::new(system, R::from_f64(t0), &moved)
            .guard(Guard::FINITE)
            .run(&Dop853::new(tolerance, 1e-6 * tolerance).with_max_steps(100_000), R::from_f64(t1));
        if let Ok(done) = run {
            worst = worst.max(reference.error(&done.state) / change);
        }
    }
    worst
}

/// Reals that long ones contain.
pub trait Exact: Ordered {
    /// The same number.
    fn long(self) -> Digits71;
}

impl Exact for Digits71 {
    fn long(self) -> Digits71 {
        self
    }
}

impl Exact for f64 {
    fn long(self) -> Digits71 {
        Digits71::from_f64(self)
    }
}

impl Exact for f32 {
    fn long(self) -> Digits71 {
        Digits71::from_f64(f64::from(self))
    }
}

/// Asks one method after the other.
struct Asker<'a, S, G, const N: usize> {
    motion: &'a Motion<S, G, N>,
    reference: &'a Result<Reference<N>, String>,
    growth: f64,
    answers: Vec<Answer>,
}

impl<R, S, G, const N: usize> Visitor<R, S, N> for Asker<'_, S, G, N>
where
    R: Exact,
    S: System<R, N>,
{
    fn visit<M: Method<R, S, N>>(&mut self, by: &'static str, promise: Promise, method: &M) {
        let Motion { system, start, span, bound, due, none, .. } = self.motion;
        let start = start.map(R::from_f64);
        let done = Integration::new(system, R::from_f64(span.0), &start).run(method, R::from_f64(span.1));
        let rounding = R::epsilon().to_f64();
        let verdict = match (done, self.reference) {
            (Ok(done), Ok(reference)) if !none => {
                let allowed = match promise {
                    Promise::Fixed => FIXED,
                    Promise::Adaptive(tolerance) => {
                        let grown = (STEPS * self.growth * tolerance.max(rounding)).min(WORST);
                        bound.unwrap_or(grown)
                    }
                };
                Verdict::of(reference.error(&done.state), allowed)
            }
            // There is no such motion, and a number came back.
            (Ok(_), _) => Verdict::Silent { error: f64::INFINITY, allowed: 0.0 },
            (Err(error), _) => refusal(&error, due.contains(&by)),
        };
        self.answers.push(Answer { by, verdict });
    }
}

/// A typed error, which must have kept what was computed before it.
pub fn refusal<R: Real, const N: usize>(error: &IntegrationError<R, N>, due: bool) -> Verdict {
    let text = format!("t = {:.3e}: {}", error.time.to_f64(), error.cause);
    if due || (error.statistics.accepted > 0 && error.state.iter().any(|x| !x.is_finite())) {
        return Verdict::Failed { text };
    }
    Verdict::Refused { short: short(&error.cause).to_owned(), text }
}

/// A cause in a word.
pub fn short(cause: &Cause) -> &'static str {
    match cause {
        Cause::NotFinite => "not finite",
        Cause::StepUnderflow => "underflow",
        Cause::TooManySteps { .. } => "too many steps",
        Cause::Positions => "positions",
        Cause::NoConvergence => "no convergence",
        Cause::Energy { .. } => "energy",
        Cause::Residual { .. } => "residual",
        Cause::Edge { .. } => "edge",
        Cause::Condition { .. } => "condition",
        Cause::Step { .. } => "step",
        Cause::Setting(_) => "setting",
        _ => "other",
    }
}
