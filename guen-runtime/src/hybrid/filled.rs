//! Arrays filled by a loop.

use crate::numbers::real::Real;

/// The array of a function's values. `core::array::from_fn` makes the same array, but takes four times as much unoptimised code for each closure
/// (`docs/design/build-time.md`).
pub(crate) fn filled<T: Copy + Default, const N: usize>(mut value: impl FnMut(usize) -> T) -> [T; N] {
    let mut array = [T::default(); N];
    for (k, place) in array.iter_mut().enumerate() {
        *place = value(k);
    }
    array
}

/// The table of a function's values.
pub(crate) fn table<T: Copy + Default, const M: usize, const N: usize>(
    mut value: impl FnMut(usize, usize) -> T,
) -> [[T; N]; M] {
    let mut table = [[T::default(); N]; M];
    for (i, row) in table.iter_mut().enumerate() {
        for (j, place) in row.iter_mut().enumerate() {
            *place = value(i, j);
        }
    }
    table
}

/// The diagonal of a matrix.
pub(super) fn diagonal<R: Real, const W: usize>(matrix: &[[R; W]; W]) -> [R; W] {
    let mut diagonal = [R::zero(); W];
    for (w, place) in diagonal.iter_mut().enumerate() {
        *place = matrix[w][w];
    }
    diagonal
}

/// The other signs.
pub(super) fn negated<R: Real, const W: usize>(mut values: [R; W]) -> [R; W] {
    for value in &mut values {
        *value = -*value;
    }
    values
}
