//! Adjugates and determinants of small matrices.

use std::collections::BTreeMap;

use crate::algebra::{ExprId, Rational};
use crate::workbench::Workbench;

/// The size of matrices above which none is inverted by its adjugate: blocks of forms are inverted by orthogonal rows then, and blocks of
/// equations without a pivot on the diagonal are not solved so. Minors are twice as many with each row.
pub(crate) const ADJUGATE_SIZE: usize = 5;

/// Adjugate and determinant by minors, each minor once.
pub(crate) fn adjugate(bench: &mut Workbench, matrix: &[Vec<ExprId>]) -> (Vec<Vec<ExprId>>, ExprId) {
    let n = matrix.len();
    let mut memo: BTreeMap<(u32, u32), ExprId> = BTreeMap::new();
    let full = (1_u32 << n) - 1;
    let determinant = minor(bench, matrix, full, full, &mut memo);
    let mut adjugate = vec![vec![bench.graph.zero(); n]; n];
    for (r, row) in (0..n).zip(0_u32..) {
        for (c, column) in (0..n).zip(0_u32..) {
            let m = minor(bench, matrix, full & !(1 << row), full & !(1 << column), &mut memo);
            adjugate[c][r] = if (r + c) % 2 == 1 { bench.graph.neg(m) } else { m };
        }
    }
    (adjugate, determinant)
}

fn minor(
    bench: &mut Workbench,
    matrix: &[Vec<ExprId>],
    rows: u32,
    columns: u32,
    memo: &mut BTreeMap<(u32, u32), ExprId>,
) -> ExprId {
    if rows == 0 {
        return bench.graph.one();
    }
    if let Some(known) = memo.get(&(rows, columns)) {
        return *known;
    }
    // Laplace expansion along the first row.
    let r = rows.trailing_zeros();
    let mut terms = Vec::new();
    let mut sign = Rational::ONE;
    for c in (0..matrix.len() as u32).filter(|c| columns & (1 << c) != 0) {
        let entry = matrix[r as usize][c as usize];
        if !bench.graph.is_zero(entry) {
            let rest = minor(bench, matrix, rows & !(1 << r), columns & !(1 << c), memo);
            terms.push((bench.graph.mul(entry, rest), sign.clone()));
        }
        sign = -sign;
    }
    let sum = bench.graph.linear(&terms);
    let sum = bench.tidy(sum);
    memo.insert((rows, columns), sum);
    sum
}
