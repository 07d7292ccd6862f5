//! The rows of a mode in the order of their elimination, chosen once in numbers, and the elimination in any real.

use crate::numbers::real::Real;

/// The rows whose reactions are unknowns of a mode, in the order in which they are eliminated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::hybrid) struct Pivots<const W: usize> {
    rows: [usize; W],
    /// The number of rows that are eliminated.
    rank: usize,
    /// The number of rows of the mode: those beyond the rank depend on others.
    count: usize,
}

/// The part of a row's own inertia that has to be left for the row to count as independent of those before.
const DEPENDENT: f64 = 1e-10;

impl<const W: usize> Pivots<W> {
    /// Takes rows as they stand.
    pub(in crate::hybrid) fn in_order(rows: impl IntoIterator<Item = usize>) -> Self {
        let mut pivots = Self { rows: [0; W], rank: 0, count: 0 };
        for (place, row) in pivots.rows.iter_mut().zip(rows) {
            *place = row;
            pivots.count += 1;
        }
        pivots.rank = pivots.count;
        pivots
    }

    /// The rows that are eliminated.
    pub(super) fn independent(&self) -> &[usize] {
        self.rows.get(..self.rank).unwrap_or(&self.rows)
    }

    /// All rows of the mode.
    pub(super) fn all(&self) -> &[usize] {
        self.rows.get(..self.count).unwrap_or(&self.rows)
    }

    /// The rows of the mode that depend on those that are eliminated.
    pub(in crate::hybrid) fn dependent(&self) -> &[usize] {
        self.rows.get(self.rank..self.count).unwrap_or(&[])
    }

    /// Whether rows of the mode depend on others.
    pub(in crate::hybrid) fn is_redundant(&self) -> bool {
        self.rank < self.count
    }

    /// The rows ordered by the size of their pivots: each next one is that of which most is left. `inertia` holds the matrix of the
    /// rows, `sizes` what a pivot is compared with.
    pub(in crate::hybrid) fn chosen(mut self, mut matrix: [[f64; W]; W], sizes: &[f64; W]) -> Self {
        self.rank = 0;
        while self.rank < self.count {
            let left = |row: usize| matrix[row][row].abs() / sizes[row].abs();
            let best = (self.rank..self.count).fold(self.rank, |best, at| {
                let (now, then) = (left(self.rows[at]), left(self.rows[best]));
                if now > then * (1.0 + 1e-9) { at } else { best }
            });
            let row = self.rows[best];
            let part = left(row);
            if part.is_nan() || part <= DEPENDENT {
                break;
            }
            self.rows.swap(self.rank, best);
            self.rank += 1;
            for &other in &self.rows[self.rank..self.count] {
                let factor = matrix[other][row] / matrix[row][row];
                for &column in &self.rows[self.rank..self.count] {
                    matrix[other][column] -= factor * matrix[row][column];
                }
            }
        }
        self
    }

    /// Solves `G l = r` for the independent rows, with zeros in all other places of the result; beside it the product of the
    /// pivots, each relative to its size.
    pub(super) fn solve<R: Real>(
        &self,
        mut matrix: [[R; W]; W],
        mut right: [R; W],
        sizes: &[R; W],
    ) -> ([R; W], R) {
        let rows = self.independent();
        let mut product = R::one();
        for (k, &pivot) in rows.iter().enumerate() {
            product *= matrix[pivot][pivot] / sizes[pivot];
            let inverse = matrix[pivot][pivot].recip();
            for &row in &rows[k + 1..] {
                let factor = matrix[row][pivot] * inverse;
                for &column in &rows[k + 1..] {
                    let entry = matrix[pivot][column];
                    matrix[row][column] = matrix[row][column].minus_times(factor, entry);
                }
                right[row] = right[row].minus_times(factor, right[pivot]);
            }
        }
        let mut solution = [R::zero(); W];
        for (k, &row) in rows.iter().enumerate().rev() {
            let mut rest = right[row];
            for &column in &rows[k + 1..] {
                rest = rest.minus_times(matrix[row][column], solution[column]);
            }
            solution[row] = rest / matrix[row][row];
        }
        (solution, product)
    }
}

#[cfg(test)]
mod tests {
    use super::Pivots;

    #[test]
    fn an_unsymmetric_matrix_is_solved_and_its_determinant_found() {
        let matrix = [[2.0, 1.0, 0.0], [0.5, 3.0, -1.0], [0.0, 1.0, 4.0]];
        let pivots = Pivots::<3>::in_order([0, 1, 2]).chosen(matrix, &[2.0, 3.0, 4.0]);
        let (x, determinant) = pivots.solve(matrix, [4.0, 3.5, 14.0], &[1.0; 3]);
        for (found, expected) in x.into_iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - expected).abs() < 1e-14);
        }
        assert!((determinant - 24.0).abs() < 1e-13);
    }

    #[test]
    fn a_row_that_depends_on_others_is_left_out() {
        // Two feet of a block that stick: the tangential rows are the same.
        let d = [[2.0, 1.0, 1.0], [1.0, 2.0, 2.0], [1.0, 2.0, 2.0]];
        let pivots = Pivots::<3>::in_order([0, 1, 2]).chosen(d, &[2.0; 3]);
        assert!(pivots.is_redundant());
        assert_eq!((pivots.independent().len(), pivots.all().len()), (2, 3));
    }
}
