//! Optimal feedback and optimal estimation of linear models: `lqr`, `dlqr`, `kalman`, `dkalman`, by the algebraic Riccati
//! equation.
//!
//! The equation is solved by the structure-preserving doubling algorithm of Chu, Fan, Lin and Wang (discrete, 2004) and of Chu,
//! Fan and Lin (continuous, 2005). Then the cost of the gain that came out is summed by Smith's doubling, which converges where
//! the closed loop is stable and nowhere else: what is returned has been seen to stabilise. Steps of Newton's method (Kleinman 1968,
//! Hewer 1971), as corrections by what is left of the equation, take away what the first solution lost to rounding.

use core::cmp::Ordering;
use core::error::Error;
use core::fmt;

use crate::linear_algebra::dense::{apply, largest, plus, product, solve, transpose, unit};
use crate::numbers::real::Ordered;
use crate::system::derivatives::linearization::Linearization;

/// A linear feedback that minimises a quadratic cost: see [`lqr`] and [`dlqr`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regulator<R, const N: usize, const M: usize> {
    /// `K`, `M` by `N`: the inputs are `u = u_0 - K (s - s_0)`.
    pub gain: [[R; N]; M],
    /// `P`, `N` by `N`, symmetric: from the deviation `x` on the cost is `x^T P x`.
    pub cost: [[R; N]; N],
}

impl<R: Ordered, const N: usize, const M: usize> Regulator<R, N, M> {
    /// The change of the inputs at a deviation of the state, `-K x`.
    ///
    /// ```
    /// use guen_runtime::control::Regulator;
    /// let regulator = Regulator { gain: [[1.0, 2.0]], cost: [[1.0, 0.0], [0.0, 1.0]] };
    /// assert_eq!(regulator.feedback(&[3.0, -1.0]), [-1.0]);
    /// ```
    pub fn feedback(&self, deviation: &[R; N]) -> [R; M] {
        apply(&self.gain, deviation).map(|u| -u)
    }

    /// The model with the feedback in place, `A - B K`.
    ///
    /// ```
    /// use guen_runtime::{Linearization, control::Regulator};
    /// let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0]] };
    /// let regulator = Regulator { gain: [[1.0, 2.0]], cost: [[1.0, 0.0], [0.0, 1.0]] };
    /// assert_eq!(regulator.closed_loop(&mass), [[0.0, 1.0], [-1.0, -2.0]]);
    /// ```
    pub fn closed_loop(&self, linear: &Linearization<R, N, M>) -> [[R; N]; N] {
        minus(&linear.a, &product(&linear.b, &self.gain))
    }
}

/// A steady Kalman filter: see [`kalman`] and [`dkalman`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer<R, const N: usize, const P: usize> {
    /// `L`, `N` by `P`: what is added to the estimate for each unit of `y - C x`.
    pub gain: [[R; P]; N],
    /// The covariance of the error, `N` by `N`, symmetric; of the discrete filter that before the measurement.
    pub covariance: [[R; N]; N],
}

/// The reason why there is no optimal feedback or estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RiccatiError {
    /// An entry of the model or of a weight is infinite or NaN.
    NotFinite,
    /// The weight of the inputs, or the covariance of the measurement, is not symmetric and positive definite.
    NotDefinite,
    /// The weight of the state, or the covariance of the disturbance, is not symmetric, has a negative entry on its diagonal, or a larger one beside
    /// it than the diagonal allows.
    NotSemidefinite,
    /// No gain was found that stabilises the model. A mode that does not decay by itself is out of the reach of the inputs
    /// or without weight in the cost; of a filter, it is not measured or nothing disturbs it. Give every such mode a weight.
    NotStabilizable,
}

impl fmt::Display for RiccatiError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "an entry of the linear model or of a weight is not finite",
            Self::NotDefinite => {
                "the weight of the inputs (the covariance of the measurement) is not symmetric and positive definite"
            }
            Self::NotSemidefinite => {
                "the weight of the state (the covariance of the disturbance) is not symmetric and positive semidefinite"
            }
            Self::NotStabilizable => {
                "no gain was found that stabilises the linear model: a mode that does not decay by itself is out of reach of the \
                 inputs or has no weight (is not measured, or not disturbed)"
            }
        })
    }
}

impl Error for RiccatiError {}

