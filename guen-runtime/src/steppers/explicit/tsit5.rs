//! Tsitouras's pair of orders five and four, with a step that adapts to a tolerance.

use crate::numbers::decimal::reals;
use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::short_ways::short_ways;
use crate::steppers::explicit::adaptive::{Adaptive, Attempt, Pair, Step};
use crate::steppers::explicit::in_place::{argument, combine};
use crate::steppers::explicit::tsit5_coefficients as published;
use crate::steppers::scaled;
use crate::steppers::settings::adaptive_settings;
use crate::steppers::step_size::{self, Control, Margin, Tolerance};
use crate::steppers::{ahead, arrived, is_long, leading, shifted, weighted};
use crate::system::System;

/// Tsit5: order five, with a step that adapts to a tolerance.
///
/// A step is accepted if its estimated error, in the mean over the entries, is below `atol + rtol |x_i|`:
///
/// ```text
/// err = |h| sqrt(sum_i (error_i / (atol + rtol max |x_i|))^2 / N) <= 1
/// ```
///
/// with the difference to the formula of order four. The next step is the present one times
/// `0.8 min(err_n^(-1/5), (h_n / h_(n-1)) (err_(n-1) / err_n^2)^(1/5))`, between a fifth and five times, and no longer than
/// the present one after a rejection.
///
/// - For low accuracy, and for short steps between samples and inputs; from about 1e-4 on
///   [`Dop853`](crate::steppers::Dop853) needs fewer evaluations. Not for stiff systems; not symplectic.
/// - Tolerances, steps, domains and failures as of [`Dop853`](crate::steppers::Dop853).
/// - Cost of a step: 6 evaluations, accepted or not. Dense output, of order four (`O(h^5)`), costs none.
/// - Source: C. Tsitouras, *Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying assumption*,
///   Computers & Mathematics with Applications 62 (2011) 770-775. Step control as of DOP853 with other constants.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Tsit5};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let done = Tsit5::new(1e-6, 1e-6)
///     .integrate(&oscillator, 0.0, &[0.0, 1.0], 10.0, |_t, _x| ControlFlow::Continue(()))
///     .unwrap();
/// assert!((done.state[0] - 10.0_f64.sin()).abs() < 1e-4);
/// assert!(done.statistics.evaluations < 300);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tsit5<R = f64> {
    /// The tolerance relative to each entry of the state: nonnegative.
    pub rtol: f64,
    /// The absolute tolerance, the same for every entry of the state: positive.
    pub atol: f64,
    /// The largest number of trial steps of one run.
    pub max_steps: u64,
    /// The first step to try, a positive duration; estimated from the right-hand side if absent.
    pub first_step: Option<f64>,
    pub(in crate::steppers) formula: Formula<R>,
}

impl<R: Ordered> Tsit5<R> {
    /// The method with the given relative and absolute tolerances.
    pub fn new(rtol: f64, atol: f64) -> Self {
        Self { rtol, atol, max_steps: Self::MAX_STEPS, first_step: None, formula: Formula::new() }
    }
}

adaptive_settings!(Tsit5);

/// The coefficients in the real `R`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formula<R> {
    c: [R; 5],
    a2: [R; 1],
    a3: [R; 2],
    a4: [R; 3],
    a5: [R; 4],
    a6: [R; 5],
    b: [R; 6],
    e: [R; 7],
    d: [R; 7],
}

/// The slopes of all seven stages.
pub(crate) type Stages<R, const N: usize> = [[R; N]; 7];

/// A step with what it was made of.
type Made<R, const N: usize> = Attempt<R, Stages<R, N>, [R; N], N>;

impl<R: Real> Formula<R> {
    pub(in crate::steppers) fn new() -> Self {
        Self {
            c: reals(&published::C),
            a2: reals(&published::A2),
            a3: reals(&published::A3),
            a4: reals(&published::A4),
            a5: reals(&published::A5),
            a6: reals(&published::A6),
            b: reals(&published::B),
            e: reals(&published::E),
            d: reals(&published::D),
        }
    }

    /// Makes a step for a long state, to the bit as it is made for a short one.
    fn attempt_in_place<S, const N: usize>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
        made: &mut Made<R, N>,
    ) where
        S: System<R, N> + ?Sized,
    {
        let Self { c, a2, a3, a4, a5, a6, b, e, .. } = self;
        let Attempt { state, guess, stages, errors, end } = made;
        let rows: [&[R]; 6] = [a2, a3, a4, a5, a6, b];
        stages[0] = *k1;
        for (i, weights) in rows.into_iter().enumerate() {
            argument::<true, _, _>(guess, (x, h), weights, i.min(1), |j| &stages[j]);
            let node = c.get(i).copied().unwrap_or(R::one());
            stages[i + 1] = system.rhs(t + node * h, guess);
        }
        *state = *guess;
        combine(errors, e, |j| &stages[j]);
        *end = Some(stages[6]);
    }
}

