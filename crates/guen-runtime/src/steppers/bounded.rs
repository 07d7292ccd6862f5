//! Bounded work: to a time with at most so many evaluations, and the error that this leaves.

use super::adaptive::Pair;
use super::all_finite;
use super::course::{Reached, Statistics};
use super::tableau::{Tableau, Trial};
use super::tsit5::Formula;
use crate::error::{Cause, IntegrationError, Setting};
use crate::real::{Ordered, Real};
use crate::system::System;

/// Goes over a span in equal steps, as many as a number of evaluations allows and never more: for control periods, whose
/// time is given and whose end has to be reached.
///
/// - The work depends on the settings alone: the same steps, the same evaluations, whatever the state. The formula is
///   that of [`Dop853`](super::Dop853) or of [`Tsit5`](super::Tsit5), with `12 n` or `6 n + 1` evaluations for `n` steps.
/// - What it leaves is an estimate of the error of every entry: the sum over the steps of the absolute values of the
///   formula's own estimates. How an error grows after it was made is not in it, so it is meant for spans over which
///   errors do not grow much. For DOP853 an entry's estimate is `h e5^2 / sqrt(e5^2 + e3^2 / 100)`, as in its step control.
/// - Whether that is good enough is the caller's decision: [`Bound::error`] is what to compare.
/// - No guard looks at the run except that all states are finite.
///
/// ```
/// use guen_runtime::{from_fn, steppers::Bounded};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let period = Bounded::tsit5(25).advance(&oscillator, 0.0, &[0.0, 1.0], 0.5).unwrap();
/// assert_eq!((period.statistics.accepted, period.statistics.evaluations), (4, 25));
/// let off = (period.state[0] - 0.5_f64.sin()).abs();
/// assert!(off < 1e-7 && period.error[0] < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded<R = f64> {
    evaluations: u32,
    formula: Kind<R>,
}

/// The larger of the two formulas is only a few times as large as the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "nothing is allocated")]
enum Kind<R> {
    Dop853(Tableau<R>),
    Tsit5(Formula<R>),
}

/// What a bounded run reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound<R, const N: usize> {
    /// The state at the end of the span.
    pub state: [R; N],
    /// An estimate of the error of each entry, not negative.
    pub error: [f64; N],
    /// The work done: the evaluations are at most those allowed.
    pub statistics: Statistics,
}

impl<R: Ordered> Bounded<R> {
    /// Steps of DOP853, order eight: 12 evaluations each.
    pub fn dop853(evaluations: u32) -> Self {
        Self { evaluations, formula: Kind::Dop853(Tableau::new()) }
    }

    /// Steps of Tsit5, order five: 6 evaluations each and one more.
    pub fn tsit5(evaluations: u32) -> Self {
        Self { evaluations, formula: Kind::Tsit5(Formula::new()) }
    }

    /// The number of equal steps that the evaluations allow.
    pub fn steps(&self) -> u32 {
        match self.formula {
            Kind::Dop853(_) => self.evaluations / 12,
            Kind::Tsit5(_) => self.evaluations.saturating_sub(1) / 6,
        }
    }

    /// Goes from the state `x0` at `t0` to `t1`, forwards or backwards. A span of zero is no step.
    ///
    /// # Errors
    ///
    /// Fewer evaluations than one step takes; a time that is not finite; a state or rate that is not finite, or cannot be
    /// put back onto its constraints. The error carries the last good time and state.
    pub fn advance<S, const N: usize>(
        &self,
        system: &S,
        t0: R,
        x0: &[R; N],
        t1: R,
    ) -> Result<Bound<R, N>, IntegrationError<R, N>>
    where
        S: System<R, N> + ?Sized,
    {
        let start = Reached::new(t0, x0);
        let steps = self.steps();
        if steps == 0 {
            return Err(start.failed(Cause::Setting(Setting::Budget)));
        }
        if !t0.is_finite() || !t1.is_finite() {
            return Err(start.failed(Cause::Setting(Setting::Time)));
        }
        match &self.formula {
            Kind::Dop853(tableau) => advance(tableau, system, start, t1, steps, dop853_error),
            Kind::Tsit5(formula) => advance(formula, system, start, t1, steps, |errors: &[R; N], h| {
                errors.map(|error| (h * error.to_f64()).abs())
            }),
        }
    }
}

/// DOP853's two estimates as one, for each entry.
fn dop853_error<R: Real, const N: usize>(errors: &Trial<R, N>, h: f64) -> [f64; N] {
    core::array::from_fn(|i| {
        let (five, three) = (errors.error5[i].to_f64(), errors.error3[i].to_f64());
        let size = libm::sqrt(five * five + 0.01 * three * three);
        if five == 0.0 { 0.0 } else { h * five * (five / size).abs() }.abs()
    })
}

fn advance<P, S, R, const N: usize>(
    pair: &P,
    system: &S,
    mut reached: Reached<R, N>,
    t1: R,
    steps: u32,
    estimate: impl Fn(&P::Errors, f64) -> [f64; N],
) -> Result<Bound<R, N>, IntegrationError<R, N>>
where
    P: Pair<R, N>,
    S: System<R, N> + ?Sized,
    R: Real,
{
    let (t0, span) = (reached.time, t1 - reached.time);
    let mut error = [0.0; N];
    let mut end: Option<[R; N]> = None;
    let steps = if span == R::zero() { 0 } else { steps };
    for step in 1..=steps {
        let time = reached.time;
        let next = if step == steps { t1 } else { t0 + span * R::from_ratio(step.into(), steps.into()) };
        let h = next - time;
        let slope = end.take().unwrap_or_else(|| {
            reached.statistics.evaluations += 1;
            system.rhs(time, &reached.state)
        });
        let attempt = pair.attempt(system, time, &reached.state, &slope, h);
        reached.statistics.evaluations += P::TRIAL;
        let mut state = attempt.state;
        if !all_finite(&state) {
            return Err(reached.failed(Cause::NotFinite));
        }
        system.restore(next, &mut state).map_err(|_| reached.failed(Cause::Positions))?;
        for (sum, part) in error.iter_mut().zip(estimate(&attempt.errors, h.to_f64().abs())) {
            *sum += part;
        }
        // Where the state was put back, the slope at the end is that of the state before, by a difference of the size
        // of the error: another evaluation would be one too many.
        end = attempt.end;
        reached.time = next;
        reached.state = state;
        reached.statistics.accepted += 1;
    }
    Ok(Bound { state: reached.state, error, statistics: reached.statistics })
}
