//! A system over one period: the exponential of a frozen linear model, or the derivative of the flow itself.

use core::error::Error;
use core::fmt;

use crate::linear_algebra::dense::{largest, plus, product, unit};
use crate::numbers::dual::Dual;
use crate::numbers::lift::Lift;
use crate::numbers::real::{Ordered, Real};
use crate::steppers::explicit::rk4;
use crate::system::derivatives::linearization::{Liftable, Linearization, seeded};
use crate::system::from_fn;

/// The reason why there is no discrete model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DiscreteError {
    /// A rate or a derivative is infinite or NaN.
    NotFinite,
    /// No steps are to be made.
    NoSteps,
}

impl fmt::Display for DiscreteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "a rate or a derivative over the period is not finite",
            Self::NoSteps => "a period has at least one step",
        })
    }
}

impl Error for DiscreteError {}

/// The linear model over one period `h`, frozen at its beginning, with inputs held.
///
/// ```text
/// Phi = exp(A h)      Psi = integral_0^h exp(A tau) dtau      Gamma = Psi B      offset = Psi r
/// s(h) = s_0 + offset + Phi (s - s_0) + Gamma (u - u_0)
/// ```
///
/// with `r` the rates at `s_0, u_0`. It is the solution of the *linear* model: it differs from the [`FlowMap`] by what the
/// derivatives change along the period, of second order in `h` away from equilibria.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroOrderHold<R, const N: usize, const M: usize> {
    /// `Phi`, `N` by `N`.
    pub phi: [[R; N]; N],
    /// `Gamma`, `N` by `M`.
    pub gamma: [[R; M]; N],
    /// The way that the linear model goes by itself in one period, from the point of linearisation; zero at
    /// equilibria.
    pub offset: [R; N],
}

impl<R: Ordered, const N: usize, const M: usize> ZeroOrderHold<R, N, M> {
    /// The discrete pair of a linear model with the rates at its point.
    ///
    /// `Psi` is summed as a series over `h 2^-k`, with `k` such that `norm(A) h 2^-k` is at most a half, and doubled by
    /// `Psi(2h) = Psi + Phi Psi`. Beyond ten doublings `E = Phi - 1` is doubled in place of `Phi`, by `E(2h) = 2 E + E^2`, so that slow modes keep
    /// their digits beside fast ones; what a mode has lost by then is right to roundings of one. About `25 + 2 k` products of matrices, no allocation.
    ///
    /// ```
    /// use guen_runtime::{Linearization, control::ZeroOrderHold};
    /// // A mass under a force: h^2/2 and h.
    /// let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0]] };
    /// let pair = ZeroOrderHold::new(&mass, &[3.0, 0.0], 0.5).unwrap();
    /// assert_eq!((pair.phi, pair.gamma), ([[1.0, 0.5], [0.0, 1.0]], [[0.125], [0.5]]));
    /// assert_eq!(pair.offset, [1.5, 0.0]);
    /// ```
    ///
    /// # Errors
    ///
    /// [`DiscreteError::NotFinite`].
    pub fn new(linear: &Linearization<R, N, M>, rates: &[R; N], period: R) -> Result<Self, DiscreteError> {
        /// More than the exponents of a double: modes that decay may be left for ever.
        const MOST_DOUBLINGS: u32 = 2200;
        /// Terms of the series: enough for 70 digits.
        const TERMS: i64 = 60;
        /// Doublings after which `Phi` has lost three digits.
        const MOST_OF_PHI: u32 = 10;

        let size = N as f64 * largest(linear.a.iter().flatten().map(|x| *x * period));
        if !size.is_finite() {
            return Err(DiscreteError::NotFinite);
        }
        let mut doublings = 0;
        let mut h = period;
        let half = R::from_ratio(1, 2);
        let mut rest = size;
        while rest > 0.5 && doublings < MOST_DOUBLINGS {
            h *= half;
            rest *= 0.5;
            doublings += 1;
        }
        let ah = linear.a.map(|row| row.map(|x| x * h));
        // Psi/h = sum_k (A h)^k/(k + 1)!
        let mut term: [[R; N]; N] = unit();
        let mut psi = term;
        for k in 2..=TERMS {
            term = product(&term, &ah).map(|row| row.map(|x| x / R::from_ratio(k, 1)));
            if largest(term.iter().flatten().copied()) < R::epsilon().to_f64() * 1e-3 {
                break;
            }
            for i in 0..N {
                for j in 0..N {
                    psi[i][j] += term[i][j];
                }
            }
        }
        // Phi = 1 + A h (Psi/h)
        let mut change = product(&ah, &psi);
        let mut phi = with_one(&change);
        let mut psi = psi.map(|row| row.map(|x| x * h));
        let is_stiff = doublings > MOST_OF_PHI;
        for _ in 0..doublings {
            if is_stiff {
                let further = product(&change, &psi);
                psi = plus(&plus(&psi, &psi), &further);
                let square = product(&change, &change);
                change = plus(&plus(&change, &change), &square);
            } else {
                psi = plus(&psi, &product(&phi, &psi));
                phi = product(&phi, &phi);
            }
        }
        if is_stiff {
            phi = with_one(&change);
        }
        let gamma = product(&psi, &linear.b);
        let offset: [R; N] = core::array::from_fn(|i| crate::linear_algebra::dense::dot(&psi[i], rates));
        let all = phi.iter().flatten().chain(gamma.iter().flatten()).chain(&offset);
        if all.copied().all(Real::is_finite) {
            Ok(ZeroOrderHold { phi, gamma, offset })
        } else {
            Err(DiscreteError::NotFinite)
        }
    }
}

