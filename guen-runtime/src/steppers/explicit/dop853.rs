//! Dormand and Prince's method of order eight with estimates of orders five and three: the adaptive method. One
//! step of it is a [`Trial`] of the [`Tableau`].

pub use crate::steppers::explicit::tableau::{Tableau, Trial};

use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::short_ways::short_ways;
use crate::steppers::explicit::adaptive::{Adaptive, Pair, Step};
use crate::steppers::explicit::tableau::{Made, Stages, blank};
use crate::steppers::settings::adaptive_settings;
use crate::steppers::step_size::{self, Control, Margin, Tolerance};
use crate::system::System;

/// DOP853: order eight, with a step that adapts to a tolerance.
///
/// A step is accepted if its estimated error, in the mean over the entries, is below `atol + rtol |x_i|`:
///
/// ```text
/// err = |h| s5 / sqrt(N (s5 + s3 / 100)) <= 1      s_q = sum_i (error_q,i / (atol + rtol max |x_i|))^2
/// ```
///
/// with the estimates `error_5` and `error_3` of the [`Trial`] and the maximum over both ends of the step (at the far one of
/// the argument of stage 12, which is known earlier than the state). Since `s5`
/// falls as `h^10` and `s3` as `h^6`, this falls as `h^8`. The next step is the present one times
///
/// ```text
/// 0.8 min(err_n^(-1/8), (h_n / h_(n-1)) (err_(n-1) / err_n^2)^(1/8))
/// ```
///
/// between a third and six times, and no longer than the present one after a rejection: if errors of steps of the same size
/// grow, they are expected to go on to grow. `docs/design/step-control.md` has what that is worth.
///
/// - For smooth right-hand sides that are not stiff. Not symplectic.
/// - Tolerances and steps are `f64` for every real; with duals the values alone decide the steps.
/// - A trial that is not finite is repeated with a shorter step, so a motion may approach the edge of a domain;
///   if it cannot be continued, the error says [`Cause::NotFinite`](crate::Cause::NotFinite).
/// - Cost of a step: 12 evaluations if accepted, 11 if not; three more where dense output, of order seven, is asked
///   for.
/// - Source: E. Hairer and G. Wanner's program `dop853.f`, described in Hairer, Norsett and Wanner, *Solving
///   Ordinary Differential Equations I*, second edition, Springer 1993, as the program's own header says.
///   Differs from it: trials that are not finite are caught, the step before a landing is remembered after it, the next step is
///   predicted as above (after K. Gustafsson, ACM Transactions on Mathematical Software 20 (1994) 496-517, and `radau5.f`) by
///   roots to almost four digits, and there is no test for stiffness.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Dop853};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let done = Dop853::new(1e-12, 1e-12)
///     .integrate(&oscillator, 0.0, &[0.0, 1.0], 10.0, |_t, _x| ControlFlow::Continue(()))
///     .unwrap();
/// assert!((done.state[0] - 10.0_f64.sin()).abs() < 1e-10);
/// assert!(done.statistics.evaluations < 700);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dop853<R = f64> {
    /// The tolerance relative to each entry of the state: nonnegative.
    pub rtol: f64,
    /// The absolute tolerance, the same for every entry of the state: positive.
    pub atol: f64,
    /// The largest number of trial steps of one run.
    pub max_steps: u64,
    /// The first step to try, a positive duration; estimated from the right-hand side if absent.
    pub first_step: Option<f64>,
    tableau: Tableau<R>,
}

impl<R: Ordered> Dop853<R> {
    /// The method with the given relative and absolute tolerances.
    pub fn new(rtol: f64, atol: f64) -> Self {
        Self { rtol, atol, max_steps: Self::MAX_STEPS, first_step: None, tableau: Tableau::new() }
    }
}

adaptive_settings!(Dop853);

/// The sum of squares of errors, in units of the tolerance, below which there is no error: its square is below all numbers.
const NEGLIGIBLE_SQUARES: f64 = 1e-150;

impl<R: Real, const N: usize> Pair<R, N> for Tableau<R> {
    type Stages = Stages<R, N>;
    type Errors = [[R; N]; 2];

