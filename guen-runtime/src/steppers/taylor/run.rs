//! The steps: how long the coefficients allow them to be, and whether the rates there are those of the series.

use super::super::{all_finite, scaled};
use super::defect::{self, Defect};
use super::{Series, Taylor};
use crate::numbers::power_series::HIGHEST_ORDER;
use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, StepperRun};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::step_size;
use crate::system::constraints::positions_error::PositionsError;
use crate::system::derivatives::series::TaylorSeries;

/// The factor by which a step becomes shorter whose rates are not those of its series, and by which the one after it
/// becomes longer at most: what the coefficients did not see is near.
const MAX_SHORTENING: f64 = 0.5;
const MAX_LENGTHENING: f64 = 2.0;

/// The orders up to which terms are summed.
#[derive(Clone, Copy, Debug)]
struct Orders {
    /// The order of a step.
    step: usize,
    /// The order at the place within a step where rates are compared.
    inside: usize,
}

impl Orders {
    fn new<R: Ordered>(method: &Taylor<R>) -> Result<Self, Cause> {
        let step = method.checked_order()?;
        let tolerance = method.tolerance();
        let loosest = f64::max(tolerance.relative, tolerance.absolute);
        Ok(Self { step, inside: defect::order_inside(step, loosest) })
    }
}

/// A run of Taylor's method.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a, R, const N: usize> {
    method: &'a Taylor<R>,
    /// Known once the settings were found to be in order.
    orders: Option<Orders>,
    /// The time at which the run began.
    origin: R,
    reached: Checkpoint<R, N>,
    /// The remainder that the state lacks, by less than half of its last digit.
    rest: [R; N],
    /// The series of the last step, and the one about the present state.
    series: [Series<R, N>; 2],
    /// The place of that of the last step.
    made: usize,
    /// Whether the other one is known already.
    ahead: bool,
    /// The scale for the next expansion, zero before the first.
    scale: f64,
    /// The longest step that is tried, whatever the coefficients allow.
    longest: f64,
}

