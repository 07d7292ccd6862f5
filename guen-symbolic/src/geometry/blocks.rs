//! The block triangular form of a sparse system.

use std::collections::BTreeMap;

/// Rows and columns of each block, for the columns that each row uses: a block uses only columns of itself and of earlier blocks.
/// `None` where the rows cannot be matched with as many columns.
///
/// A perfect matching of rows to columns by augmenting paths, then the strongly connected components of
/// "the row uses the column that another row is matched to" , ordered by how much each needs.
pub(crate) fn blocks(core: &[Vec<usize>]) -> Option<Vec<(Vec<usize>, Vec<usize>)>> {
    let n = core.len();
    let mut row_of: BTreeMap<usize, usize> = BTreeMap::new();
    fn augment(
        core: &[Vec<usize>],
        r: usize,
        seen: &mut Vec<usize>,
        row_of: &mut BTreeMap<usize, usize>,
    ) -> bool {
        for c in &core[r] {
            if seen.contains(c) {
                continue;
            }
            seen.push(*c);
            let matched = row_of.get(c).copied();
            if matched.is_none_or(|other| augment(core, other, seen, row_of)) {
                row_of.insert(*c, r);
                return true;
            }
        }
        false
    }
    for r in 0..n {
        if !augment(core, r, &mut Vec::new(), &mut row_of) {
            return None;
        }
    }
    let column_of: BTreeMap<usize, usize> = row_of.iter().map(|(c, r)| (*r, *c)).collect();
    let uses = |r: usize| core[r].iter().map(|c| row_of[c]).filter(move |k| *k != r).collect::<Vec<_>>();
    // Reachability is enough for cores of some tens of rows, and simpler than Tarjan's bookkeeping.
    let mut reach = vec![vec![false; n]; n];
    for (r, row) in reach.iter_mut().enumerate() {
        let mut stack = vec![r];
        while let Some(k) = stack.pop() {
            if !row[k] {
                row[k] = true;
                stack.extend(uses(k));
            }
        }
    }
    let mut done = vec![false; n];
    let mut found: Vec<(usize, Vec<usize>)> = Vec::new();
    for r in 0..n {
        if !done[r] {
            let block: Vec<usize> = (0..n).filter(|k| reach[r][*k] && reach[*k][r]).collect();
            for k in &block {
                done[*k] = true;
            }
            // A block that reaches fewer rows is needed by those that reach more.
            found.push((reach[r].iter().filter(|x| **x).count(), block));
        }
    }
    found.sort();
    Some(
        found
            .into_iter()
            .map(|(_, rows)| {
                let columns = rows.iter().map(|r| column_of[r]).collect();
                (rows, columns)
            })
            .collect(),
    )
}
