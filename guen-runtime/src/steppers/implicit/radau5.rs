//! The method of Radau of order five with a step that adapts to a tolerance, for stiff systems.

use crate::linear_algebra::lu::Complex;
use crate::numbers::decimal::{Parts, decimal};
use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method, StepperRun};
use crate::steppers::driver::short_ways::short_ways;
use crate::steppers::implicit::collocation::{Collocation, Factors, combined};
use crate::steppers::settings::adaptive_settings;
use crate::steppers::step_size::{self, Control, Margin, Tolerance};
use crate::steppers::{all_finite, entries};
use crate::system::derivatives::differentiable::Differentiable;

/// Radau IIA with three stages: order five, for stiff systems, with a step that adapts to a tolerance.
///
/// The equations of a step, `Z_i = h sum_j a_ij f(t + c_j h, x + Z_j)` with `x(t + h) = x + Z_3`, are solved by Newton's
/// method with one Jacobian for all stages. A step is accepted if its estimated error is below the tolerance in the
/// mean over the entries,
///
/// ```text
/// err = |(gamma/h - J)^-1 (f(t, x) + (e_1 Z_1 + e_2 Z_2 + e_3 Z_3) / h)| <= 1
/// e = (-13 - 7 sqrt(6), -13 + 7 sqrt(6), -1) / 3
/// ```
///
/// the difference to a formula of order three, with `gamma` the real eigenvalue of `A^-1`. Since the result is of order
/// five, its error is usually far below the tolerance.
///
/// - For rates of damping and stiffness far beyond what the motion shows: L-stable, so what decays at a rate of 1e6
///   decays and does not limit the step. Not symplectic. On systems that are not stiff [`Dop853`](crate::steppers::Dop853) costs
///   a tenth.
/// - The Jacobian is kept while Newton's method converges fast, its factors while the step stays.
/// - Trials that are not finite, or whose equations are not solved, are repeated with a shorter step; the error says
///   [`Cause::NotFinite`] or [`Cause::NoConvergence`] if that does not help.
/// - Cost of a step: about ten evaluations, and `N^3` operations for each factorisation. Dense output is the polynomial
///   of collocation, `O(h^4)`, and costs nothing.
/// - Source: E. Hairer and G. Wanner, *Solving Ordinary Differential Equations II*, second edition, Springer 1996,
///   section IV.8, and their program `radau5.f`. Differs from it: no Gustafsson control, no transformation of the
///   tolerances, steps kept only where they would grow by less than a fifth.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{Equations, Real, generic, steppers::Radau5};
///
/// /// A motion towards cos(t) at a rate of a million.
/// struct Stiff;
/// impl Equations<1> for Stiff {
///     fn rates<R: Real>(&self, t: R, &[x]: &[R; 1]) -> [R; 1] {
///         [-R::from_ratio(1_000_000, 1) * (x - t.cos()) - t.sin()]
///     }
/// }
///
/// let done = Radau5::new(1e-8, 1e-8)
///     .integrate(&generic(Stiff), 0.0, &[0.0], 10.0, |_t, _x| ControlFlow::Continue(()))
///     .unwrap();
/// assert!((done.state[0] - 10.0_f64.cos()).abs() < 1e-8);
/// assert!(done.statistics.evaluations < 1500);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radau5<R = f64> {
    /// The tolerance relative to each entry of the state: nonnegative.
    pub rtol: f64,
    /// The absolute tolerance, the same for every entry of the state: positive.
    pub atol: f64,
    /// The largest number of trial steps of one run.
    pub max_steps: u64,
    /// The first step to try, a positive duration; estimated from the right-hand side if absent.
    pub first_step: Option<f64>,
    /// Absent in a real that is too short for the coefficients: no step can be made then.
    pub(in crate::steppers) collocation: Option<Collocation<R, 3>>,
    error: [R; 3],
}

/// The eigenvalues of `A^-1`: the roots of `z^3 - 9 z^2 + 36 z - 60`.
const REAL: Parts = decimal("3.637834252744495732208418513577776");
const RE: Parts = decimal("2.681082873627752133895790743211112");
const IM: Parts = decimal("3.050430199247410569426377624787568");

const CONTROL: Control = Control { power: 4, safety: 0.9, shorten: 0.125, grow: 5.0, predict: false };

