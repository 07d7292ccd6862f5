//! Results of a program with contacts, as the types of `hybrid`.

use crate::Real;
use crate::hybrid::{Conditions, FreeMotion, Loads};

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
    let mut rest = values.iter().copied();
    let mut next = || rest.next().unwrap_or_else(R::zero);
    let rates = core::array::from_fn(|_| next());
    let gaps = core::array::from_fn(|_| next());
    let row_rates = core::array::from_fn(|_| next());
    let biases = core::array::from_fn(|_| next());
    let mut delassus = [[R::zero(); W]; W];
    let triangle = (0..W).flat_map(|row| (0..=row).map(move |column| (row, column)));
    triangle.for_each(|(row, column)| {
        let entry = next();
        (delassus[row][column], delassus[column][row]) = (entry, entry);
    });
    let responses =
        core::array::from_fn(|_| core::array::from_fn(|i| if i < X { R::zero() } else { next() }));
    let friction = core::array::from_fn(|_| next());
    let stiction = core::array::from_fn(|_| next());
    let limits = core::array::from_fn(|_| next());
    FreeMotion { rates, gaps, row_rates, biases, delassus, responses, friction, stiction, limits }
}

/// The conditions of a system with contacts: those under which contacts close, then those under which latches are released.
///
/// ```
/// let conditions = guen_runtime::checks::conditions::<f64, 1>(&[1.0, -1.0]);
/// assert_eq!((conditions.when, conditions.release), ([1.0], [-1.0]));
/// ```
pub fn conditions<R: Real, const C: usize>(values: &[R]) -> Conditions<R, C> {
    let value = |i: usize| values.get(i).copied().unwrap_or_else(R::zero);
    Conditions { when: core::array::from_fn(value), release: core::array::from_fn(|i| value(C + i)) }
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
    let mut rest = values.iter().copied();
    for &element in elements {
        let mut next = || rest.next().unwrap_or_else(R::zero);
        if element < C {
            loads.free[element] = next();
            loads.responses[element] = core::array::from_fn(|_| next());
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