/// The power of two next to a positive number, on a logarithmic scale; its exponent is kept where its powers up to the
/// highest order mean something to `f32`.
fn power_of_two(x: f64) -> f64 {
    exp2(libm::round(log2(x)).clamp(-1000.0, 1000.0))
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

impl<'a, R: Ordered, const N: usize> Run<'a, R, N> {
    pub(super) fn new(method: &'a Taylor<R>, start: &Checkpoint<R, N>) -> Self {
        Self {
            method,
            orders: None,
            origin: start.time,
            reached: *start,
            rest: [R::zero(); N],
            series: [Series::still(start.time, &start.state); 2],
            made: 0,
            ahead: false,
            scale: 0.0,
            longest: f64::INFINITY,
        }
    }

    /// The place of the series about the present state.
    fn here(&self) -> usize {
        (self.made & 1) ^ 1
    }

    /// The scale of the first expansion.
    fn first_scale<S>(&mut self, system: &S, span: f64) -> Result<f64, Cause>
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        let Checkpoint { time, state, .. } = self.reached;
        if !time.is_finite() || !all_finite(&state) {
            return Err(Cause::NotFinite);
        }
        let slope = system.rhs(time, &state);
        self.reached.statistics.evaluations += 1;
        if !all_finite(&slope) {
            return Err(Cause::NotFinite);
        }
        let (guess, _) = self.method.tolerance().first_guess(&state, &slope, span.abs());
        Ok(power_of_two(100.0 * guess))
    }

    /// The coefficients at a state, with a scale for which they are finite, into the series at one of both places.
    fn expand<S>(
        &mut self,
        system: &S,
        place: usize,
        order: usize,
        (time, state): (R, &[R; N]),
    ) -> Result<(), Cause>
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        /// The factor by which the scale becomes shorter where coefficients overflow.
        const RESCALING: f64 = 1.0 / (1_u64 << 20) as f64;
        /// The number of times that it becomes shorter before the run ends.
        const MAX_RESCALINGS: u32 = 6;

        let order = order.clamp(1, HIGHEST_ORDER);
        let series = &mut self.series[place & 1];
        series.start = time;
        series.order = order;
        for _ in 0..MAX_RESCALINGS {
            series.scale = R::from_f64(self.scale);
            system.series(time, state, series.scale, order, &mut series.coefficients);
            self.reached.statistics.evaluations += order as u64;
            let [.., before, last] = &series.coefficients[..=order] else { break };
            // What is not finite once is not finite in what follows from it.
            if all_finite(before) && all_finite(last) && series.coefficients[..order].iter().all(all_finite) {
                return Ok(());
            }
            if !all_finite(&series.coefficients[1]) {
                break;
            }
            self.scale *= RESCALING;
            self.reached.statistics.rejected += 1;
        }
        Err(Cause::NotFinite)
    }

    /// The length of the step that the coefficients allow; infinite where all of them vanish.
    fn length(&self, weights: &[f64; N]) -> f64 {
        /// Coefficients that are looked at, and at most half of them: in series with gaps the last ones may vanish.
        const LAST_COEFFICIENTS: usize = 8;

        let series = &self.series[self.here()];
        let order = series.order;
        let shortest = self.shortest(series, weights, order + 1 - LAST_COEFFICIENTS.min(order.div_ceil(2)));
        // Nothing there: of a polynomial every coefficient counts.
        let shortest = if shortest == f64::INFINITY { self.shortest(series, weights, 1) } else { shortest };
        if shortest == f64::INFINITY { shortest } else { exp2(shortest) * series.scale.to_f64() }
    }

    /// The binary logarithm of the length, in units of the scale, that the coefficients from one order on allow.
    fn shortest(&self, series: &Series<R, N>, weights: &[f64; N], first: usize) -> f64 {
        /// The binary logarithm of the ratio of two terms that follow each other, for the last ones, and at least this part
        /// of what it is in a geometric series that falls to the tolerance: with few terms each has to fall further.
        const LEAST_RATIO: f64 = 2.0;
        const TOLERANCE_PART: f64 = 0.7;
        /// The addition to the logarithm for earlier terms, which are not to decide unless there is a gap.
        const EARLIER_ALLOWANCE: f64 = 0.6;
        /// The number of the last ones.
        const DECIDING_TERMS: f64 = 4.0;

        let Series { order, coefficients, .. } = series;
        let tolerance = self.method.tolerance();
        let looser = f64::max(tolerance.relative, tolerance.absolute);
        let ratio = f64::max(LEAST_RATIO, -TOLERANCE_PART * log2(looser) / *order as f64);
        let mut shortest = f64::INFINITY;
        for (k, coefficients) in coefficients.iter().enumerate().take(*order + 1).skip(first) {
            let mut largest = 0.0_f64;
            for (c, weight) in coefficients.iter().zip(weights) {
                let size = c.to_f64().abs() * weight;
                largest = if size > largest { size } else { largest };
            }
            let below = *order as f64 - k as f64;
            let allowed =
                ratio * (below - 1.0) + EARLIER_ALLOWANCE * f64::max(below + 1.0 - DECIDING_TERMS, 0.0);
            shortest = f64::min(shortest, (allowed - log2(largest)) / k as f64);
        }
        shortest
    }

    /// Whether the rates within the step of length `h` are those of its series, in one place: by the terms up to the order `low`, and
    /// by all of them where these leave a doubt.
    #[inline]
    fn agrees_inside<S>(&mut self, system: &S, low: usize, h: R, weights: &[f64; N]) -> bool
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        self.reached.statistics.evaluations += 1;
        self.compare(system, low, h, weights, |defect, rates| defect.is_small(rates))
            || self.agrees_by_all_terms(system, h, weights)
    }

    #[cold]
    #[inline(never)]
    fn agrees_by_all_terms<S>(&mut self, system: &S, h: R, weights: &[f64; N]) -> bool
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        self.reached.statistics.evaluations += 1;
        self.compare(system, HIGHEST_ORDER, h, weights, |defect, rates| defect.is_none(system, rates))
    }

    /// Asks a judge about the terms up to an order, within the step of length `h`.
    #[inline(always)]
    fn compare<S>(
        &self,
        system: &S,
        order: usize,
        h: R,
        weights: &[f64; N],
        judge: impl FnOnce(&Defect<'_, R, N>, &[R; N]) -> bool,
    ) -> bool
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        let series = &self.series[self.here()];
        let length = h * R::from_f64(defect::INSIDE);
        let time = series.start + length;
        let (state, slope) = series.state_and_slope(order.min(series.order), length / series.scale);
        let rates = system.rhs(time, &state);
        judge(&Defect { series, time, state: &state, length, slope: &slope, weights }, &rates)
    }
}

/// A step on trial whose rates are those of its series.
struct Trial<R, const N: usize> {
    state: [R; N],
    rest: [R; N],
    /// Whether the series about its end is known, too.
    ahead: bool,
}

/// The reason why a step on trial is none.
enum Refused {
    NotFinite,
    Positions(PositionsError),
    /// The series is not that of the motion.
    Defect,
}