impl<R: Ordered> Radau5<R> {
    /// The method with the given relative and absolute tolerances.
    pub fn new(rtol: f64, atol: f64) -> Self {
        let ratio = R::from_ratio;
        let root = ratio(6, 1).sqrt();
        let with_root = |n: i64, m: i64, den: i64| (ratio(n, 1) + ratio(m, 1) * root) / ratio(den, 1);
        let c = [with_root(4, -1, 10), with_root(4, 1, 10), R::one()];
        let a = [
            [with_root(88, -7, 360), with_root(296, -169, 1800), with_root(-2, 3, 225)],
            [with_root(296, 169, 1800), with_root(88, 7, 360), with_root(-2, -3, 225)],
            [with_root(16, -1, 36), with_root(16, 1, 36), ratio(1, 9)],
        ];
        let pair = Complex { re: R::from_parts(&RE), im: R::from_parts(&IM) };
        let mut collocation = Collocation::new(c, a, a[2], Some(R::from_parts(&REAL)), pair);
        if let Some(collocation) = &mut collocation {
            // Stiffly accurate: the end of the step is the last stage, without rounding.
            collocation.d = [R::zero(), R::zero(), R::one()];
        }
        let error = [with_root(-13, -7, 3), with_root(-13, 7, 3), ratio(-1, 3)];
        Self { rtol, atol, max_steps: Self::MAX_STEPS, first_step: None, collocation, error }
    }
}

adaptive_settings!(Radau5);

impl<R: Ordered, S: Differentiable<R, N> + ?Sized, const N: usize> Method<R, S, N> for Radau5<R> {
    type Run<'a> = Run<'a, R, N>;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        let (reached, origin) = (*start, start.time);
        Run {
            method: self,
            origin,
            reached,
            before: reached,
            ready: None,
            last: None,
            jacobian: None,
            factors: None,
        }
    }
}

short_ways!(Radau5 over Ordered, systems Differentiable);

/// A run of the method.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a, R, const N: usize> {
    method: &'a Radau5<R>,
    /// The time at which the run began.
    origin: R,
    reached: Checkpoint<R, N>,
    before: Checkpoint<R, N>,
    ready: Option<Ready<R, N>>,
    /// The step made last, with its stages.
    last: Option<(R, [[R; N]; 3])>,
    /// The Jacobian, if Newton's method converges fast with it, and whether it is that of the present state.
    jacobian: Option<([[R; N]; N], bool)>,
    factors: Option<(R, Factors<R, N>)>,
}

/// The slope at the present state, and the step to try.
#[derive(Clone, Copy, Debug)]
struct Ready<R, const N: usize> {
    slope: [R; N],
    step: f64,
}

/// The end of Newton's method.
enum Solved<R, const N: usize> {
    /// The stages, after so many iterations, of which the last reduced the step by this factor.
    Stages([[R; N]; 3], u32, f64),
    Diverged,
    NotFinite,
}

impl<R: Ordered, const N: usize> Run<'_, R, N> {
    fn start<S>(&mut self, system: &S, target: R) -> Result<Ready<R, N>, Cause>
    where
        S: Differentiable<R, N> + ?Sized,
    {
        let settings = self.method.settings();
        let (slope, first_step) = settings.begin(system, &mut self.reached)?;
        if let Some(step) = first_step {
            return Ok(Ready { slope, step });
        }
        let (tolerance, Checkpoint { time, state, .. }) = (settings.tolerance, self.reached);
        let span = (target - time).to_f64();
        let (guess, slope_size) = tolerance.first_guess(&state, &slope, span.abs());
        Ok(Ready { slope, step: CONTROL.first_step(guess, slope_size, 0.0, span.abs()) })
    }

    /// Solves the equations of a step to a part of the tolerance.
    fn solve<S>(
        &mut self,
        system: &S,
        collocation: &Collocation<R, 3>,
        factors: &Factors<R, N>,
        h: R,
        start: Option<[[R; N]; 3]>,
        weights: &[f64; N],
    ) -> Solved<R, N>
    where
        S: Differentiable<R, N> + ?Sized,
    {
        const STAGE_ITERATIONS: u32 = 10;
        /// Part of the tolerance that the equations are solved to at least.
        const MAX_TOLERANCE_PART: f64 = 0.03;
        const TOLERANCE_ROUNDINGS: f64 = 10.0;
        /// A rate of convergence that is none.
        const DIVERGENT_RATE: f64 = 0.99;

        // The tolerance relative to the entry that it is strictest for: what is solved for is better than it by a
        // factor that grows with it, so that the error of order five is not lost, but never better than rounding.
        let strictest = self
            .reached
            .state
            .iter()
            .zip(weights)
            .fold(0.0_f64, |most, (x, weight)| most.max(x.to_f64().abs() * weight));
        let relative = 1.0 / strictest;
        let enough = (TOLERANCE_ROUNDINGS * R::epsilon().to_f64() / relative)
            .max(libm::sqrt(relative).min(MAX_TOLERANCE_PART));
        let mut z = start.unwrap_or([[R::zero(); N]; 3]);
        let (mut last, mut rate) = (f64::INFINITY, 0.0);
        for iteration in 1..=STAGE_ITERATIONS {
            let Checkpoint { time, state, .. } = &self.reached;
            let step = collocation.newton(system, factors, (*time, state, h), &z);
            self.reached.statistics.evaluations += 3;
            let mut squares = 0.0;
            for (stage, step) in z.iter_mut().zip(&step) {
                squares += step_size::squares(step, weights);
                for k in 0..N {
                    stage[k] += step[k];
                }
            }
            let size = libm::sqrt(squares / (3 * N.max(1)) as f64);
            if !size.is_finite() {
                // Of numbers, the size may be beyond the range of doubles in units of a tiny tolerance.
                let defined = z.iter().all(all_finite);
                return if defined { Solved::Diverged } else { Solved::NotFinite };
            }
            let mut left = if size == 0.0 { 0.0 } else { f64::INFINITY };
            if iteration > 1 && size > 0.0 {
                rate = size / last;
                if rate >= DIVERGENT_RATE {
                    return Solved::Diverged;
                }
                left = size * rate / (1.0 - rate);
                let remaining = (STAGE_ITERATIONS - iteration) as i32;
                if left * Real::powi(rate, remaining) > enough {
                    return Solved::Diverged;
                }
            }
            if left <= enough {
                return Solved::Stages(z, iteration, rate);
            }
            last = size;
        }
        Solved::Diverged
    }
}