/// The optimal feedback of `x' = A x + B u`.
///
/// ```text
/// min integral_0^inf (x^T Q x + u^T R u) dt       A^T P + P A - P B R^-1 B^T P + Q = 0       K = R^-1 B^T P
/// ```
///
/// `q` is `Q`, `N` by `N`, symmetric and positive semidefinite; `r` is `R`, `M` by `M`, symmetric and positive definite; their units
/// make both terms the same. About 30 products and solutions of `N` by `N` matrices for each doubling, of which there are some ten; no
/// allocation. What is left of the equation is a few roundings of its terms.
///
/// ```
/// use guen_runtime::Linearization;
/// use guen_runtime::control::{diagonal, lqr};
/// // A mass under a force: K = [1, sqrt(3)].
/// let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0_f64]] };
/// let regulator = lqr(&mass, &diagonal([1.0, 1.0]), &[[1.0]])?;
/// assert!((regulator.gain[0][0] - 1.0).abs() < 1e-14 && (regulator.gain[0][1] - 3f64.sqrt()).abs() < 1e-14);
/// # Ok::<(), guen_runtime::control::RiccatiError>(())
/// ```
///
/// # Errors
///
/// [`RiccatiError`].
pub fn lqr<R: Ordered, const N: usize, const M: usize>(
    linear: &Linearization<R, N, M>,
    q: &[[R; N]; N],
    r: &[[R; M]; M],
) -> Result<Regulator<R, N, M>, RiccatiError> {
    let model = Balanced::of(linear, q, r)?;
    let Balanced { a, b, q, r, inverse, g, .. } = &model;
    let gain_of = |cost: &[[R; N]; N]| product(&product(inverse, &transpose(b)), cost);
    // By the map z -> (z + gamma)/(z - gamma) the left half of the plane becomes the inside of the circle.
    let gamma = R::from_f64(scale(a) + libm::sqrt(scale(g) * scale(q)));
    let first = cayley(a, g, q, gamma).and_then(doubled).ok_or(RiccatiError::NotStabilizable)?;
    let residual = |p: &[[R; N]; N], _: &[[R; N]; M]| {
        let half = product(p, &minus(a, &product(g, p).map(|row| row.map(|x| x * R::from_ratio(1, 2)))));
        plus(&plus(&half, &transpose(&half)), q)
    };
    let found = settled(gain_of(&first), &running_of(q, r), gain_of, residual, |gain, rate| {
        let closed = minus(a, &product(b, gain));
        let gamma = R::from_f64(scale(&closed));
        let shifted = minus(&diagonal([gamma; N]), &closed);
        // X = D^T X D + 2 gamma E^T W E with E = (gamma - A)^-1 and D = (gamma + A) E.
        let inverse = solve(&shifted, &unit())?;
        let step = product(&plus(&diagonal([gamma; N]), &closed), &inverse);
        let rate = product(&transpose(&inverse), &product(rate, &inverse));
        summed(step, rate.map(|row| row.map(|x| x * (gamma + gamma))))
    })?;
    model.in_units(found)
}

/// The optimal feedback of `x_(k+1) = A x_k + B u_k`, as of a model that [`c2d`](super::c2d) made.
///
/// ```text
/// min sum_k (x_k^T Q x_k + u_k^T R u_k)       P = A^T P A - A^T P B (R + B^T P B)^-1 B^T P A + Q
/// K = (R + B^T P B)^-1 B^T P A
/// ```
///
/// Weights, cost and accuracy as of [`lqr`].
///
/// ```
/// use guen_runtime::Linearization;
/// use guen_runtime::control::{c2d, diagonal, dlqr};
/// let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0_f64]] };
/// let regulator = dlqr(&c2d(&mass, 0.01)?, &diagonal([1.0, 1.0]), &[[1.0]])?;
/// // Nearly the gain of the continuous model, with a hundredth of the weights' effort.
/// assert!((regulator.gain[0][0] - 0.99).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// [`RiccatiError`].
pub fn dlqr<R: Ordered, const N: usize, const M: usize>(
    linear: &Linearization<R, N, M>,
    q: &[[R; N]; N],
    r: &[[R; M]; M],
) -> Result<Regulator<R, N, M>, RiccatiError> {
    let model = Balanced::of(linear, q, r)?;
    let Balanced { a, b, q, r, g, .. } = &model;
    let gain_of = |cost: &[[R; N]; N]| {
        let forced = product(&transpose(b), cost);
        // Positive definite, as r is: there is always a solution but for overflow.
        solve_definite(&plus(r, &product(&forced, b)), &product(&forced, a))
            .unwrap_or([[R::from_f64(f64::NAN); N]; M])
    };
    let first = doubled(Pencil { a: *a, g: *g, h: *q }).ok_or(RiccatiError::NotStabilizable)?;
    let residual = |p: &[[R; N]; N], gain: &[[R; N]; M]| {
        let ahead = product(&transpose(a), &product(p, &minus(a, &product(b, gain))));
        minus(&plus(&ahead, q), p)
    };
    let found = settled(gain_of(&first), &running_of(q, r), gain_of, residual, |gain, cost| {
        summed(minus(a, &product(b, gain)), *cost)
    })?;
    model.in_units(found)
}

