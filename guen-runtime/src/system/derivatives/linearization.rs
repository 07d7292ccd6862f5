//! The linearisation of rates and of outputs, and the seeds of the duals that derivatives are computed with.

use crate::{Dual, Lift, Real};

/// The exact Jacobians of a right-hand side: `d(state)' = A d(state) + B d(inputs)`.
///
/// ```
/// use guen_runtime::Linearization;
/// let oscillator = Linearization { a: [[0.0, 1.0], [-4.0, 0.0]], b: [[0.0], [1.0]] };
/// assert_eq!(oscillator.a[1][0], -4.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearization<R, const N: usize, const M: usize> {
    /// `a[i][j]`, the derivative of the rate `i` by the state `j`: `N` by `N`.
    pub a: [[R; N]; N],
    /// `b[i][j]`, the derivative of the rate `i` by the input `j`: `N` by `M`.
    pub b: [[R; M]; N],
}

/// The exact Jacobians of `P` outputs: `d(outputs) = C d(state) + D d(inputs)`.
///
/// ```
/// use guen_runtime::OutputLinearization;
/// let position = OutputLinearization { c: [[1.0, 0.0]], d: [[0.0]] };
/// assert_eq!(position.c[0], [1.0, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputLinearization<R, const N: usize, const M: usize, const P: usize> {
    /// `c[i][j]`, the derivative of the output `i` by the state `j`: `P` by `N`.
    pub c: [[R; N]; P],
    /// `d[i][j]`, the derivative of the output `i` by the input `j`: `P` by `M`.
    pub d: [[R; M]; P],
}

/// A system of `N` equations with `M` inputs whose rates and exact Jacobians can be computed: what the analyses of
/// [`control`](crate::control) take. Every prepared system is one.
///
/// ```
/// use guen_runtime::{Linearizable, Linearization};
///
/// /// `x'' = u - sin(x)`.
/// struct Pendulum;
/// impl Linearizable<f64, 2, 1> for Pendulum {
///     fn rates(&self, _t: f64, [x, v]: &[f64; 2], [u]: &[f64; 1]) -> [f64; 2] {
///         [*v, u - x.sin()]
///     }
///     fn linearization(&self, _t: f64, [x, _]: &[f64; 2], _: &[f64; 1]) -> Linearization<f64, 2, 1> {
///         Linearization { a: [[0.0, 1.0], [-x.cos(), 0.0]], b: [[0.0], [1.0]] }
///     }
/// }
/// assert_eq!(Pendulum.linearization(0.0, &[0.0, 0.0], &[0.0]).a[1][0], -1.0);
/// ```
pub trait Linearizable<R: Real, const N: usize, const M: usize> {
    /// The rates of the state.
    fn rates(&self, t: R, state: &[R; N], inputs: &[R; M]) -> [R; N];

    /// The Jacobians of the rates by state and inputs.
    fn linearization(&self, t: R, state: &[R; N], inputs: &[R; M]) -> Linearization<R, N, M>;
}

impl<R: Real, S: Linearizable<R, N, M> + ?Sized, const N: usize, const M: usize> Linearizable<R, N, M>
    for &S
{
    #[inline]
    fn rates(&self, t: R, state: &[R; N], inputs: &[R; M]) -> [R; N] {
        (**self).rates(t, state, inputs)
    }

    #[inline]
    fn linearization(&self, t: R, state: &[R; N], inputs: &[R; M]) -> Linearization<R, N, M> {
        (**self).linearization(t, state, inputs)
    }
}