    const TRIAL: u64 = 11;
    const DENSE: u64 = 3;
    const CONTROL: Control = Control { power: 8, safety: 0.8, shorten: 0.333, grow: 6.0, predict: true };

    fn room() -> Made<R, N> {
        blank()
    }

    #[inline]
    fn attempt<S>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R, made: &mut Made<R, N>)
    where
        S: System<R, N> + ?Sized,
    {
        self.step(system, t, x, k1, h, made);
    }

    #[inline]
    fn margin(&self, [five, three]: &[[R; N]; 2], h: f64, weights: &[f64; N]) -> Margin {
        let five = step_size::squares(five, weights);
        let three = step_size::squares(three, weights);
        let size = h * five;
        Margin { allowed: N as f64 * (five + 0.01 * three) + NEGLIGIBLE_SQUARES, found: size * size }
    }

    fn dense<S>(&self, system: &S, step: &Step<'_, R, Stages<R, N>, N>) -> Dense<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        self.dense(system, step.stages, step.from, step.to, step.end, step.h)
    }
}

impl<R: Ordered, S: System<R, N> + ?Sized, const N: usize> Method<R, S, N> for Dop853<R> {
    type Run<'a> = Adaptive<'a, Tableau<R>, Stages<R, N>, R, N>;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Adaptive::new(&self.tableau, self.settings(), start)
    }
}

short_ways!(Dop853 over Ordered, systems System);

#[cfg(test)]
mod tests {
    extern crate std;

    use std::println;
    use std::vec::Vec;

    use super::*;
    use crate::steppers::{Statistics, StepperRun};
    use crate::system::from_fn;

    /// The formula with the step control of `dop853.f`.
    struct Original(Tableau);

    impl<const N: usize> Pair<f64, N> for Original {
        type Stages = Stages<f64, N>;
        type Errors = [[f64; N]; 2];

        const TRIAL: u64 = 11;
        const DENSE: u64 = 3;
        const CONTROL: Control = Control { power: 8, safety: 0.9, shorten: 0.333, grow: 6.0, predict: false };

        fn room() -> Made<f64, N> {
            blank()
        }

        fn attempt<S>(&self, system: &S, t: f64, x: &[f64; N], k1: &[f64; N], h: f64, made: &mut Made<f64, N>)
        where
            S: System<f64, N> + ?Sized,
        {
            self.0.attempt(system, t, x, k1, h, made);
        }

        fn margin(&self, errors: &[[f64; N]; 2], h: f64, weights: &[f64; N]) -> Margin {
            self.0.margin(errors, h, weights)
        }

        fn dense<S>(&self, system: &S, step: &Step<'_, f64, Stages<f64, N>, N>) -> Dense<f64, N>
        where
            S: System<f64, N> + ?Sized,
        {
            Pair::dense(&self.0, system, step)
        }
    }

    /// The times of the steps from zero to `t1`, the state there, and the work.
    fn steps<P: Pair<f64, N>, S: System<f64, N>, const N: usize>(
        pair: &P,
        system: &S,
        start: &[f64; N],
        t1: f64,
        tolerance: f64,
    ) -> (Vec<f64>, [f64; N], Statistics) {
        let tolerance = Tolerance { relative: tolerance, absolute: tolerance };
        let settings =
            crate::steppers::settings::Settings { tolerance, max_steps: 100_000, first_step: None };
        let mut run = Adaptive::new(pair, settings, &Checkpoint::new(0.0, start));
        let mut times = Vec::new();
        loop {
            run.advance(system, t1, false).unwrap();
            let reached = StepperRun::<f64, S, N>::checkpoint(&run);
            times.push(reached.time);
            if reached.time == t1 {
                return (times, reached.state, reached.statistics);
            }
        }
    }

    #[test]
    fn steps_are_those_of_the_original_program_with_its_control() {
        // `dop853.f`, called through scipy with these tolerances, counts 52 steps and 626 evaluations.
        let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
        let (times, _, work) = steps(&Original(Tableau::new()), &oscillator, &[0.0, 1.0], 10.0, 1e-12);
        assert_eq!(work, Statistics { evaluations: 626, accepted: 52, ..Statistics::default() });
        // The control takes its roots to almost four digits.
        for (time, original) in
            times.into_iter().zip([0.01778279410038923, 0.1244795587027246, 0.32690535550916894])
        {
            assert!((time / original - 1.0).abs() < 2e-4, "{time} instead of {original}");
        }
    }