/// The steady Kalman filter of `x' = A x + w`, `y = C x + v`.
///
/// ```text
/// estimate' = A estimate + B u + L (y - C estimate)      L = P C^T V^-1      A P + P A^T - P C^T V^-1 C P + W = 0
/// ```
///
/// `disturbance` is `W`, the intensity of the white noise `w`, `N` by `N`; `measurement` is `V`, that of `v`, `P` by `P`. It is [`lqr`] of the
/// transposed model, with its cost and errors.
///
/// ```
/// use guen_runtime::control::kalman;
/// // A random walk that is measured: L = sqrt(W/V).
/// let observer = kalman(&[[0.0]], &[[1.0]], &[[4.0]], &[[1.0]])?;
/// assert!((observer.gain[0][0] - 2.0_f64).abs() < 1e-15);
/// # Ok::<(), guen_runtime::control::RiccatiError>(())
/// ```
///
/// # Errors
///
/// [`RiccatiError`].
pub fn kalman<R: Ordered, const N: usize, const P: usize>(
    a: &[[R; N]; N],
    c: &[[R; N]; P],
    disturbance: &[[R; N]; N],
    measurement: &[[R; P]; P],
) -> Result<Observer<R, N, P>, RiccatiError> {
    let dual = Linearization { a: transpose(a), b: transpose(c) };
    let Regulator { gain, cost } = lqr(&dual, disturbance, measurement)?;
    Ok(Observer { gain: transpose(&gain), covariance: cost })
}

/// The steady Kalman filter of `x_(k+1) = A x_k + B u_k + w_k`, `y_k = C x_k + v_k`.
///
/// ```text
/// predict  x = A x + B u        correct  x = x + L (y - C x)        L = P C^T (C P C^T + V)^-1
/// ```
///
/// `P` is the covariance of the error of what was predicted, before the measurement; after it, it is `(1 - L C) P`. The gain of a filter
/// that predicts from measurement to measurement in one step is `A L`. Shapes as of [`kalman`], cost and errors as of [`dlqr`].
///
/// ```
/// use guen_runtime::control::dkalman;
/// // A random walk with as much noise in its steps as in the measurement: the golden section.
/// let observer = dkalman(&[[1.0]], &[[1.0]], &[[1.0]], &[[1.0]])?;
/// assert!((observer.gain[0][0] - (5f64.sqrt() - 1.0) / 2.0).abs() < 1e-15);
/// # Ok::<(), guen_runtime::control::RiccatiError>(())
/// ```
///
/// # Errors
///
/// [`RiccatiError`].
pub fn dkalman<R: Ordered, const N: usize, const P: usize>(
    a: &[[R; N]; N],
    c: &[[R; N]; P],
    disturbance: &[[R; N]; N],
    measurement: &[[R; P]; P],
) -> Result<Observer<R, N, P>, RiccatiError> {
    let dual = Linearization { a: transpose(a), b: transpose(c) };
    let Regulator { cost, .. } = dlqr(&dual, disturbance, measurement)?;
    let seen = product(c, &cost);
    let innovation = plus(measurement, &product(&seen, &transpose(c)));
    let gain = solve_definite(&innovation, &seen).ok_or(RiccatiError::NotFinite)?;
    Ok(Observer { gain: transpose(&gain), covariance: cost })
}

/// A diagonal matrix, as weights mostly are.
///
/// ```
/// use guen_runtime::control::diagonal;
/// assert_eq!(diagonal([4.0, 2.0]), [[4.0, 0.0], [0.0, 2.0]]);
/// ```
pub fn diagonal<R: Ordered, const N: usize>(entries: [R; N]) -> [[R; N]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| if i == j { entries[i] } else { R::zero() }))
}