/// A system whose rates can be computed in any real over `B`, duals included. Every prepared system is one.
///
/// ```
/// use guen_runtime::{Dual, Lift, Liftable, Real};
///
/// /// `x' = k x + u`.
/// struct Growth { k: f64 }
/// impl Liftable<f64, 1, 1> for Growth {
///     fn lifted_rates<S: Real + Lift<f64>>(&self, _t: S, [x]: &[S; 1], [u]: &[S; 1]) -> [S; 1] {
///         [S::lift(self.k) * *x + *u]
///     }
/// }
/// let [rate] = Growth { k: 2.0 }.lifted_rates(Dual::constant(0.0), &[Dual::<f64, 1>::variable(3.0, 0)], &[Dual::constant(0.0)]);
/// assert_eq!((rate.value, rate.tangent), (6.0, [2.0]));
/// ```
pub trait Liftable<B: Real, const N: usize, const M: usize> {
    /// Whether a motion has contacts or resets, which the rates alone do not know: runs by them are refused.
    const THROUGH_MODES: bool = false;

    /// The rates of the state over a real into which `B` is embedded.
    fn lifted_rates<S: Real + Lift<B>>(&self, t: S, state: &[S; N], inputs: &[S; M]) -> [S; N];
}

/// The linearisation of a system by duals: one evaluation of its rates with `N` tangents, and one with `M`.
///
/// ```
/// use guen_runtime::{Lift, Liftable, Real, linearized};
///
/// /// `x' = u sin(x)`.
/// struct Turn;
/// impl Liftable<f64, 1, 1> for Turn {
///     fn lifted_rates<S: Real + Lift<f64>>(&self, _t: S, [x]: &[S; 1], [u]: &[S; 1]) -> [S; 1] {
///         [*u * x.sin()]
///     }
/// }
/// let found = linearized(&Turn, 0.0, &[0.0], &[3.0]);
/// assert_eq!((found.a, found.b), ([[3.0]], [[0.0]]));
/// ```
pub fn linearized<R: Lift<R>, S: Liftable<R, N, M> + ?Sized, const N: usize, const M: usize>(
    system: &S,
    t: R,
    state: &[R; N],
    inputs: &[R; M],
) -> Linearization<R, N, M> {
    let by_state = system.lifted_rates(Dual::constant(t), &seeded(state), &inputs.map(Dual::constant));
    let by_inputs = system.lifted_rates(Dual::constant(t), &state.map(Dual::constant), &seeded(inputs));
    Linearization { a: tangents::<R, N, N>(by_state), b: tangents::<R, N, M>(by_inputs) }
}

/// Each value as the variable with its own index: the duals whose tangents are derivatives by all of them.
///
/// ```
/// use guen_runtime::seeded;
/// let [x, y] = seeded(&[2.0, 3.0]);
/// assert_eq!((x * y).tangent, [3.0, 2.0]);
/// ```
pub fn seeded<R: Real, const N: usize>(values: &[R; N]) -> [Dual<R, N>; N] {
    core::array::from_fn(|i| Dual::variable(values[i], i))
}

/// The time and the state as duals, with the rates at which they change.
///
/// ```
/// use guen_runtime::moving;
/// let (t, [x]) = moving(0.5, &[2.0], 1.0, &[3.0]);
/// assert_eq!((t * x).tangent, [3.5]);
/// ```
pub fn moving<R: Real, const N: usize>(
    t: R,
    state: &[R; N],
    dt: R,
    dx: &[R; N],
) -> (Dual<R, 1>, [Dual<R, 1>; N]) {
    let state = core::array::from_fn(|i| Dual { value: state[i], tangent: [dx[i]] });
    (Dual { value: t, tangent: [dt] }, state)
}

/// The rates of change of duals with one direction.
///
/// ```
/// use guen_runtime::{Dual, slopes};
/// assert_eq!(slopes([Dual { value: 2.0, tangent: [3.0] }]), [3.0]);
/// ```
pub fn slopes<R: Real, const N: usize>(values: [Dual<R, 1>; N]) -> [R; N] {
    values.map(|value| value.tangent[0])
}

/// The tangents of duals, a row for each.
///
/// ```
/// use guen_runtime::{Dual, tangents};
/// assert_eq!(tangents([Dual { value: 2.0, tangent: [3.0, 4.0] }]), [[3.0, 4.0]]);
/// ```
pub fn tangents<R: Real, const N: usize, const D: usize>(values: [Dual<R, D>; N]) -> [[R; D]; N] {
    values.map(|value| value.tangent)
}
