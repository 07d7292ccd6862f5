//! Taylor's method: the motion's own series, of any order up to 32, with a step that adapts to its coefficients.

use super::all_finite;
use super::control::{self, Tolerance};
use super::course::{Course, Method, Reached};
use super::dense::Interpolant;
use super::landing::short_ways;
use crate::error::{Cause, Setting};
use crate::real::{Ordered, Real};
use crate::series::{Coefficients, HIGHEST_ORDER, TaylorSeries};

/// Taylor series of the motion, adaptive: for systems that say `provide taylor;`.
///
/// ```text
/// x(t + h) = sum_{k=0}^{p} x_k h^k
/// ```
///
/// with coefficients from recurrences that were emitted from the right-hand side ([`TaylorSeries`]), not from differences
/// of evaluations. The step is as long as the last coefficients allow:
///
/// ```text
/// |x_k| h^k <= (atol + rtol |x|) 4^(p-1-k),     k = p-3 .. p
/// ```
///
/// in every entry. The two highest orders are what Jorba and Zou ask of. Four more before these, with 6 in place of 4 beyond the
/// fourth, are there for series with gaps, and all where the last eight vanish.
///
/// - The order is 2 to 32. By default it is the larger of `1 + d ln(10) / 2` and `12 + 0.65 d` for a tolerance of `10^-d`,
///   the larger of the two, rounded. The first is Jorba and Zou's, where the work over a given time is least if that of a
///   step grows as `p^2`; the second was measured on the hoop, where it grows more slowly. Higher orders make longer steps.
/// - No step is tried in vain: the length is known before it is made. Trials that [`Statistics`](super::Statistics) calls
///   rejected are expansions whose coefficients overflowed, which are repeated with another scale.
/// - Dense output is the series itself, at no price but its evaluation.
/// - The state is carried as a sum of two numbers, so that what a step adds is not rounded to the state's last digit: over
///   many steps the errors of rounding that are left are those of the increments.
/// - A right-hand side has to be analytic along the motion: `abs` and `sign` are refused when the system is declared.
/// - Tolerances and steps are `f64` for every real; with duals the values alone decide the steps.
/// - Cost of a step: `p` coefficients, each like an evaluation of the right-hand side without its elementary functions, and
///   `p^2` products for each of [`TaylorSeries::PRODUCTS`]. The workspace is on the stack, some 450 bytes for each of these.
/// - Sources: A. Jorba and M. Zou, *A software package for the numerical integration of ODEs by means of high-order Taylor
///   methods*, Experimental Mathematics 14 (2005) 99-117, for order and step; R. E. Moore, *Interval Analysis*, 1966, for
///   the recurrences; O. Moller, *Quasi double-precision in floating point addition*, BIT 5 (1965) 37-50, for the sum.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::steppers::Taylor;
/// use guen_runtime::{Coefficients, System, TaylorSeries};
///
/// // x' = v, v' = -x. A declared system writes this by itself.
/// struct Oscillator;
/// impl System<f64, 2> for Oscillator {
///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
///         [v, -x]
///     }
/// }
/// impl TaylorSeries<f64, 2> for Oscillator {
///     const PRODUCTS: usize = 0;
///     fn series(&self, _t: f64, state: &[f64; 2], scale: f64, order: usize, to: &mut Coefficients<f64, 2>) {
///         to[0] = *state;
///         for k in 1..=order {
///             let [x, v] = to[k - 1];
///             to[k] = [v, -x].map(|rate| rate * scale / k as f64);
///         }
///     }
/// }
///
/// let done = Taylor::new(1e-15)
///     .integrate(&Oscillator, 0.0, &[0.0, 1.0], 1000.0, |_t, _x| ControlFlow::Continue(()))
///     .unwrap();
/// assert!((done.state[0] - 1000.0_f64.sin()).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taylor<R = f64> {
    /// The tolerance relative to each entry of the state: nonnegative.
    pub rtol: f64,
    /// The absolute tolerance, the same for every entry of the state: positive.
    pub atol: f64,
    /// The order, 2 to 32; chosen from the tolerances if absent.
    pub order: Option<u32>,
    /// The largest number of steps of one run.
    pub max_steps: u64,
    real: core::marker::PhantomData<R>,
}