/// A matrix with the unit matrix added.
fn with_one<R: Real, const N: usize>(a: &[[R; N]; N]) -> [[R; N]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| if i == j { a[i][j] + R::one() } else { a[i][j] }))
}

/// The discrete model of a continuous one with a zero-order hold: `a` is `Phi`, `b` is `Gamma` of [`ZeroOrderHold`], which has the
/// equations, the cost, and the offset that a point beside an equilibrium brings with it.
///
/// ```
/// use guen_runtime::{Linearization, control::c2d};
/// let mass = Linearization { a: [[0.0, 1.0], [0.0, 0.0]], b: [[0.0], [1.0]] };
/// let discrete = c2d(&mass, 0.5).unwrap();
/// assert_eq!((discrete.a, discrete.b), ([[1.0, 0.5], [0.0, 1.0]], [[0.125], [0.5]]));
/// ```
///
/// # Errors
///
/// [`DiscreteError::NotFinite`].
pub fn c2d<R: Ordered, const N: usize, const M: usize>(
    linear: &Linearization<R, N, M>,
    period: R,
) -> Result<Linearization<R, N, M>, DiscreteError> {
    let ZeroOrderHold { phi, gamma, .. } = ZeroOrderHold::new(linear, &[R::zero(); N], period)?;
    Ok(Linearization { a: phi, b: gamma })
}

/// The system itself over one period, with inputs held, and the exact derivatives of the fixed-step method's result.
///
/// ```text
/// next = phi_h(s, u)      Phi = d next / d s      Gamma = d next / d u
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowMap<R, const N: usize, const M: usize> {
    /// The state after the period.
    pub next: [R; N],
    /// `Phi`, `N` by `N`.
    pub phi: [[R; N]; N],
    /// `Gamma`, `N` by `M`.
    pub gamma: [[R; M]; N],
}

impl<R: Ordered, const N: usize, const M: usize> FlowMap<R, N, M>
where
    Dual<R, N>: Lift<R>,
    Dual<R, M>: Lift<R>,
{
    /// The Jacobian of the flow over a period: so many steps of Runge and Kutta's method of order four in dual
    /// numbers. `next` has the bits of the same steps without duals.
    ///
    /// ```
    /// use guen_runtime::{Lift, Liftable, Real, control::FlowMap};
    ///
    /// /// `x' = -x^2 + u`.
    /// struct Decay;
    /// impl Liftable<f64, 1, 1> for Decay {
    ///     fn lifted_rates<S: Real + Lift<f64>>(&self, _t: S, [x]: &[S; 1], [u]: &[S; 1]) -> [S; 1] {
    ///         [*u - *x * *x]
    ///     }
    /// }
    /// // x(t) = 1/(1 + t) from 1, so that dx(1)/dx(0) = 1/4.
    /// let flow = FlowMap::new(&Decay, 0.0, &[1.0], &[0.0], 1.0, 100).unwrap();
    /// assert!((flow.next[0] - 0.5).abs() < 1e-9 && (flow.phi[0][0] - 0.25).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    ///
    /// [`DiscreteError`].
    pub fn new<S: Liftable<R, N, M>>(
        system: &S,
        t: R,
        state: &[R; N],
        inputs: &[R; M],
        period: R,
        steps: u32,
    ) -> Result<Self, DiscreteError> {
        if steps == 0 {
            return Err(DiscreteError::NoSteps);
        }
        let held = inputs.map(Dual::constant);
        let by_state = run(system, t, seeded(state), held, period, steps);
        let by_input = run(system, t, state.map(Dual::constant), seeded(inputs), period, steps);
        let flow = FlowMap {
            next: by_state.map(|x| x.value),
            phi: by_state.map(|x| x.tangent),
            gamma: by_input.map(|x| x.tangent),
        };
        let all = flow.next.iter().chain(flow.phi.iter().flatten()).chain(flow.gamma.iter().flatten());
        if all.copied().all(Real::is_finite) { Ok(flow) } else { Err(DiscreteError::NotFinite) }
    }
}

fn run<R, D, S, const N: usize, const M: usize>(
    system: &S,
    t: R,
    mut state: [D; N],
    inputs: [D; M],
    period: R,
    steps: u32,
) -> [D; N]
where
    R: Real,
    D: Lift<R>,
    S: Liftable<R, N, M>,
{
    let held = from_fn(|t: D, state: &[D; N]| system.lifted_rates(t, state, &inputs));
    let count = R::from_ratio(i64::from(steps), 1);
    let h = period / count;
    for k in 0..steps {
        let now = t + R::from_ratio(i64::from(k), 1) * h;
        state = rk4::step(&held, D::lift(now), &state, D::lift(h));
    }
    state
}
