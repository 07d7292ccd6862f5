//! Tsitouras's pair of orders five and four, with a step that adapts to a tolerance.

use crate::numbers::decimal::reals;
use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::short_ways::short_ways;
use crate::steppers::explicit::adaptive::{Adaptive, Attempt, Pair, Step};
use crate::steppers::explicit::tsit5_coefficients as published;
use crate::steppers::scaled;
use crate::steppers::settings::adaptive_settings;
use crate::steppers::step_size::{self, Control, Margin, Tolerance};
use crate::steppers::{ahead, arrived, leading, shifted, weighted};
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
}

impl<R: Real, const N: usize> Pair<R, N> for Formula<R> {
    type Stages = Stages<R, N>;

    type Errors = [R; N];

    const TRIAL: u64 = 6;
    const CONTROL: Control = Control { power: 5, safety: 0.8, shorten: 0.2, grow: 5.0, predict: true };

    #[inline]
    fn attempt<S>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> Attempt<R, Self, N>
    where
        S: System<R, N> + ?Sized,
    {
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
        Attempt { state, guess: state, stages: [*k1, k2, k3, k4, k5, k6, k7], errors, end: Some(k7) }
    }

    #[inline]
    fn margin(&self, errors: &[R; N], h: f64, weights: &[f64; N]) -> Margin {
        Margin::of_mean::<N>(h * h * step_size::squares(errors, weights))
    }

    fn dense<S>(&self, _system: &S, step: &Step<'_, R, Stages<R, N>, N>) -> (Dense<R, N>, u64)
    where
        S: System<R, N> + ?Sized,
    {
        let Step { from, to, stages, h, .. } = *step;
        // The formula's own slope at the end: where a constraint was restored, the state's is another.
        let hermite = Dense::hermite(from.time, h, &from.state, &stages[0], &to.state, &stages[6]);
        let bend = weighted(&self.d, stages.each_ref());
        (hermite.with_terms([scaled(h, &bend)]), 0)
    }
}

impl<R: Ordered, S: System<R, N> + ?Sized, const N: usize> Method<R, S, N> for Tsit5<R> {
    type Run<'a> = Adaptive<'a, Formula<R>, Stages<R, N>, R, N>;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Adaptive::new(&self.formula, self.settings(), start)
    }
}

short_ways!(Tsit5 over Ordered, systems System);
