//! Steady motions on constraints on positions, which the rates alone do not know.

use super::steady::{SteadyError, SteadyMotion, steady};
use crate::linear_algebra::dense::largest;
use crate::numbers::real::{Ordered, Real};
use crate::system::constraints::positions::Positions;
use crate::system::derivatives::linearization::{Linearizable, Linearization};

/// A system whose rates vanish only where its constraints on positions hold.
///
/// ```text
/// r = x' + sum_v F_v f_v/|F_v|^2,    F_v = d f_v/d x
/// ```
///
/// Along `F_v` nothing moves, since `F x' = 0`: both parts vanish together.
struct Held<'a, S, const K: usize, const H: usize>(&'a S);

impl<R, S, const N: usize, const M: usize, const K: usize, const H: usize> Linearizable<R, N, M>
    for Held<'_, S, K, H>
where
    R: Real,
    S: Linearizable<R, N, M> + Positions<R, K, H>,
{
    fn rates(&self, t: R, state: &[R; N], inputs: &[R; M]) -> [R; N] {
        let mut rates = self.0.rates(t, state, inputs);
        for (f, row) in rows::<R, S, N, K, H>(self.0, t, state) {
            let part = f / square(&row);
            rates.iter_mut().zip(row).for_each(|(rate, slope)| *rate += slope * part);
        }
        rates
    }

    /// The linearization without the slopes of `F`: where the constraints hold they have no part in it.
    fn linearization(&self, t: R, state: &[R; N], inputs: &[R; M]) -> Linearization<R, N, M> {
        let mut linear = self.0.linearization(t, state, inputs);
        for (_, row) in rows::<R, S, N, K, H>(self.0, t, state) {
            let square = square(&row);
            for (entries, slope) in linear.a.iter_mut().zip(row) {
                entries.iter_mut().zip(row).for_each(|(entry, other)| *entry += slope * other / square);
            }
        }
        linear
    }
}

/// The left sides of the constraints with their gradients by the coordinates, which come first in the state.
fn rows<R: Real, S: Positions<R, K, H>, const N: usize, const K: usize, const H: usize>(
    system: &S,
    t: R,
    state: &[R; N],
) -> impl Iterator<Item = (R, [R; K])> {
    let (gaps, gradients) = system.linearized(t, &crate::checks::head(state));
    gaps.into_iter().zip(gradients)
}

fn square<R: Real, const K: usize>(row: &[R; K]) -> R {
    row.iter().fold(R::zero(), |sum, slope| sum + *slope * *slope)
}

/// A state and inputs near a guess at which all rates vanish that do not drift, on the constraints on positions.
///
/// ```text
/// r_i(t, s, u) = 0 for all i that do not drift,   f(t, x) = 0
/// ```
///
/// As [`steady`], whose directions and families are those on the constraints here: a pendulum in `x` and `y` hangs at one place.
///
/// ```
/// use guen_runtime::control::{SteadyMotion, steady_on_constraints};
/// use guen_runtime::{Linearizable, Linearization, Positions};
///
/// /// A bead that slides down the line `y = x + 1` to its spring's end, `x' = y' = -(x - u)/2`.
/// struct Bead;
/// impl Linearizable<f64, 2, 1> for Bead {
///     fn rates(&self, _t: f64, [x, _]: &[f64; 2], [u]: &[f64; 1]) -> [f64; 2] {
///         [(u - x) / 2.0; 2]
///     }
///     fn linearization(&self, _t: f64, _: &[f64; 2], _: &[f64; 1]) -> Linearization<f64, 2, 1> {
///         Linearization { a: [[-0.5, 0.0]; 2], b: [[0.5]; 2] }
///     }
/// }
/// impl Positions<f64, 2, 1> for Bead {
///     fn gaps(&self, _t: f64, [x, y]: &[f64; 2]) -> [f64; 1] {
///         [y - x - 1.0]
///     }
///     fn linearized(&self, t: f64, coordinates: &[f64; 2]) -> ([f64; 1], [[f64; 2]; 1]) {
///         (self.gaps(t, coordinates), [[-1.0, 1.0]])
///     }
/// }
/// let held = SteadyMotion { drifting: [false; 2], fixed_states: [false; 2], fixed_inputs: [true] };
/// let ([x, y], _) = steady_on_constraints(&Bead, 0.0, &[5.0, -3.0], &[2.0], &held).unwrap();
/// assert!((x - 2.0).abs() < 1e-14 && (y - 3.0).abs() < 1e-14);
/// ```
///
/// # Errors
///
/// [`SteadyError`]; [`SteadyError::NotFound`] also where the constraints do not hold, as where they move.
pub fn steady_on_constraints<R, S, const N: usize, const M: usize, const K: usize, const H: usize>(
    system: &S,
    t: R,
    state: &[R; N],
    inputs: &[R; M],
    request: &SteadyMotion<N, M>,
) -> Result<([R; N], [R; M]), SteadyError>
where
    R: Ordered,
    S: Linearizable<R, N, M> + Positions<R, K, H>,
{
    let (s, u) = steady(&Held::<S, K, H>(system), t, state, inputs, request)?;
    let off = rows::<R, S, N, K, H>(system, t, &s)
        .fold(0.0, |most: f64, (f, row)| most.max((f / square(&row).sqrt()).abs().to_f64()));
    // Of a constraint that moves, its own rate and its distance may cancel.
    if off <= R::epsilon().sqrt().to_f64() * (1.0 + largest(s.iter().copied())) {
        return Ok((s, u));
    }
    let mut rates = system.rates(t, &s, &u);
    rates
        .iter_mut()
        .zip(&request.drifting)
        .filter(|(_, drifts)| **drifts)
        .for_each(|(rate, _)| *rate = R::zero());
    Err(SteadyError::NotFound { residual: largest(rates.iter().copied()) })
}
