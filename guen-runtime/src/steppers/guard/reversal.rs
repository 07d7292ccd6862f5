//! Whether a run can be undone: the variational matrix along it, and how rounding errors grow on the way back.

use core::ops::ControlFlow;

use crate::linear_algebra::lu::Lu;
use crate::numbers::dual::Dual;
use crate::numbers::lift::Lift;
use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::error::{Cause, IntegrationError, Setting};
use crate::steppers::driver::integration::Integration;
use crate::steppers::driver::run::{IntegrationResult, Method};
use crate::steppers::guard::Guard;
use crate::system::System;
use crate::system::derivatives::linearization::{Liftable, seeded};

/// The number of steps from one check of the way back to the next: each inverts a matrix of the size of the state.
const CHECK_INTERVAL: u32 = 8;

/// A run with its variational matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reversible<R, const N: usize> {
    /// The end of the run.
    pub done: IntegrationResult<R, N>,
    /// `matrix[i][j]`: the derivative of entry `i` of the end by entry `j` of the start.
    pub matrix: [[R; N]; N],
    /// The factor by which relative rounding errors grow on the way back: `|Phi|`, the largest over the run.
    ///
    /// ```text
    /// |Phi| = max_i sum_j |Phi_ij| x_j / max_i |x_i(t0)|
    /// ```
    ///
    /// with the inverse `Phi` of the matrix and the largest value `x_j` that entry `j` had. Going there and back
    /// returns to the start within some tens of `u |Phi|` of its largest entry, `u` the unit roundoff, if the method
    /// errs by no more than roundings.
    pub growth: f64,
}

/// A system over duals whose directions are the entries of the state, its inputs held: what [`reversible`] gives to its
/// method.
#[derive(Clone, Copy, Debug)]
pub struct Varied<'a, S, R, const M: usize> {
    system: &'a S,
    inputs: &'a [R; M],
}

impl<S, R, const N: usize, const M: usize> System<Dual<R, N>, N> for Varied<'_, S, R, M>
where
    R: Real,
    S: Liftable<R, N, M>,
    Dual<R, N>: Lift<R>,
{
    #[inline]
    fn rhs(&self, t: Dual<R, N>, state: &[Dual<R, N>; N]) -> [Dual<R, N>; N] {
        self.system.lifted_rates(t, state, &self.inputs.map(Dual::constant))
    }
}

