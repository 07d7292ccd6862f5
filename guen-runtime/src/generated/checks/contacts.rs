//! Results of a program with contacts, as the types of `hybrid`.

use crate::Real;
use crate::hybrid::filled::{filled, table};
use crate::hybrid::{Conditions, FreeMotion, Loads};

/// The values that are left.
struct Rest<'a, R> {
    values: &'a [R],
}

impl<R: Real> Rest<'_, R> {
    /// The next value; zero where there is none.
    fn next(&mut self) -> R {
        let Some((value, rest)) = self.values.split_first() else { return R::zero() };
        self.values = rest;
        *value
    }
}

/// The free motion of a system with contacts out of the values of its program: rates, gaps, rows, their rates, the lower
/// triangle of the Delassus matrix, the rates of the quasi-velocities that unit forces cause, coefficients of friction and of
/// stiction, limits; with `X` coordinates.
///
/// ```
/// // A point above a floor: the state is a height and its rate, the mass one half.
/// let values = [-1.0, -9.81, 2.0, -1.0, -9.81, 2.0, 2.0, 0.0, 0.0, 0.0];
/// let free = guen_runtime::checks::free_motion::<f64, 1, 2, 1, 1>(&values);
/// assert_eq!((free.gaps, free.delassus, free.responses), ([2.0], [[2.0]], [[0.0, 2.0]]));
/// ```
pub fn free_motion<R: Real, const X: usize, const N: usize, const W: usize, const C: usize>(
    values: &[R],
) -> FreeMotion<R, N, W, C> {
    let mut rest = Rest { values };
    let rates = filled(|_| rest.next());
    let gaps = filled(|_| rest.next());
    let row_rates = filled(|_| rest.next());
    let biases = filled(|_| rest.next());
    let mut delassus = [[R::zero(); W]; W];
    for (w, row) in delassus.iter_mut().enumerate() {
        for entry in &mut row[..=w] {
            *entry = rest.next();
        }
    }
    let delassus = table(|i, j| if j <= i { delassus[i][j] } else { delassus[j][i] });
    let responses = table(|_, i| if i < X { R::zero() } else { rest.next() });
    let friction = filled(|_| rest.next());
    let stiction = filled(|_| rest.next());
    let limits = filled(|_| rest.next());
    FreeMotion { rates, gaps, row_rates, biases, delassus, responses, friction, stiction, limits }
}

/// The conditions of a system with contacts: those under which contacts close, then those under which latches are released.
///
/// ```
/// let conditions = guen_runtime::checks::conditions::<f64, 1>(&[1.0, -1.0]);
/// assert_eq!((conditions.when, conditions.release), ([1.0], [-1.0]));
/// ```
pub fn conditions<R: Real, const C: usize>(values: &[R]) -> Conditions<R, C> {
    let mut rest = Rest { values };
    let when = filled(|_| rest.next());
    Conditions { when, release: filled(|_| rest.next()) }
}

/// The loads of grips under permanent constraints: of each of these elements the reaction without forces of contacts, then what unit forces
/// along the rows add to it.
///
/// ```
/// let loads = guen_runtime::checks::loads::<f64, 1, 2>(&[1], &[3.0, 0.5]);
/// assert_eq!((loads.free, loads.responses), ([0.0, 3.0], [[0.0], [0.5]]));
/// ```
pub fn loads<R: Real, const W: usize, const C: usize>(elements: &[usize], values: &[R]) -> Loads<R, W, C> {
    let mut loads = Loads::none();
    let mut rest = Rest { values };
    for &element in elements {
        if element < C {
            loads.free[element] = rest.next();
            loads.responses[element] = filled(|_| rest.next());
        }
    }
    loads
}

/// The values of switches, with places for the branches of piecewise functions behind them.
///
/// ```
/// assert_eq!(guen_runtime::checks::padded::<1, 2>(&[true]), [true, false]);
/// ```
pub fn padded<const D: usize, const S: usize>(switches: &[bool; D]) -> [bool; S] {
    core::array::from_fn(|s| switches.get(s).copied().unwrap_or(false))
}
