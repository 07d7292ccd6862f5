//! Taylor's method: the motion's own series, of any order up to 32, with a step that adapts to its coefficients.

mod defect;
mod run;
mod series;

use crate::numbers::power_series::HIGHEST_ORDER;
use crate::numbers::real::Ordered;
use crate::steppers::driver::error::{Cause, Setting};
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::short_ways::short_ways;
use crate::steppers::step_size::Tolerance;
use crate::system::derivatives::series::TaylorSeries;
use run::Run;
pub use series::Series;

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
/// - The rates of the system are compared with those of the series, `p' = f(t, p)`, at the end of each step and at 0.45 of it. A
///   force that is constant to rounding where the series was expanded, as `tanh` far from its zero, leaves no trace in the
///   coefficients; where it is another one further on, the step is halved until the rates agree, and the next ones
///   grow by at most two. A change that leaves no trace in either place is not seen: `docs/design/narrow-features.md` has how narrow that is.
/// - Trials that [`Statistics`](crate::steppers::Statistics) calls rejected are those steps, and expansions whose coefficients overflowed,
///   which are repeated with another scale. In a smooth motion there are none: the length is known before a step is made.
/// - Of two steps one after the other the rates at the end of the first are the first coefficients of the second, so
///   that the comparison costs one evaluation for each step, and two for the last: 1.2 percent of the instructions for a chain of
///   twenty links, 4 for the hoop, 6 for the sled (`workshop/benches/guard_instructions.py`).
/// - Dense output is the series itself, at no price but its evaluation.
/// - The state is carried as a sum of two numbers, so that what a step adds is not rounded to the state's last digit: over
///   many steps the errors of rounding that are left are those of the increments.
/// - A right-hand side has to be analytic along the motion: `abs` and `sign` are refused when the system is declared.
/// - Tolerances and steps are `f64` for every real; with duals the values alone decide the steps.
/// - Cost of a step: `p` coefficients, each like an evaluation of the right-hand side without its elementary functions, and
///   `p^2` products for each of [`TaylorSeries::PRODUCTS`]. The workspace is on the stack, some 500 bytes for each of these.
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
/// let done = Taylor::new(1e-15, 1e-15)
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
    /// Whether the rates of the system are compared with those of the series.
    compares: bool,
    real: core::marker::PhantomData<R>,
}

impl<R: Ordered> Taylor<R> {
    /// The number of steps allowed unless another one is set.
    pub const MAX_STEPS: u64 = 100_000;

    /// The method with the given relative and absolute tolerances.
    pub fn new(rtol: f64, atol: f64) -> Self {
        Self {
            rtol,
            atol,
            order: None,
            max_steps: Self::MAX_STEPS,
            compares: true,
            real: core::marker::PhantomData,
        }
    }

    /// Sets the order, 2 to 32.
    pub fn with_order(self, order: u32) -> Self {
        Self { order: Some(order), ..self }
    }

    /// Limits the number of steps.
    pub fn with_max_steps(self, max_steps: u64) -> Self {
        Self { max_steps, ..self }
    }

    /// Leaves out the comparison of rates, to measure what it costs (`workshop/benches/guard_instructions.py`). A
    /// feature that the coefficients do not show is then missed without an error.
    #[doc(hidden)]
    pub fn without_comparison(self) -> Self {
        Self { compares: false, ..self }
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

/// The least order that a tolerance leads to.
const LOWEST_DEFAULT: usize = 8;

/// The loosest tolerances for which the order is at least 9, 10 and so on: for texts in other
/// languages, whose logarithms have other last digits.
pub(crate) fn order_tolerances() -> [f64; HIGHEST_ORDER - LOWEST_DEFAULT] {
    core::array::from_fn(|place| {
        let reaches = |tolerance: f64| {
            Taylor::<f64>::new(tolerance, tolerance)
                .checked_order()
                .is_ok_and(|order| order > LOWEST_DEFAULT + place)
        };
        // Doubles are in the order of their bits.
        let (mut tight, mut loose) = (f64::MIN_POSITIVE.to_bits(), f64::MAX.to_bits());
        while loose - tight > 1 {
            let middle = tight.midpoint(loose);
            if reaches(f64::from_bits(middle)) { tight = middle } else { loose = middle }
        }
        f64::from_bits(tight)
    })
}

/// The binary logarithm of the place within a step at which rates are compared.
pub(crate) fn inside_logarithm() -> f64 {
    libm::log2(defect::INSIDE)
}

impl<R: Ordered, S: TaylorSeries<R, N> + ?Sized, const N: usize> Method<R, S, N> for Taylor<R> {
    type Run<'a> = Run<'a, R, N>;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Run::new(self, start)
    }
}

short_ways!(Taylor over Ordered, systems crate::system::derivatives::series::TaylorSeries);