impl<R: Ordered, const N: usize> Run<'_, R, N> {
    /// The step of length `h` to the time `next`. The series about its end is expanded at once if it is `wanted`, since its first
    /// coefficients are the rates there.
    fn attempt<S>(
        &mut self,
        system: &S,
        orders: Orders,
        (next, h): (R, R),
        weights: &[f64; N],
        wanted: bool,
    ) -> Result<Trial<R, N>, Refused>
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        let here = self.here();
        let compares = self.method.compares;
        let over = h / self.series[here].scale;
        let (change, slope) = if compares {
            self.series[here].change_and_slope(over)
        } else {
            (
                R::wide(
                    #[inline(always)]
                    || self.series[here].change(over),
                ),
                [R::zero(); N],
            )
        };
        let (mut state, mut rest) = (self.reached.state, self.rest);
        for i in 0..N {
            (state[i], rest[i]) = two_sum(state[i], change[i] + rest[i]);
        }
        if !all_finite(&state) {
            return Err(Refused::NotFinite);
        }
        let sum = state;
        system.restore(next, &mut state).map_err(Refused::Positions)?;
        for i in 0..N {
            // What was put somewhere else is there.
            if state[i] != sum[i] {
                rest[i] = R::zero();
            }
        }
        if compares && !self.agrees_inside(system, orders.inside, h, weights) {
            return Err(Refused::Defect);
        }
        let ahead = wanted && self.expand(system, here ^ 1, orders.step, (next, &state)).is_ok();
        if !compares {
            return Ok(Trial { state, rest, ahead });
        }
        let series = &self.series[here];
        let defect = Defect { series, time: next, state: &state, length: h, slope: &slope, weights };
        let rates = if ahead {
            let after = &self.series[here ^ 1];
            let part = R::recip(after.scale);
            // The rates are a part of these numbers, and the length is as well.
            if (Defect { length: h * part, ..defect }).is_small(&after.coefficients[1]) {
                return Ok(Trial { state, rest, ahead });
            }
            scaled(part, &after.coefficients[1])
        } else {
            self.reached.statistics.evaluations += 1;
            system.rhs(next, &state)
        };
        if defect.is_none(system, &rates) {
            return Ok(Trial { state, rest, ahead });
        }
        // Of rates that are not finite every comparison fails.
        if !all_finite(&rates) {
            return Err(Refused::NotFinite);
        }
        if state == sum {
            return Err(Refused::Defect);
        }
        // The series leads to where the state was before it was put back.
        self.reached.statistics.evaluations += 1;
        let rates = system.rhs(next, &sum);
        if (Defect { state: &sum, ..defect }).is_none(system, &rates) {
            Ok(Trial { state, rest, ahead })
        } else {
            Err(Refused::Defect)
        }
    }
}

impl<R, S, const N: usize> StepperRun<R, S, N> for Run<'_, R, N>
where
    R: Ordered,
    S: TaylorSeries<R, N> + ?Sized,
{
    const EVALUATIONS: u32 = 20;

    type Polynomial = Series<R, N>;

    const COARSE_POLYNOMIAL: bool = false;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        &self.reached
    }

    fn advance(&mut self, system: &S, target: R, _dense: bool) -> Result<(), Cause> {
        let orders = match self.orders {
            Some(orders) => orders,
            None => *self.orders.insert(Orders::new(self.method)?),
        };
        let limit = self.method.max_steps;
        let Checkpoint { time, time_rest, state, statistics } = self.reached;
        if statistics.accepted + statistics.rejected >= limit {
            return Err(Cause::TooManySteps { limit });
        }
        let span = ((target - time) - time_rest).to_f64();
        if !self.ahead {
            if self.scale == 0.0 {
                self.scale = self.first_scale(system, span)?;
            }
            self.expand(system, self.here(), orders.step, (time, &state))?;
            self.ahead = true;
        }
        let weights = self.method.tolerance().weights(&state, &state);
        let mut step = self.length(&weights).min(self.longest);
        let mut rejected = false;
        loop {
            let landing = step_size::STRETCH * step > span.abs();
            let next = if landing { target } else { time + R::from_f64(step.copysign(span)) };
            // The distance that time really moves.
            let h = (next - time) - time_rest;
            let shortest = step.min(span.abs()) <= step_size::shortest(time, self.origin);
            if shortest && !landing && !rejected {
                return Err(Cause::StepUnderflow);
            }
            if step.is_finite() {
                self.scale = power_of_two(step);
            }
            match self.attempt(system, orders, (next, h), &weights, !landing && !rejected) {
                Ok(trial) => {
                    self.longest = MAX_LENGTHENING * if rejected { step } else { self.longest };
                    self.made = self.here();
                    self.ahead = trial.ahead;
                    self.rest = trial.rest;
                    self.reached.statistics.accepted += 1;
                    self.reached.time = next;
                    self.reached.time_rest = R::zero();
                    self.reached.state = trial.state;
                    return Ok(());
                }
                // No shorter step has other contacts.
                Err(Refused::Positions(PositionsError::Contacts)) => return Err(Cause::Contacts),
                Err(refused) if shortest => {
                    return Err(match refused {
                        Refused::NotFinite => Cause::NotFinite,
                        Refused::Positions(error) => Cause::of_positions(error),
                        Refused::Defect => Cause::StepUnderflow,
                    });
                }
                Err(_) => {}
            }
            rejected = true;
            self.reached.statistics.rejected += 1;
            let Statistics { accepted, rejected: refused, .. } = self.reached.statistics;
            if accepted + refused >= limit {
                return Err(Cause::TooManySteps { limit });
            }
            let longest = if landing { h.to_f64().abs() } else { step };
            step = f64::max(MAX_SHORTENING * longest, step_size::shortest(time, self.origin));
        }
    }

    fn dense(&mut self, _system: &S) -> Series<R, N> {
        self.series[self.made & 1]
    }
}

/// `a + b` as the sum of two numbers, the second as small as it can be.
#[inline]
fn two_sum<R: Real>(a: R, b: R) -> (R, R) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}
