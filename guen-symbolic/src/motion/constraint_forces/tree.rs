//! The forms of the kinetic energy as differences from each other: a spanning tree in which these are short.

use super::sparse::Vector;
use crate::algebra::{ExprId, Rational};
use crate::workbench::Workbench;

/// A form less a multiple of another one.
#[derive(Clone)]
pub(super) struct Edge {
    pub(super) parent: usize,
    /// The multiple, a number: forms are given up to a factor.
    pub(super) multiple: Rational,
}

/// A component, as a number times the rest.
struct Component {
    e: ExprId,
    content: Rational,
    rest: ExprId,
}

/// Returns the form that each form is taken relative to; `None` is rest.
///
/// The tree has the fewest components in all differences together (Prim's algorithm from rest): each particle of a
/// chain moves relative to the one before with the rate of one link.
pub(super) fn spanning(bench: &mut Workbench, rows: &[Vec<ExprId>]) -> Vec<Option<Edge>> {
    let zero = bench.graph.zero();
    let rows: Vec<Vec<(usize, Component)>> = rows
        .iter()
        .map(|row| {
            let moving = row.iter().enumerate().filter(|(_, e)| **e != zero);
            let parts = moving.map(|(s, e)| {
                let (content, rest) = bench.graph.split_content(*e);
                (s, Component { e: *e, content, rest })
            });
            parts.collect()
        })
        .collect();
    let mut nearest: Vec<(usize, Option<Edge>)> = rows.iter().map(|row| (row.len(), None)).collect();
    let mut edges = vec![None; rows.len()];
    let mut outside: Vec<usize> = (0..rows.len()).collect();
    while let Some(next) = (0..outside.len()).min_by_key(|place| nearest[outside[*place]].0) {
        let k = outside.remove(next);
        edges[k] = nearest[k].1.take();
        for j in &outside {
            // Forms of different lengths differ by as many components at least.
            if rows[*j].len().abs_diff(rows[k].len()) >= nearest[*j].0 {
                continue;
            }
            let (equal, multiple) = in_common(&rows[*j], &rows[k]);
            let distance = rows[*j].len() + rows[k].len() - equal.0 - equal.1;
            if equal.1 > 0 && distance < nearest[*j].0 {
                nearest[*j] = (distance, Some(Edge { parent: k, multiple }));
            }
        }
    }
    edges
}

/// Returns the number of components that two forms have at the same places, the number of these in one ratio, and
/// this ratio.
fn in_common(own: &[(usize, Component)], other: &[(usize, Component)]) -> ((usize, usize), Rational) {
    let (mut i, mut j, mut both) = (0, 0, 0);
    let mut ratios: Vec<(Rational, usize)> = Vec::new();
    let mut equal = 0;
    while i < own.len() && j < other.len() {
        let ((s, a), (t, b)) = (&own[i], &other[j]);
        i += usize::from(s <= t);
        j += usize::from(t <= s);
        if s != t {
            continue;
        }
        both += 1;
        if a.e == b.e {
            equal += 1;
        } else if a.rest == b.rest
            && let Some(inverse) = b.content.recip()
        {
            let ratio = &a.content * &inverse;
            match ratios.iter_mut().find(|(known, _)| *known == ratio) {
                Some((_, count)) => *count += 1,
                None => ratios.push((ratio, 1)),
            }
        }
    }
    let mut best = (Rational::ONE, equal);
    for (ratio, count) in ratios {
        if count > best.1 {
            best = (ratio, count);
        }
    }
    ((both, best.1), best.0)
}

/// The components of a form relative to its parent.
pub(super) fn difference(
    bench: &mut Workbench,
    rows: &[Vec<ExprId>],
    k: usize,
    edge: Option<&Edge>,
) -> Vector {
    let mut found = Vector::default();
    for (s, e) in rows[k].iter().enumerate() {
        let mut entry = *e;
        if let Some(Edge { parent, multiple }) = edge {
            let part = bench.graph.scale(rows[*parent][s], multiple);
            if part != entry && !bench.graph.is_zero(part) {
                let difference = bench.graph.sub(entry, part);
                entry = bench.tidy(difference);
            } else if part == entry {
                continue;
            }
        }
        found.add(bench, s, entry);
    }
    found
}
