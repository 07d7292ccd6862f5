//! The forms of the kinetic energy as differences from each other: a spanning tree in which these are short.

use super::sparse::Vector;
use crate::algebra::ExprId;
use crate::workbench::Workbench;

/// For each form the one that it is taken relative to; `None` is rest.
///
/// The tree has the fewest components in all differences together (Prim's algorithm from rest): each particle of a
/// chain moves relative to the one before with the rate of one link.
pub(super) fn spanning(rows: &[Vec<ExprId>], zero: ExprId) -> Vec<Option<usize>> {
    let mut nearest: Vec<(usize, Option<usize>)> =
        rows.iter().map(|row| (row.iter().filter(|e| **e != zero).count(), None)).collect();
    let mut parents = vec![None; rows.len()];
    let mut outside: Vec<usize> = (0..rows.len()).collect();
    while let Some(next) = (0..outside.len()).min_by_key(|place| nearest[outside[*place]].0) {
        let k = outside.remove(next);
        parents[k] = nearest[k].1;
        for j in &outside {
            let distance = distance(&rows[k], &rows[*j]);
            if distance < nearest[*j].0 {
                nearest[*j] = (distance, Some(k));
            }
        }
    }
    parents
}

/// In how many components two forms differ.
fn distance(a: &[ExprId], b: &[ExprId]) -> usize {
    let (mut index, mut count) = (0, 0);
    while index < a.len() {
        count += usize::from(a[index] != b[index]);
        index += 1;
    }
    count
}

/// The components of a form relative to its parent.
pub(super) fn difference(bench: &mut Workbench, own: &[ExprId], parent: Option<&[ExprId]>) -> Vector {
    let mut found = Vector::default();
    for (s, e) in own.iter().enumerate() {
        let other = parent.map_or(bench.graph.zero(), |row| row[s]);
        if *e != other {
            let entry = bench.graph.sub(*e, other);
            let entry = bench.tidy(entry);
            found.add(bench, s, entry);
        }
    }
    found
}