    /// The evaluations of a motion at an error of 1e-8, and the number of rejected trials: read from the line through the
    /// logarithms of errors and evaluations at tolerances around it.
    fn work_at_equal_error<P: Pair<f64, N>, S: System<f64, N>, const N: usize>(
        pair: &P,
        system: &S,
        start: &[f64; N],
        t1: f64,
    ) -> (f64, f64) {
        let (_, exact, _) = steps(pair, system, start, t1, 1e-14);
        let (mut points, mut rejected) = (Vec::new(), 0.0);
        for k in 0..41 {
            let tolerance = 10.0_f64.powf(-7.0 - 0.1 * f64::from(k));
            let (_, end, work) = steps(pair, system, start, t1, tolerance);
            let error = (0..N).map(|i| (end[i] - exact[i]).abs()).fold(0.0, f64::max);
            points.push(((error / 1e-8).ln(), (work.evaluations as f64).ln()));
            rejected += work.rejected as f64 / (work.accepted + work.rejected) as f64 / 41.0;
        }
        let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / points.len() as f64;
        let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
        let slope = mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x) * (p.0 - x));
        ((y - slope * x).exp(), rejected)
    }

    /// Prints the ratios of evaluations and the rejections, and answers with the logarithm of the ratio.
    fn compared<S: System<f64, N>, const N: usize>(name: &str, system: S, start: [f64; N], t1: f64) -> f64 {
        let (original, often) = work_at_equal_error(&Original(Tableau::new()), &system, &start, t1);
        let (predicted, seldom) = work_at_equal_error(&Tableau::new(), &system, &start, t1);
        let ratio = predicted / original;
        println!("{name:<24} {predicted:5.0} / {original:5.0} = {ratio:5.3}   {seldom:5.3} {often:5.3}");
        assert!(ratio < 1.05 && seldom < 0.6 * often, "{name}");
        ratio.ln()
    }

    #[test]
    fn predicted_steps_are_cheaper_than_those_of_the_original_program() {
        println!("                         evaluations at 1e-8     rejected, predicted and original");
        let orbit = |e: f64| {
            let kepler = from_fn(|_t: f64, &[x, y, u, v]: &[f64; 4]| {
                let r = (x * x + y * y).sqrt();
                [u, v, -x / (r * r * r), -y / (r * r * r)]
            });
            compared("orbit", kepler, [1.0 - e, 0.0, 0.0, ((1.0 + e) / (1.0 - e)).sqrt()], 20.0)
        };
        let van_der_pol = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, 3.0 * (1.0 - x * x) * v - x]);
        let top = from_fn(|_t: f64, &[p, q, r]: &[f64; 3]| [-2.0 * q * r, 1.25 * r * p, -0.5 * p * q]);
        let driven = from_fn(|t: f64, &[x, v]: &[f64; 2]| [v, -x.sin() - 0.1 * v + 0.5 * (0.7 * t).cos()]);
        let double = from_fn(|_t: f64, &[a, b, u, v]: &[f64; 4]| {
            let (sin, cos) = (a - b).sin_cos();
            let first = -v * v * sin - 2.0 * 9.81 * a.sin();
            let second = u * u * sin - 9.81 * b.sin();
            let det = 2.0 - cos * cos;
            [u, v, (first - cos * second) / det, (2.0 * second - cos * first) / det]
        });
        let ratios = [
            orbit(0.3),
            orbit(0.6),
            orbit(0.9),
            compared("van der Pol", van_der_pol, [2.0, 0.5], 20.0),
            compared("free top", top, [1.0, 0.1, 0.9], 20.0),
            compared("driven pendulum", driven, [1.0, 0.5], 20.0),
            compared("double pendulum", double, [1.0, 0.5, 0.0, 0.0], 5.0),
        ];
        let mean = (ratios.iter().sum::<f64>() / ratios.len() as f64).exp();
        println!("in the mean {mean:.3}");
        assert!(mean < 0.93);
    }
}