impl<R, S, const N: usize> StepperRun<R, S, N> for Run<'_, R, N>
where
    R: Ordered,
    S: Differentiable<R, N> + ?Sized,
{
    const EVALUATIONS: u32 = 10;

    type Polynomial = Dense<R, N>;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        &self.reached
    }

    fn advance(&mut self, system: &S, target: R, _dense: bool) -> Result<(), Cause> {
        /// The rate of convergence below which the Jacobian is good enough for the next step.
        const FAST_RATE: f64 = 1e-3;
        /// A step that would grow by less than this stays as it is, with its factors.
        const MIN_GROWTH: f64 = 1.2;
        /// Steps that differ by less have the same factors, which make Newton's method converge no more slowly than a Jacobian
        /// that is kept.
        const SAME_STEP: f64 = 1e-5;

        let collocation = self.method.collocation.as_ref().ok_or(Cause::NoConvergence)?;
        let Ready { slope, step } = match self.ready {
            Some(ready) => ready,
            None => self.start(system, target)?,
        };
        let tolerance = self.method.settings().tolerance;
        let Checkpoint { time, time_rest, state, .. } = self.reached;
        let weights = tolerance.weights(&state, &state);
        let span = ((target - time) - time_rest).to_f64();
        let shortest = step_size::shortest(time, self.origin);
        let mut step = if step < shortest { shortest } else { step };
        let mut rejected = false;
        let mut last_trouble = Cause::StepUnderflow;
        let max_steps = self.method.max_steps;
        loop {
            let statistics = &mut self.reached.statistics;
            if statistics.accepted + statistics.rejected >= max_steps {
                return Err(Cause::TooManySteps { limit: max_steps });
            }
            let landing = step_size::STRETCH * step > span.abs();
            let next = if landing { target } else { time + R::from_f64(step.copysign(span)) };
            // The distance that time really moves.
            let h = (next - time) - time_rest;
            let size = h.to_f64().abs();
            if !(R::one() / h).is_finite() {
                // Next to the time zero steps become that short, and no equations of them can be solved.
                return Err(last_trouble);
            }
            let (jacobian, present) = match self.jacobian {
                Some(known) => known,
                None => {
                    statistics.jacobians += 1;
                    self.factors = None;
                    (system.jacobian(time, &state), true)
                }
            };
            self.jacobian = Some((jacobian, present));
            let factors = match self.factors {
                Some((at, factors)) if step_size::nearly_the_same(at, h, SAME_STEP) => Some(factors),
                _ => {
                    let factors = collocation.factor(&jacobian, h);
                    self.factors = factors.map(|factors| (h, factors));
                    factors
                }
            };
            let start = self.last.map(|(before, z)| collocation.predicted(&z, h / before));
            let solved = match &factors {
                Some(factors) => self.solve(system, collocation, factors, h, start, &weights),
                // A matrix without an inverse, or beyond the range of doubles.
                None if jacobian.iter().all(all_finite) => Solved::Diverged,
                None => Solved::NotFinite,
            };
            let (trouble, factor) = match (solved, &factors) {
                (Solved::Stages(z, iterations, rate), Some(Factors { real: Some(lu), .. })) => {
                    // An estimate of the error, filtered by the real system so that stiff parts do not inflate it.
                    let recip = R::one() / h;
                    let sum = combined(&self.method.error, &z);
                    let defect: [R; N] = entries(|k| slope[k] + recip * sum[k]);
                    let mut off = lu.solve(defect);
                    let mut margin = Margin::of_mean::<N>(step_size::squares(&off, &weights));
                    if margin.is_finite() && !margin.is_enough() && (rejected || self.last.is_none()) {
                        let moved = entries(|k| state[k] + off[k]);
                        let again = system.rhs(time, &moved);
                        self.reached.statistics.evaluations += 1;
                        off = lu.solve(entries(|k| again[k] + recip * sum[k]));
                        margin = Margin::of_mean::<N>(step_size::squares(&off, &weights));
                    }
                    let mut reached: [R; N] = entries(|k| state[k] + z[2][k]);
                    let finite = all_finite(&reached) && margin.is_finite();
                    if finite && margin.is_enough() {
                        system.restore(next, &mut reached).map_err(Cause::of_positions)?;
                        let next_slope = system.rhs(next, &reached);
                        self.reached.statistics.evaluations += 1;
                        if all_finite(&next_slope) {
                            // Many iterations are a sign that the step is long for Newton's method.
                            let effort =
                                f64::from(ITERATIONS_CHEAP) / f64::from(ITERATIONS_CHEAP + iterations);
                            let mut growth = effort * CONTROL.factor_after_success(margin.log2(), 0.0);
                            if rejected {
                                growth = growth.min(1.0);
                            }
                            let keep = rate <= FAST_RATE;
                            if keep && (1.0..=MIN_GROWTH).contains(&growth) {
                                growth = 1.0;
                            }
                            let mut next_step = size * growth;
                            if landing {
                                next_step = next_step.max(step);
                            }
                            self.jacobian = if keep { Some((jacobian, false)) } else { None };
                            self.last = Some((h, z));
                            self.ready = Some(Ready { slope: next_slope, step: next_step });
                            self.before = self.reached;
                            self.reached.statistics.accepted += 1;
                            self.reached.time = next;
                            self.reached.time_rest = R::zero();
                            self.reached.state = reached;
                            return Ok(());
                        }
                        (Cause::NotFinite, CONTROL.factor_out_of_domain())
                    } else if finite {
                        (Cause::StepUnderflow, CONTROL.factor_after_failure(margin.log2()))
                    } else if all_finite(&reached) {
                        // An error beyond the range of doubles, in units of a tiny tolerance.
                        (Cause::StepUnderflow, CONTROL.factor_out_of_domain())
                    } else {
                        (Cause::NotFinite, CONTROL.factor_out_of_domain())
                    }
                }
                (Solved::Diverged, _) => (Cause::NoConvergence, 0.5),
                _ => (Cause::NotFinite, CONTROL.factor_out_of_domain()),
            };
            self.reached.statistics.rejected += 1;
            rejected = true;
            last_trouble = trouble;
            if !present {
                // With the Jacobian of an earlier state: perhaps that one is to blame.
                self.jacobian = None;
                if matches!(trouble, Cause::NoConvergence) {
                    continue;
                }
            } else if step <= shortest {
                return Err(trouble);
            }
            step = f64::max(size * factor, shortest);
        }
    }

    fn dense(&mut self, _system: &S) -> Dense<R, N> {
        let (from, to) = (&self.before, &self.reached);
        let h = to.since(from);
        let (Some((_, z)), Some(collocation)) = (&self.last, &self.method.collocation) else {
            let zero = [R::zero(); N];
            return Dense::cubic(to.time, R::one(), [to.state, zero, zero, zero]);
        };
        // The cubic through (0, 0), (c_1, Z_1), (c_2, Z_2), (1, Z_3) by divided differences in the form of `Dense`.
        let [c1, c2, _] = collocation.c;
        let mut terms = [from.state, z[2], z[2], z[2]];
        for k in 0..N {
            let end = to.state[k] - from.state[k];
            let first = (z[0][k] / c1 - end) / (R::one() - c1);
            let second = (z[1][k] / c2 - end) / (R::one() - c2);
            terms[1][k] = end;
            terms[3][k] = (second - first) / (c2 - c1);
            terms[2][k] = first - c1 * terms[3][k];
        }
        Dense::cubic(from.time, h, terms)
    }
}

/// Iterations of Newton's method beyond which the next step is chosen shorter.
const ITERATIONS_CHEAP: u32 = 10;