impl<R: Real, const N: usize> Pair<R, N> for Formula<R> {
    type Stages = Stages<R, N>;

    type Errors = [R; N];

    const TRIAL: u64 = 6;
    const DENSE: u64 = 0;
    const CONTROL: Control = Control { power: 5, safety: 0.8, shorten: 0.2, grow: 5.0, predict: true };

    fn room() -> Made<R, N> {
        let none = [R::zero(); N];
        Attempt { state: none, guess: none, stages: [none; 7], errors: none, end: None }
    }

    #[inline]
    fn attempt<S>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R, made: &mut Made<R, N>)
    where
        S: System<R, N> + ?Sized,
    {
        if const { is_long::<N>() } {
            return self.attempt_in_place(system, t, x, k1, h, made);
        }
        // As in DOP853: all but the last slope's part is summed up before that slope is asked for.
        let c = &self.c;
        let at2 = shifted(x, h, &weighted(&self.a2, [k1]));
        let near3 = ahead::<true, _, _, _>(x, h, &self.a3, [k1]);
        let k2 = system.rhs(t + c[0] * h, &at2);
        let at3 = arrived::<true, _, _>(x, h, &near3, self.a3[1], &k2);
        let near4 = ahead::<true, _, _, _>(x, h, &self.a4, [k1, &k2]);
        let k3 = system.rhs(t + c[1] * h, &at3);
        let at4 = arrived::<true, _, _>(x, h, &near4, self.a4[2], &k3);
        let near5 = ahead::<true, _, _, _>(x, h, &self.a5, [k1, &k2, &k3]);
        let k4 = system.rhs(t + c[2] * h, &at4);
        let at5 = arrived::<true, _, _>(x, h, &near5, self.a5[3], &k4);
        let near6 = ahead::<true, _, _, _>(x, h, &self.a6, [k1, &k2, &k3, &k4]);
        let k5 = system.rhs(t + c[3] * h, &at5);
        let at6 = arrived::<true, _, _>(x, h, &near6, self.a6[4], &k5);
        let near = ahead::<true, _, _, _>(x, h, &self.b, [k1, &k2, &k3, &k4, &k5]);
        let k6 = system.rhs(t + c[4] * h, &at6);
        let state = arrived::<true, _, _>(x, h, &near, self.b[5], &k6);
        let error = leading(&self.e, [k1, &k2, &k3, &k4, &k5, &k6]);
        let k7 = system.rhs(t + h, &state);
        let errors = shifted(&error, self.e[6], &k7);
        *made = Attempt { state, guess: state, stages: [*k1, k2, k3, k4, k5, k6, k7], errors, end: Some(k7) };
    }

    #[inline]
    fn margin(&self, errors: &[R; N], h: f64, weights: &[f64; N]) -> Margin {
        Margin::of_mean::<N>(h * h * step_size::squares(errors, weights))
    }

    fn dense<S>(&self, _system: &S, step: &Step<'_, R, Stages<R, N>, N>) -> Dense<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let Step { from, to, stages, h, .. } = *step;
        // The formula's own slope at the end: where a constraint was restored, the state's is another.
        let mut dense = Dense::hermite(from.time, h, &from.state, &stages[0], &to.state, &stages[6]);
        dense.add_terms::<1>(|_| scaled(h, &weighted(&self.d, stages.each_ref())));
        dense
    }
}

impl<R: Ordered, S: System<R, N> + ?Sized, const N: usize> Method<R, S, N> for Tsit5<R> {
    type Run<'a> = Adaptive<'a, Formula<R>, Stages<R, N>, R, N>;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Adaptive::new(&self.formula, self.settings(), start)
    }
}

short_ways!(Tsit5 over Ordered, systems System);

#[cfg(test)]
mod tests {
    use super::{Formula, Made};
    use crate::steppers::explicit::adaptive::Pair;
    use crate::{System, from_fn};

    #[test]
    fn steps_in_place_are_those_by_expressions() {
        let pendulum = from_fn(|t: f64, &[q, w, z]: &[f64; 3]| [w, z * t - q.sin(), q * w - z]);
        let formula = Formula::new();
        for k in 1..50 {
            let part = |numerator: i32| f64::from(numerator) / 97.0;
            let (t, x, h) = (part(k), [part(3 * k), part(40 - k), part(7 - 2 * k)], part(2 * k - 51));
            let k1 = pendulum.rhs(t, &x);
            let (mut here, mut there): (Made<f64, 3>, Made<f64, 3>) = (Formula::room(), Formula::room());
            formula.attempt(&pendulum, t, &x, &k1, h, &mut here);
            formula.attempt_in_place(&pendulum, t, &x, &k1, h, &mut there);
            assert!(here.state == there.state && here.guess == there.guess, "step {k}");
            assert!(here.stages == there.stages && here.errors == there.errors, "step {k}");
            assert_eq!(here.end, there.end);
        }
    }
}