impl<R: Ordered> Taylor<R> {
    /// The number of steps allowed unless another one is set.
    pub const MAX_STEPS: u64 = 100_000;

    /// The method with this tolerance, relative and absolute.
    pub fn new(tolerance: f64) -> Self {
        Self {
            rtol: tolerance,
            atol: tolerance,
            order: None,
            max_steps: Self::MAX_STEPS,
            real: core::marker::PhantomData,
        }
    }

    /// The same with another absolute tolerance.
    pub fn absolute(self, atol: f64) -> Self {
        Self { atol, ..self }
    }

    /// The same with a given order, 2 to 32.
    pub fn order(self, order: u32) -> Self {
        Self { order: Some(order), ..self }
    }

    /// The same with another limit on the number of steps.
    pub fn with_max_steps(self, max_steps: u64) -> Self {
        Self { max_steps, ..self }
    }

    /// The order of the series, once the settings are found to be in order.
    fn checked_order(&self) -> Result<usize, Cause> {
        self.tolerance().check()?;
        match self.order {
            Some(order @ 2..=32) => Ok(order as usize),
            Some(_) => Err(Cause::Setting(Setting::Order)),
            None => {
                let digits = -libm::log10(self.rtol.max(self.atol));
                let order = f64::max(12.0 + 0.65 * digits, 1.0 + 0.5 * core::f64::consts::LN_10 * digits);
                Ok((libm::round(order) as usize).clamp(LOWEST_DEFAULT, HIGHEST_ORDER))
            }
        }
    }

    fn tolerance(&self) -> Tolerance {
        Tolerance { relative: self.rtol, absolute: self.atol }
    }
}

/// The motion over one step of [`Taylor`]: its series about the beginning, an [`Interpolant`].
#[derive(Clone, Copy, Debug)]
pub struct Series<R, const N: usize> {
    start: R,
    scale: R,
    order: usize,
    coefficients: Coefficients<R, N>,
}

impl<R: Real, const N: usize> Series<R, N> {
    /// `sum_{k>=1} x_k s^k`, by Horner's rule.
    #[inline]
    fn change(&self, s: R) -> [R; N] {
        // Within the bounds it is; said again, the compiler knows it too and leaves no panic.
        let order = self.order.clamp(1, HIGHEST_ORDER);
        let mut sum = self.coefficients[order];
        for below in self.coefficients[1..order].iter().rev() {
            for (entry, coefficient) in sum.iter_mut().zip(below) {
                *entry = *entry * s + *coefficient;
            }
        }
        sum.map(|entry| entry * s)
    }
}

impl<R: Real, const N: usize> Interpolant<R, N> for Series<R, N> {
    fn at(&self, t: R) -> [R; N] {
        let change = self.change((t - self.start) / self.scale);
        core::array::from_fn(|i| self.coefficients[0][i] + change[i])
    }
}

/// The least order that a tolerance leads to.
const LOWEST_DEFAULT: usize = 8;

/// A run of Taylor's method.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a, R, const N: usize> {
    method: &'a Taylor<R>,
    /// When the run began.
    origin: R,
    reached: Reached<R, N>,
    /// What the state is short of, by less than half of its last digit.
    rest: [R; N],
    /// The series of the last step.
    series: Series<R, N>,
    /// The scale for the next expansion, zero before the first.
    scale: f64,
}

/// The power of two next to a positive number, on a logarithmic scale; its exponent is kept where its powers up to the
/// highest order mean something to `f32`.
fn power_of_two(x: f64) -> f64 {
    libm::exp2(libm::round(log2(x)).clamp(-1000.0, 1000.0))
}