/// Runs from `x0` at `t0` to `t1` with the variational matrix beside the state, and refuses to go where the way back does
/// not lead to the start: where a rounding at the end would be more than `limit` of the start.
///
/// The method works on duals, and takes the steps that it takes without them; a step costs about `N + 1` times as much.
/// `inputs` are held; a system without any has `&[]`. Nothing is allocated.
///
/// ```
/// use guen_runtime::steppers::{Dop853, reversible};
/// use guen_runtime::{Cause, Lift, Liftable, Real};
///
/// /// `x' = -x`: forwards everything comes to zero, backwards everything flies apart.
/// struct Decay;
/// impl Liftable<f64, 1, 0> for Decay {
///     fn lifted_rates<S: Real + Lift<f64>>(&self, _t: S, [x]: &[S; 1], _: &[S; 0]) -> [S; 1] {
///         [-*x]
///     }
/// }
///
/// let method = Dop853::new(1e-12, 1e-12);
/// let run = reversible(&Decay, &[], &method, 0.0, &[1.0], 3.0, 1e-8).unwrap();
/// assert!((run.growth / 3.0_f64.exp() - 1.0).abs() < 1e-9);
/// // e^20 roundings are more than 1e-8 of the start.
/// let error = reversible(&Decay, &[], &method, 0.0, &[1.0], 20.0, 1e-8).unwrap_err();
/// assert!(matches!(error.cause, Cause::Irreversible { .. }), "{error}");
/// // It checks every eight steps, and tells the last check that found it in order.
/// assert!(error.time > 10.0 && error.time < 18.4, "{}", error.time);
/// ```
///
/// # Errors
///
/// [`Cause::Contacts`] for a system with contacts or resets; [`Cause::Irreversible`] with the last time and state from which the start can be found again; everything that stops
/// the method. Guards watch that all is finite, and nothing else.
pub fn reversible<Q, S, R, const N: usize, const M: usize>(
    system: &S,
    inputs: &[R; M],
    method: &Q,
    t0: R,
    x0: &[R; N],
    t1: R,
    limit: f64,
) -> Result<Reversible<R, N>, IntegrationError<R, N>>
where
    R: Ordered,
    S: Liftable<R, N, M>,
    Dual<R, N>: Lift<R>,
    Q: for<'a> Method<Dual<R, N>, Varied<'a, S, R, M>, N>,
{
    let varied = Varied { system, inputs };
    let mut back = Back::new(x0);
    let mut good = (t0, *x0);
    let mut fault = None;
    let mut until_check = CHECK_INTERVAL;
    let unit = R::epsilon().to_f64() / 2.0;
    let mut check = |time: Dual<R, N>, state: &[Dual<R, N>; N]| {
        back.see(state);
        until_check -= 1;
        if until_check > 0 && time.value != t1 {
            return ControlFlow::Continue(());
        }
        until_check = CHECK_INTERVAL;
        let growth = back.growth(state);
        // What is no number exceeds every limit.
        if (unit * growth).partial_cmp(&limit).is_none_or(core::cmp::Ordering::is_gt) {
            fault = Some(Cause::Irreversible { found: time.to_f64(), growth, limit });
            return ControlFlow::Break(());
        }
        good = (time.value, state.map(|x| x.value));
        ControlFlow::Continue(())
    };
    let refused = if S::THROUGH_MODES {
        Some(Cause::Contacts)
    } else if limit.is_nan() || limit < 0.0 {
        Some(Cause::Setting(Setting::Guard))
    } else {
        None
    };
    let run = match refused {
        None => Integration::new(&varied, Dual::constant(t0), &seeded(x0))
            .guard(Guard::FINITE)
            .observe(&mut check)
            .run(method, Dual::constant(t1)),
        Some(cause) => Err(IntegrationError {
            time: Dual::constant(t0),
            state: seeded(x0),
            cause,
            statistics: Default::default(),
        }),
    };
    let done = run.map_err(|error| IntegrationError {
        time: error.time.value,
        state: error.state.map(|x| x.value),
        cause: error.cause,
        statistics: error.statistics,
    })?;
    if let Some(cause) = fault {
        return Err(IntegrationError { time: good.0, state: good.1, cause, statistics: done.statistics });
    }
    let state = done.state.map(|x| x.value);
    Ok(Reversible {
        done: IntegrationResult {
            time: done.time.value,
            state,
            outcome: done.outcome,
            statistics: done.statistics,
        },
        matrix: done.state.map(|x| x.tangent),
        growth: back.worst,
    })
}

/// The way back, as far as it is known.
struct Back<const N: usize> {
    /// The largest entry of the start.
    start: f64,
    /// The largest value of each entry.
    largest: [f64; N],
    worst: f64,
}

impl<const N: usize> Back<N> {
    fn new<R: Real>(x0: &[R; N]) -> Self {
        let largest = x0.map(|x| x.to_f64().abs());
        let start = largest.iter().fold(0.0_f64, |most, x| most.max(*x));
        Self { start, largest, worst: 1.0 }
    }

    fn see<R: Real>(&mut self, state: &[Dual<R, N>; N]) {
        for (largest, x) in self.largest.iter_mut().zip(state) {
            *largest = largest.max(x.value.to_f64().abs());
        }
    }

    /// `max_i sum_j |Phi_ij| x_j`, relative to the start, the largest so far; infinite where the matrix is singular.
    fn growth<R: Real>(&mut self, state: &[Dual<R, N>; N]) -> f64 {
        let Some(factors) = Lu::new(state.map(|x| x.tangent)) else {
            self.worst = f64::INFINITY;
            return self.worst;
        };
        let mut rows = [0.0_f64; N];
        for j in 0..N {
            let mut unit = [R::zero(); N];
            unit[j] = R::one();
            for (row, entry) in rows.iter_mut().zip(factors.solve(unit)) {
                *row += entry.to_f64().abs() * self.largest[j];
            }
        }
        let most =
            rows.into_iter().fold(0.0, |most, row| if row > most || row.is_nan() { row } else { most });
        let growth = if self.start > 0.0 { most / self.start } else { most };
        self.worst = if growth.is_nan() { f64::INFINITY } else { self.worst.max(growth) };
        self.worst
    }
}