/// The discrete Riccati equation `X = H + A^T X (1 + G X)^-1 A`.
struct Pencil<R, const N: usize> {
    a: [[R; N]; N],
    g: [[R; N]; N],
    h: [[R; N]; N],
}

/// Doublings after which the horizon is for ever: `2^60` periods.
const MOST_DOUBLINGS: u32 = 60;

/// The pencil of the discrete equation with the same solution as `A^T X + X A - X G X + H = 0`: with `S = A - gamma` and
/// `W = S^T + H S^-1 G` it is `1 + 2 gamma W^-T`, `2 gamma S^-1 G W^-1`, `2 gamma W^-1 H S^-1`.
fn cayley<R: Ordered, const N: usize>(
    a: &[[R; N]; N],
    g: &[[R; N]; N],
    h: &[[R; N]; N],
    gamma: R,
) -> Option<Pencil<R, N>> {
    let shifted = minus(a, &diagonal([gamma; N]));
    let inverse = solve(&shifted, &unit())?;
    let w = plus(&transpose(&shifted), &product(&product(h, &inverse), g));
    let w_inverse = solve(&w, &unit())?;
    let twice = |m: [[R; N]; N]| m.map(|row| row.map(|x| x * (gamma + gamma)));
    Some(Pencil {
        a: plus(&unit(), &twice(transpose(&w_inverse))),
        g: symmetric(&twice(product(&product(&inverse, g), &w_inverse))),
        h: symmetric(&twice(product(&product(&w_inverse, h), &inverse))),
    })
}

/// The solution of the discrete Riccati equation: `h` is the cost of `2^k` periods after `k` doublings.
fn doubled<R: Ordered, const N: usize>(pencil: Pencil<R, N>) -> Option<[[R; N]; N]> {
    let Pencil { mut a, mut g, mut h } = pencil;
    for _ in 0..MOST_DOUBLINGS {
        let w = plus(&unit(), &product(&g, &h));
        let (wa, wg) = (solve(&w, &a)?, solve(&w, &g)?);
        let more = symmetric(&product(&transpose(&a), &product(&h, &wa)));
        g = plus(&g, &symmetric(&product(&product(&a, &wg), &transpose(&a))));
        h = plus(&h, &more);
        a = product(&a, &wa);
        if scale(&more) <= R::epsilon().to_f64() * scale(&h) {
            return Some(h);
        }
    }
    None
}

/// `sum_k (D^T)^k W D^k`, if it converges: where the matrix `D` is stable. None also where the powers become small only when so many steps
/// are multiplied that rounding alone could have done it, as those of a rotation do.
fn summed<R: Ordered, const N: usize>(step: [[R; N]; N], weight: [[R; N]; N]) -> Option<[[R; N]; N]> {
    /// The relative error of a power by rounding from which on its size says nothing.
    const MOST_ROUNDING: f64 = 1.0 / 32.0;
    let (mut power, mut sum) = (step, symmetric(&weight));
    let rounding = R::epsilon().to_f64() * N as f64;
    let mut error = rounding;
    while error < MOST_ROUNDING {
        sum = plus(&sum, &symmetric(&product(&transpose(&power), &product(&sum, &power))));
        power = product(&power, &power);
        error = 2.0 * error + rounding;
        let left = scale(&power);
        if !left.is_finite() {
            return None;
        }
        // What is still to come is at most the square of this in parts of the sum.
        if left * left <= R::epsilon().to_f64() / N as f64 {
            return sum.iter().flatten().all(|x| x.is_finite()).then_some(sum);
        }
    }
    None
}

/// Newton's method from a gain on: the cost of the gain, which is there if it stabilises; then corrections by what is left of the equation.
///
/// `sum_of` sums up a cost rate along the motion with a gain.
fn settled<R: Ordered, const N: usize, const M: usize>(
    first: [[R; N]; M],
    running: &impl Fn(&[[R; N]; M]) -> [[R; N]; N],
    gain_of: impl Fn(&[[R; N]; N]) -> [[R; N]; M],
    residual: impl Fn(&[[R; N]; N], &[[R; N]; M]) -> [[R; N]; N],
    sum_of: impl Fn(&[[R; N]; M], &[[R; N]; N]) -> Option<[[R; N]; N]>,
) -> Result<Regulator<R, N, M>, RiccatiError> {
    /// The number of corrections: one is enough for time constants `1e12` apart; the second costs little.
    const CORRECTIONS: usize = 2;
    let mut cost = sum_of(&first, &running(&first)).ok_or(RiccatiError::NotStabilizable)?;
    for _ in 0..CORRECTIONS {
        let gain = gain_of(&cost);
        let more = sum_of(&gain, &residual(&cost, &gain)).ok_or(RiccatiError::NotStabilizable)?;
        cost = symmetric(&plus(&cost, &more));
    }
    Ok(Regulator { gain: gain_of(&cost), cost })
}