/// The binary logarithm of a positive number, off by less than a tenth: the exponent, and the mantissa as if it were
/// linear. Zero gives minus infinity.
#[inline]
fn log2(x: f64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    const MANTISSA: f64 = (1_u64 << 52) as f64;
    if x == 0.0 {
        return f64::NEG_INFINITY;
    }
    (x.to_bits() as i64 - ONE as i64) as f64 / MANTISSA
}

/// The inverse of [`log2`], between the smallest and the largest number.
#[inline]
fn exp2(x: f64) -> f64 {
    const ONE: f64 = 1.0_f64.to_bits() as f64;
    const MANTISSA: f64 = (1_u64 << 52) as f64;
    f64::from_bits((x.clamp(-1022.0, 1023.0) * MANTISSA + ONE) as u64)
}

impl<R: Ordered, const N: usize> Run<'_, R, N> {
    /// The coefficients at the present state, with a scale for which they are finite.
    fn expand<S>(&mut self, system: &S, order: usize, span: f64) -> Result<(), Cause>
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        /// How much shorter the scale becomes where coefficients overflow.
        const SHORTER: f64 = 1.0 / (1_u64 << 20) as f64;
        /// And how often.
        const ATTEMPTS: u32 = 6;

        let order = order.clamp(1, HIGHEST_ORDER);
        let Reached { time, state, .. } = self.reached;
        if self.scale == 0.0 {
            if !time.is_finite() || !all_finite(&state) {
                return Err(Cause::NotFinite);
            }
            let slope = system.rhs(time, &state);
            self.reached.statistics.evaluations += 1;
            if !all_finite(&slope) {
                return Err(Cause::NotFinite);
            }
            let (guess, _) = self.method.tolerance().first_guess(&state, &slope, span.abs());
            self.scale = power_of_two(100.0 * guess);
        }
        self.series.start = time;
        self.series.order = order;
        for _ in 0..ATTEMPTS {
            self.series.scale = R::from_f64(self.scale);
            system.series(time, &state, self.series.scale, order, &mut self.series.coefficients);
            self.reached.statistics.evaluations += order as u64;
            let [.., before, last] = &self.series.coefficients[..=order] else { break };
            // What is not finite once is not finite in what follows from it.
            if all_finite(before)
                && all_finite(last)
                && self.series.coefficients[..order].iter().all(all_finite)
            {
                return Ok(());
            }
            if !all_finite(&self.series.coefficients[1]) {
                break;
            }
            self.scale *= SHORTER;
            self.reached.statistics.rejected += 1;
        }
        Err(Cause::NotFinite)
    }

    /// The length of the step that the coefficients allow; infinite where all of them vanish.
    fn length(&self) -> f64 {
        /// Coefficients that are looked at, and at most half of them: in series with gaps the last ones may vanish.
        const LAST: usize = 8;

        let order = self.series.order;
        let shortest = self.shortest(order + 1 - LAST.min(order.div_ceil(2)));
        // Nothing there: of a polynomial every coefficient counts.
        let shortest = if shortest == f64::INFINITY { self.shortest(1) } else { shortest };
        if shortest == f64::INFINITY { shortest } else { exp2(shortest) * self.scale }
    }

    /// The binary logarithm of the length, in units of the scale, that the coefficients from one order on allow.
    fn shortest(&self, first: usize) -> f64 {
        /// The binary logarithm of the ratio of two terms that follow each other, for the last ones, and at least this part
        /// of what it is in a geometric series that falls to the tolerance: with few terms each has to fall further.
        const RATIO: f64 = 2.0;
        const PART: f64 = 0.7;
        /// What it is more for those before, which are not to decide unless there is a gap.
        const FURTHER: f64 = 0.6;
        /// How many are the last ones.
        const DECIDING: f64 = 4.0;

        let Series { order, coefficients, .. } = &self.series;
        let tolerance = self.method.tolerance();
        let weights = tolerance.weights(&coefficients[0], &coefficients[0]);
        let tightest = f64::max(tolerance.relative, tolerance.absolute);
        let ratio = f64::max(RATIO, -PART * log2(tightest) / *order as f64);
        let mut shortest = f64::INFINITY;
        for (k, coefficients) in coefficients.iter().enumerate().take(*order + 1).skip(first) {
            let mut largest = 0.0_f64;
            for (c, weight) in coefficients.iter().zip(&weights) {
                let size = c.to_f64().abs() * weight;
                largest = if size > largest { size } else { largest };
            }
            let below = *order as f64 - k as f64;
            let allowed = ratio * (below - 1.0) + FURTHER * f64::max(below + 1.0 - DECIDING, 0.0);
            shortest = f64::min(shortest, (allowed - log2(largest)) / k as f64);
        }
        shortest
    }
}

