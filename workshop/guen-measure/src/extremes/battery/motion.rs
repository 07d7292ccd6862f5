//! A motion through every method, against a reference in 71 digits.
//!
//! Errors are those of the end state: the largest over its entries, each relative to the largest value that it has in the
//! reference and the absolute tolerance, in the ratio in which the methods were given both.

use guen::prelude::*;
use guen::steppers::Method;
use guen::{Differentiable, Guarded, Liftable, TaylorSeries};
use guen_study::Digits71;

use super::growth::{allowed, growth};
use super::methods::{self, Promise, Settings, Visitor};
use super::reference::{Exact, Reference};
use super::{Answer, Line, Verdict};

/// What two methods may differ by in 71 digits.
const REFERENCE: f64 = 1e-11;
/// What a fixed step may be off by without a word: twice the guard's limit, since its estimate is one to within a factor.
const FIXED: f64 = 0.1;

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
    /// The absolute tolerance relative to the relative one: the size below which an entry is as good as zero.
    pub absolute: f64,
    /// What methods must be right to, where that is known better than from the growth of errors.
    pub bounds: &'static [(&'static str, f64)],
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
            absolute: 1e-3,
            bounds: &[],
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
        S: System<R, N> + Differentiable<R, N> + TaylorSeries<R, N> + Liftable<R, N, 0>,
        G: TaylorSeries<Digits71, N>,
    {
        let reference = if self.none {
            Err("there is no answer".to_owned())
        } else {
            Reference::new(&self.long, &self.start, self.span, self.absolute)
        };
        self.asked::<R>(asked.into(), reference, |settings, asker| {
            methods::all::<R, S, _, N>(settings, asker)
        })
    }

    /// Asks the explicit methods: for states so large that implicit ones take minutes to compile.
    pub fn ask_explicit<R>(self, asked: impl Into<String>) -> Line
    where
        R: Exact,
        S: System<R, N> + Liftable<R, N, 0>,
        G: System<Digits71, N>,
    {
        let reference = Reference::without_series(&self.long, &self.start, self.span, self.absolute);
        self.asked::<R>(asked.into(), reference, |settings, asker| {
            methods::explicit::<R, S, _, N>(settings, asker)
        })
    }

    fn asked<R>(
        self,
        asked: String,
        reference: Result<Reference<N>, String>,
        ask: impl for<'a> FnOnce(Settings, &mut Asker<'a, S, G, N>),
    ) -> Line
    where
        R: Exact,
        S: System<R, N> + Liftable<R, N, 0>,
    {
        let grown = match &reference {
            Ok(reference) => growth::<R, _, N>(&self.system, reference),
            Err(_) => Ok(1.0),
        };
        let (t0, t1) = self.span;
        let step = (t1 - t0).abs() / f64::from(self.steps);
        let settings = Settings { step, relative: self.tolerance, absolute: self.tolerance * self.absolute };
        let against = match (&reference, &grown) {
            (Ok(reference), Ok(growth)) => {
                format!("71 digits, checked to {:.0e}; errors grow {growth:.0e} times", reference.doubt)
            }
            (Ok(_), Err(text)) => format!("71 digits; how errors grow is not known: {text}"),
            (Err(text), _) if self.none => text.clone(),
            (Err(text), _) => format!("71 digits: {text}"),
        };
        let growth = grown.as_ref().copied().unwrap_or(f64::NAN);
        let mut asker = Asker { motion: &self, reference: &reference, growth, answers: Vec::new() };
        ask(settings, &mut asker);
        let mut answers = asker.answers;
        let doubtful = match &reference {
            Ok(reference) => reference.doubt.is_nan() || reference.doubt > REFERENCE || growth.is_nan(),
            Err(_) => !self.none,
        };
        if doubtful {
            answers.push(Answer { by: "reference", verdict: Verdict::Failed { text: against.clone() } });
        }
        Line { system: self.name, asked, against, answers }
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
        let Motion { system, start, span, bounds, due, none, .. } = self.motion;
        let start = start.map(R::from_f64);
        let begin = R::from_f64(span.0);
        let done = Integration::new(system, begin, &start).run(method, R::from_f64(span.1));
        let verdict = match (done, self.reference) {
            (Ok(done), Ok(reference)) if !none => {
                let known = bounds.iter().find(|(name, _)| *name == by).map(|(_, bound)| *bound);
                let allowed = known.unwrap_or_else(|| match promise {
                    Promise::Fixed => FIXED,
                    Promise::Adaptive(tolerance) => {
                        allowed::<N>(done.statistics.accepted, self.growth, tolerance)
                    }
                });
                Verdict::of(reference.error(&done.state), allowed)
            }
            // There is no such motion, and a number came back.
            (Ok(_), _) => Verdict::Silent { error: f64::INFINITY, allowed: 0.0 },
            (Err(error), _) => {
                let change = energy_change(system, begin, &start, &error);
                match refusal(&error, due.contains(&by)) {
                    Verdict::Refused { text, .. } if change > Guard::default().energy => Verdict::Failed {
                        text: format!("{text}; what is returned is off in energy by {change:.1e}"),
                    },
                    verdict => verdict,
                }
            }
        };
        self.answers.push(Answer { by, verdict });
    }
}

/// By how much the energy of the state that an error returns is off, relative to its scale; zero where none is kept.
fn energy_change<R: Real, S: System<R, N>, const N: usize>(
    system: &S,
    begin: R,
    start: &[R; N],
    error: &IntegrationError<R, N>,
) -> f64 {
    let [first, last] =
        [(begin, start), (error.time, &error.state)].map(|(t, x)| system.guarded().conserved(t, x));
    match (first.energy, last.energy) {
        (Some(first_energy), Some(energy)) => {
            let change = (energy - first_energy).to_f64().abs();
            let scale = first.scale.to_f64().max(last.scale.to_f64());
            if change == 0.0 { 0.0 } else { change / scale }
        }
        _ => 0.0,
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
        Cause::Contacts => "contacts",
        Cause::NoConvergence => "no convergence",
        Cause::Energy { .. } => "energy",
        Cause::Residual { .. } => "residual",
        Cause::ChartSingularity { .. } => "edge",
        Cause::ApproachingSingularity { .. } => "approach",
        Cause::Condition { .. } => "condition",
        Cause::Step { .. } => "step",
        Cause::Setting(_) => "setting",
        _ => "other",
    }
}