/// `Q + K^T R K` of a gain: what a unit of time costs with it.
fn running_of<R: Ordered, const N: usize, const M: usize>(
    q: &[[R; N]; N],
    r: &[[R; M]; M],
) -> impl Fn(&[[R; N]; M]) -> [[R; N]; N] {
    move |gain| plus(q, &product(&transpose(gain), &product(r, gain)))
}

/// A model and its weights without their units: states are counted in `states`, inputs in `inputs`, powers of two.
///
/// ```text
/// x = D z        u = S v        A -> D^-1 A D        B -> D^-1 B S        Q -> D Q D        R -> S R S
/// ```
struct Balanced<R, const N: usize, const M: usize> {
    a: [[R; N]; N],
    b: [[R; M]; N],
    q: [[R; N]; N],
    r: [[R; M]; M],
    /// `R^-1` and `B R^-1 B^T`.
    inverse: [[R; M]; M],
    g: [[R; N]; N],
    states: [R; N],
    inputs: [R; M],
}

impl<R: Ordered, const N: usize, const M: usize> Balanced<R, N, M> {
    /// Looks at everything that is given, and takes the units away.
    fn of(linear: &Linearization<R, N, M>, q: &[[R; N]; N], r: &[[R; M]; M]) -> Result<Self, RiccatiError> {
        let Linearization { a, b } = linear;
        let mut entries =
            a.iter().flatten().chain(b.iter().flatten()).chain(q.iter().flatten()).chain(r.iter().flatten());
        if !entries.all(|x| x.is_finite()) {
            return Err(RiccatiError::NotFinite);
        }
        if !is_symmetric(q) || !may_be_semidefinite(q) {
            return Err(RiccatiError::NotSemidefinite);
        }
        if !is_symmetric(r) || !is_definite(r) {
            return Err(RiccatiError::NotDefinite);
        }
        let inputs: [R; M] = core::array::from_fn(|j| power_of_two(-0.5 * exponent(r[j][j])));
        let r = scaled(r, &inputs, &inputs);
        let b = scaled(b, &[R::one(); N], &inputs);
        let inverse = solve(&r, &unit()).ok_or(RiccatiError::NotDefinite)?;
        let inverse = symmetric(&inverse);
        let g = symmetric(&product(&product(&b, &inverse), &transpose(&b)));
        let states = balancing(a, &g, q);
        let back = states.map(|x| R::one() / x);
        Ok(Self {
            a: scaled(a, &back, &states),
            b: scaled(&b, &back, &[R::one(); M]),
            q: scaled(q, &states, &states),
            r,
            inverse,
            g: scaled(&g, &back, &back),
            states,
            inputs,
        })
    }

    /// A regulator of this model in the units of the one that was given.
    fn in_units(&self, found: Regulator<R, N, M>) -> Result<Regulator<R, N, M>, RiccatiError> {
        let back = self.states.map(|x| R::one() / x);
        let (gain, cost) = (scaled(&found.gain, &self.inputs, &back), scaled(&found.cost, &back, &back));
        let is_finite = gain.iter().flatten().chain(cost.iter().flatten()).all(|x| x.is_finite());
        if is_finite { Ok(Regulator { gain, cost }) } else { Err(RiccatiError::NotFinite) }
    }
}