impl<R, S, const N: usize> Course<R, S, N> for Run<'_, R, N>
where
    R: Ordered,
    S: TaylorSeries<R, N> + ?Sized,
{
    const EVALUATIONS: u32 = 20;

    type Polynomial = Series<R, N>;

    fn reached(&self) -> &Reached<R, N> {
        &self.reached
    }

    fn advance(&mut self, system: &S, target: R, _dense: bool) -> Result<(), Cause> {
        let order = self.method.checked_order()?;
        let Reached { time, time_rest, state, statistics } = self.reached;
        if statistics.accepted + statistics.rejected >= self.method.max_steps {
            return Err(Cause::TooManySteps { limit: self.method.max_steps });
        }
        let span = ((target - time) - time_rest).to_f64();
        self.expand(system, order, span)?;
        let step = self.length();
        let landing = control::STRETCH * step > span.abs();
        if !landing && step <= control::shortest(time, self.origin) {
            return Err(Cause::StepUnderflow);
        }
        let next = if landing { target } else { time + R::from_f64(step.copysign(span)) };
        // The distance that time really moves.
        let h = (next - time) - time_rest;
        let change = self.series.change(h / self.series.scale);
        let mut accepted = state;
        let mut left = self.rest;
        for i in 0..N {
            (accepted[i], left[i]) = two_sum(state[i], change[i] + left[i]);
        }
        if !all_finite(&accepted) {
            return Err(Cause::NotFinite);
        }
        let sum = accepted;
        system.restore(next, &mut accepted).map_err(|_| Cause::Positions)?;
        for i in 0..N {
            // What was put somewhere else is there.
            if accepted[i] != sum[i] {
                left[i] = R::zero();
            }
        }
        self.rest = left;
        if step.is_finite() {
            self.scale = power_of_two(step);
        }
        self.reached.statistics.accepted += 1;
        self.reached.time = next;
        self.reached.time_rest = R::zero();
        self.reached.state = accepted;
        Ok(())
    }

    fn dense(&mut self, _system: &S) -> Series<R, N> {
        self.series
    }
}

/// `a + b` as the sum of two numbers, the second as small as it can be.
#[inline]
fn two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

impl<R: Ordered, S: TaylorSeries<R, N> + ?Sized, const N: usize> Method<R, S, N> for Taylor<R> {
    type Course<'a> = Run<'a, R, N>;

    fn start(&self, start: &Reached<R, N>) -> Self::Course<'_> {
        let zero = [R::zero(); N];
        // Before the first step there is nothing to interpolate but the present state.
        let mut coefficients = [zero; HIGHEST_ORDER + 1];
        coefficients[0] = start.state;
        let series = Series { start: start.time, scale: R::one(), order: 1, coefficients };
        Run { method: self, origin: start.time, reached: *start, rest: zero, series, scale: 0.0 }
    }
}

short_ways!(Taylor over Ordered, systems crate::series::TaylorSeries);
