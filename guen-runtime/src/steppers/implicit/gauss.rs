//! The methods of Gauss and Legendre with two and three stages, with a fixed step.

use crate::linear_algebra::lu::{Complex, Lu};
use crate::numbers::decimal::{Parts, decimal};
use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::explicit::fixed::{Fixed, Formula, LastStep, NextStep, Slopes, fixed_step};
use crate::steppers::guard::defect::quadrature;
use crate::steppers::implicit::collocation::{Collocation, Factors, shifted};
use crate::steppers::{entries, step_size};
use crate::system::derivatives::differentiable::Differentiable;

macro_rules! gauss {
    ($(#[$docs:meta])* $Gauss:ident, $stages:literal stages, order $order:literal) => {
        $(#[$docs])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $Gauss<R = f64> {
            /// The step, in units of time: positive and finite.
            pub step: R,
            /// Absent in a real that is too short for the coefficients: no step can be made then.
            pub(in crate::steppers) collocation: Option<Collocation<R, $stages>>,
        }

        impl<R: Ordered, S: Differentiable<R, N> + ?Sized, const N: usize> Formula<R, S, N> for $Gauss<R> {
            type Memory = Memory<R, N, $stages>;
            const EVALUATIONS: u32 = 4 * $stages;

            fn step_size(&self) -> R {
                self.step
            }

            fn memory(&self) -> Self::Memory {
                Memory::new()
            }

            fn step(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> Result<[R; N], Cause> {
                let collocation = self.collocation.as_ref().ok_or(Cause::NoConvergence)?;
                let from = next.from;
                let change = solve(collocation, next)?;
                Ok(entries(|i| from.state[i] + change[i]))
            }

            fn dense(&self, last: LastStep<'_, R, S, &mut Self::Memory, N>, h: R, statistics: &mut Statistics) -> Dense<R, N> {
                let LastStep { system, memory: Memory { slopes, .. }, from, to } = last;
                slopes.begin(system, from, statistics);
                let cubic = slopes.hermite(system, (from, to), h, statistics);
                if $order == 4 {
                    return cubic;
                }
                let end = slopes.end(system, to, statistics);
                statistics.evaluations += 2;
                cubic.with_curvatures(
                    &system.along(from.time, &from.state, R::one(), &slopes.first),
                    &system.along(to.time, &to.state, R::one(), &end),
                )
            }

            fn defect(&self, last: LastStep<'_, R, S, &Self::Memory, N>) -> [R; N] {
                match &self.collocation {
                    Some(collocation) => {
                        defect(collocation, $order, last).map(R::from_f64)
                    }
                    None => [R::from_f64(f64::NAN); N],
                }
            }
        }

        fixed_step!($Gauss over Ordered, systems Differentiable, memory Memory<R, N, $stages>);
    };
}

gauss! {
    /// The method of Gauss and Legendre with two stages and a fixed step.
    ///
    /// ```text
    /// c = 1/2 -+ sqrt(3)/6      a = [[1/4, 1/4 - sqrt(3)/6], [1/4 + sqrt(3)/6, 1/4]]      b = [1/2, 1/2]
    /// ```
    ///
    /// - Order 4, implicit, A-stable; symmetric, so a run backwards retraces its steps up to rounding and the tolerance
    ///   of the iteration; keeps invariants that are quadratic in the state, such as `w^2 + x^2 + y^2 + z^2` of a
    ///   quaternion. Symplectic where the equations are canonical, which those in quasi-velocities are not in general.
    /// - The equations of a step are solved by Newton's method, as far as rounding allows, with a Jacobian that is kept
    ///   while the iteration converges fast. [`Cause::NoConvergence`](crate::Cause::NoConvergence) where it does not.
    /// - Not for rates of damping far beyond the step's inverse if transients matter: they are not damped but
    ///   alternate. [`Radau5`](crate::steppers::Radau5) damps them.
    /// - Cost of a step: two evaluations for each iteration, usually four to ten of these, and `N^3` operations for each
    ///   factorisation. Dense output is cubic, `O(h^4)`; two evaluations.
    /// - Source: J. C. Butcher, *Implicit Runge-Kutta processes*, Mathematics of Computation 18 (1964) 50-64.
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use guen_runtime::{Equations, Real, generic, steppers::Gauss4};
    ///
    /// struct Oscillator;
    /// impl Equations<2> for Oscillator {
    ///     fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
    ///         [v, -x]
    ///     }
    /// }
    ///
    /// let done = Gauss4::new(0.1)
    ///     .integrate(&generic(Oscillator), 0.0, &[0.0, 1.0], 100.0, |_t, _x| ControlFlow::Continue(()))
    ///     .unwrap();
    /// let [x, v] = done.state;
    /// assert!((x * x + v * v - 1.0).abs() < 1e-13);
    /// assert!((x - 100.0_f64.sin()).abs() < 1e-4);
    /// ```
    Gauss4, 2 stages, order 4
}

gauss! {
    /// The method of Gauss and Legendre with three stages and a fixed step.
    ///
    /// ```text
    /// c = 1/2 - sqrt(15)/10, 1/2, 1/2 + sqrt(15)/10      b = [5/18, 4/9, 5/18]
    /// ```
    ///
    /// - Order 6; all else as of [`Gauss4`]. Dense output is the quintic through values, first and second derivatives at
    ///   both ends, `O(h^6)`; four evaluations.
    /// - Source: that of [`Gauss4`].
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use guen_runtime::{Equations, Real, generic, steppers::Gauss6};
    ///
    /// struct Oscillator;
    /// impl Equations<2> for Oscillator {
    ///     fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
    ///         [v, -x]
    ///     }
    /// }
    ///
    /// let done = Gauss6::new(0.1)
    ///     .integrate(&generic(Oscillator), 0.0, &[0.0, 1.0], 100.0, |_t, _x| ControlFlow::Continue(()))
    ///     .unwrap();
    /// assert!((done.state[0] - 100.0_f64.sin()).abs() < 1e-7);
    /// ```
    Gauss6, 3 stages, order 6
}

/// The eigenvalues of `A^-1` for three stages: `1/lambda` are the roots of the Padé denominator
/// `1 - z/2 + z^2/10 - z^3/120`.
const REAL: Parts = decimal("4.644370709252171185822941421408064");
const RE: Parts = decimal("3.677814645373914407088529289295968");
const IM: Parts = decimal("3.508761919567443321903661209182446");

impl<R: Ordered> Gauss4<R> {
    /// The method with this step.
    pub fn new(step: R) -> Self {
        let ratio = R::from_ratio;
        let (half, quarter, root) = (ratio(1, 2), ratio(1, 4), ratio(3, 1).sqrt());
        let sixth = root * ratio(1, 6);
        // 3 +- i sqrt(3): the roots of z^2 - 6 z + 12.
        let pair = Complex { re: ratio(3, 1), im: root };
        let a = [[quarter, quarter - sixth], [quarter + sixth, quarter]];
        let collocation = Collocation::new([half - sixth, half + sixth], a, [half, half], None, pair);
        Self { step, collocation }
    }
}

impl<R: Ordered> Gauss6<R> {
    /// The method with this step.
    pub fn new(step: R) -> Self {
        let ratio = R::from_ratio;
        let root = ratio(15, 1).sqrt();
        let (half, tenth) = (ratio(1, 2), root * ratio(1, 10));
        let (outer, middle) = (ratio(5, 36), ratio(2, 9));
        let a = [
            [outer, middle - root * ratio(1, 15), outer - root * ratio(1, 30)],
            [outer + root * ratio(1, 24), middle, outer - root * ratio(1, 24)],
            [outer + root * ratio(1, 30), middle + root * ratio(1, 15), outer],
        ];
        let b = [ratio(5, 18), ratio(4, 9), ratio(5, 18)];
        let pair = Complex { re: R::from_parts(&RE), im: R::from_parts(&IM) };
        let real = Some(R::from_parts(&REAL));
        Self { step, collocation: Collocation::new([half - tenth, half, half + tenth], a, b, real, pair) }
    }
}

/// The memory of one step for the next.
#[derive(Clone, Copy, Debug)]
pub struct Memory<R, const N: usize, const S: usize> {
    slopes: Slopes<R, N>,
    /// The step with its stages, for a prediction.
    last: Option<(R, [[R; N]; S])>,
    jacobian: Option<[[R; N]; N]>,
    factors: Option<(R, Factors<R, N>)>,
}

impl<R: Real, const N: usize, const S: usize> Memory<R, N, S> {
    fn new() -> Self {
        Self { slopes: Slopes::new(), last: None, jacobian: None, factors: None }
    }
}

/// Solves the equations of a step to rounding: the change of the state.
fn solve<R, S, const N: usize, const M: usize>(
    collocation: &Collocation<R, M>,
    next: NextStep<'_, R, S, Memory<R, N, M>, N>,
) -> Result<[R; N], Cause>
where
    R: Ordered,
    S: Differentiable<R, N> + ?Sized,
{
    /// The number of iterations from which on a new Jacobian costs less than to go on with the old one.
    const SLOW_ITERATIONS: u32 = 7;
    /// The relative difference below which two steps share their factors: each iteration leaves so much of the error.
    const SAME_STEP: f64 = 1e-3;

    let NextStep { system, memory, from, h, statistics, .. } = next;
    // A slope that dense output left belongs to the end of a step that is over.
    memory.slopes = Slopes::new();
    let start = memory.last.map(|(before, z)| collocation.predicted(&z, h / before));
    let mut fresh = false;
    loop {
        if memory.jacobian.is_none() {
            memory.jacobian = Some(system.jacobian(from.time, &from.state));
            memory.factors = None;
            statistics.jacobians += 1;
            fresh = true;
        }
        let factors = match (memory.factors, &memory.jacobian) {
            (Some((at, factors)), _) if step_size::nearly_the_same(at, h, SAME_STEP) => factors,
            (_, Some(jacobian)) => {
                let factors = collocation.factor(jacobian, h).ok_or(Cause::NoConvergence)?;
                memory.factors = Some((h, factors));
                factors
            }
            (_, None) => return Err(Cause::NoConvergence),
        };
        let found = iterate(collocation, system, &factors, from, h, start, statistics)
            .or_else(|| iterate(collocation, system, &factors, from, h, None, statistics));
        match found {
            Some((z, iterations)) => {
                memory.last = Some((h, z));
                if iterations > SLOW_ITERATIONS {
                    memory.jacobian = None;
                }
                return Ok(collocation.change(&z));
            }
            None if fresh => {
                memory.jacobian = None;
                memory.last = None;
                return Err(Cause::NoConvergence);
            }
            None => memory.jacobian = None,
        }
    }
}

/// The error of the step made last, from two estimates: what the change over it differs from a quadrature, of order four or,
/// for the method of order four, six, where the step resolves the motion, and useless where damping is fast; and what the
/// slope at the beginning differs from that of the polynomial,
///
/// ```text
/// (4/h - J)^-1 (f(t, x) - u'(t))
/// ```
///
/// which is of the order of the number of stages, and for rates beyond the inverse of the step tells by how much the state is
/// off the slow motion: a transient that the method does not damp stays as large as it is. The smaller one counts, and for
/// order six it is taken to that order by the ratio of both.
fn defect<R, S, const N: usize, const M: usize>(
    collocation: &Collocation<R, M>,
    order: u32,
    last: LastStep<'_, R, S, &Memory<R, N, M>, N>,
) -> [f64; N]
where
    R: Ordered,
    S: Differentiable<R, N> + ?Sized,
{
    let LastStep { system, memory, from, to } = last;
    let first = system.rhs(from.time, &from.state);
    let smooth = if order == 4 {
        curved(system, &first, from, to)
    } else {
        quadrature(system, &first, from, to).map(R::to_f64)
    };
    let Some((h, z)) = &memory.last else { return smooth };
    let jacobian = memory.jacobian.unwrap_or_else(|| system.jacobian(from.time, &from.state));
    let Some(factors) = Lu::new(shifted(&jacobian, R::from_ratio(4, 1) / *h)) else { return smooth };
    let begun = collocation.first_slope(z, *h);
    let stiff = factors.solve(entries(|i| first[i] - begun[i]));
    entries(|i| {
        let (smooth, stiff) = (smooth[i], stiff[i].to_f64().abs());
        if order == 4 || smooth >= stiff {
            return smooth.min(stiff);
        }
        let ratio = smooth / stiff;
        smooth * ratio * ratio
    })
}

/// Returns the difference between the change over a step and the rule of order six with slopes and curvatures at its
/// ends and the slope in the middle of the quintic through them. [`quadrature`] would be no estimate for order four:
/// where the equations are linear its rule has the same rational function as the method.
///
/// ```text
/// d = x1 - x0 - h/30 (7 f0 + 16 f(t0 + h/2, m) + 7 f1) - h^2/60 (f0' - f1')
/// m = (x0 + x1)/2 + 5h/32 (f0 - f1) + h^2/64 (f0' + f1')
/// ```
fn curved<R, S, const N: usize>(
    system: &S,
    first: &[R; N],
    from: &Checkpoint<R, N>,
    to: &Checkpoint<R, N>,
) -> [f64; N]
where
    R: Ordered,
    S: Differentiable<R, N> + ?Sized,
{
    let ratio = R::from_ratio;
    let h = to.since(from);
    let last = system.rhs(to.time, &to.state);
    let begins = system.along(from.time, &from.state, R::one(), first);
    let ends = system.along(to.time, &to.state, R::one(), &last);
    let middle = entries(|i| {
        ratio(1, 2) * (from.state[i] + to.state[i])
            + h * (ratio(5, 32) * (first[i] - last[i]) + h * ratio(1, 64) * (begins[i] + ends[i]))
    });
    let middle = system.rhs(from.time + h * ratio(1, 2), &middle);
    entries(|i| {
        let slopes = ratio(7, 30) * (first[i] + last[i]) + ratio(16, 30) * middle[i];
        let mean = slopes + h * ratio(1, 60) * (begins[i] - ends[i]);
        (to.state[i] - from.state[i] - h * mean).to_f64().abs()
    })
}

/// Newton's iteration until its steps are rounding, and how many it took; `None` if they do not become small.
fn iterate<R, S, const N: usize, const M: usize>(
    collocation: &Collocation<R, M>,
    system: &S,
    factors: &Factors<R, N>,
    from: &Checkpoint<R, N>,
    h: R,
    start: Option<[[R; N]; M]>,
    statistics: &mut Statistics,
) -> Option<([[R; N]; M], u32)>
where
    R: Ordered,
    S: Differentiable<R, N> + ?Sized,
{
    const STAGE_ITERATIONS: u32 = 50;
    /// Steps below so many roundings are rounding if they do not become smaller any more.
    const STALLED_ROUNDINGS: f64 = 1e5;
    /// An entry much smaller than the largest one need not be right relative to itself.
    const NEGLIGIBLE_PART: f64 = 1e-3;

    let epsilon = R::epsilon().to_f64();
    let mut z = start.unwrap_or([[R::zero(); N]; M]);
    let mut last = f64::INFINITY;
    for iteration in 1..=STAGE_ITERATIONS {
        let step = collocation.newton(system, factors, (from.time, &from.state, h), &z);
        statistics.evaluations += M as u64;
        let mut sizes = from.state.map(|x| x.to_f64().abs());
        for (stage, step) in z.iter_mut().zip(&step) {
            for k in 0..N {
                stage[k] += step[k];
                sizes[k] = sizes[k].max(stage[k].to_f64().abs());
            }
        }
        let floor = NEGLIGIBLE_PART * sizes.iter().fold(0.0_f64, |most, size| most.max(*size));
        let mut size = 0.0_f64;
        for stage in &step {
            for k in 0..N {
                let part = stage[k].to_f64().abs() / (sizes[k] + floor);
                // Where everything is zero there is nothing to be wrong by.
                let part = if stage[k].to_f64() == 0.0 { 0.0 } else { part };
                if part.is_nan() {
                    return None;
                }
                size = size.max(part);
            }
        }
        if size <= epsilon || (size <= STALLED_ROUNDINGS * epsilon && size >= 0.5 * last) {
            return Some((z, iteration));
        }
        if size > 2.0 * last && iteration > 3 {
            return None;
        }
        last = size;
    }
    None
}