/// The powers of two `d` for which rows and columns of `[D^-1 A D, D^-1 G D^-1; D Q D, ..]` with one index are about as long.
fn balancing<R: Ordered, const N: usize>(a: &[[R; N]; N], g: &[[R; N]; N], q: &[[R; N]; N]) -> [R; N] {
    const SWEEPS: usize = 60;
    let mut exponents = [0.0; N];
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..N {
            // The largest exponent of what grows with `d_i`, and of what shrinks.
            let (mut up, mut down) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
            for j in 0..N {
                let [own, other] = [exponents[i], exponents[j]];
                if i != j {
                    up = up.max(exponent(a[j][i]) + own - other);
                    down = down.max(exponent(a[i][j]) + other - own);
                }
                up = up.max(exponent(q[i][j]) + own + other);
                down = down.max(exponent(g[i][j]) - own - other);
            }
            // A quarter: what is on the diagonal changes with the square of `d_i`.
            let step = libm::round((down - up) / 4.0);
            if step.is_finite() && step != 0.0 {
                exponents[i] += step;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    exponents.map(power_of_two)
}

/// The binary logarithm of a size; of zero it is below all others.
fn exponent<R: Ordered>(x: R) -> f64 {
    libm::log2(x.to_f64().abs())
}

/// Two to this power, rounded to a whole one; within the range of the real.
fn power_of_two<R: Ordered>(exponent: f64) -> R {
    const MOST: f64 = 500.0;
    let power = R::from_f64(libm::exp2(libm::round(exponent).clamp(-MOST, MOST)));
    if power.is_finite() && power > R::zero() { power } else { R::one() }
}

/// A matrix with its rows and columns multiplied.
fn scaled<R: Ordered, const N: usize, const M: usize>(
    m: &[[R; M]; N],
    rows: &[R; N],
    columns: &[R; M],
) -> [[R; M]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| m[i][j] * rows[i] * columns[j]))
}

/// Solves with a positive definite matrix, whatever the units of its rows are.
fn solve_definite<R: Ordered, const N: usize, const M: usize>(
    a: &[[R; N]; N],
    b: &[[R; M]; N],
) -> Option<[[R; M]; N]> {
    let units: [R; N] = core::array::from_fn(|i| power_of_two(-0.5 * exponent(a[i][i])));
    let right = scaled(b, &units, &[R::one(); M]);
    Some(scaled(&solve(&scaled(a, &units, &units), &right)?, &units, &[R::one(); M]))
}

/// Symmetric to a thousand roundings.
fn is_symmetric<R: Ordered, const N: usize>(m: &[[R; N]; N]) -> bool {
    let skew = largest((0..N).flat_map(|i| (0..i).map(move |j| m[i][j] - m[j][i])));
    skew <= 1e3 * R::epsilon().to_f64() * largest(m.iter().flatten().copied())
}

/// No entry on the diagonal is negative, and none beside it is larger than the two on the diagonal allow, but for a thousand roundings.
fn may_be_semidefinite<R: Ordered, const N: usize>(m: &[[R; N]; N]) -> bool {
    let rounding = 1e3 * R::epsilon().to_f64() * largest(m.iter().flatten().copied());
    let root = |i: usize| libm::sqrt(m[i][i].to_f64());
    // Of a negative entry the root is NaN.
    (0..N).all(|i| (0..=i).all(|j| m[i][j].to_f64().abs() <= root(i) * root(j) * (1.0 + 1e-12) + rounding))
}

/// Positive definite: all pivots of the elimination are positive.
fn is_definite<R: Ordered, const N: usize>(m: &[[R; N]; N]) -> bool {
    let mut m = *m;
    for k in 0..N {
        let row = m[k];
        // A NaN is no pivot either.
        if row[k].partial_cmp(&R::zero()) != Some(Ordering::Greater) {
            return false;
        }
        for below in m.iter_mut().skip(k + 1) {
            let factor = below[k] / row[k];
            below.iter_mut().zip(&row).for_each(|(x, y)| *x -= factor * *y);
        }
    }
    true
}

fn symmetric<R: Ordered, const N: usize>(m: &[[R; N]; N]) -> [[R; N]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| (m[i][j] + m[j][i]) * R::from_ratio(1, 2)))
}

fn minus<R: Ordered, const N: usize, const M: usize>(a: &[[R; M]; N], b: &[[R; M]; N]) -> [[R; M]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] - b[i][j]))
}

/// The root of the sum of squares.
fn scale<R: Ordered, const N: usize>(m: &[[R; N]; N]) -> f64 {
    let most = largest(m.iter().flatten().copied());
    if most == 0.0 || !most.is_finite() {
        return most;
    }
    let squares: f64 = m.iter().flatten().map(|x| (x.to_f64() / most) * (x.to_f64() / most)).sum();
    most * libm::sqrt(squares)
}
