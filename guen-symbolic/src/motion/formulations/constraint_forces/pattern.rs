//! Estimates the cost of an elimination from the pattern of its matrix alone.

use std::collections::BTreeSet;

use crate::algebra::ExprId;
use crate::motion::mass_matrix::sparse::{Columns, Vector};
use crate::workbench::Workbench;

/// Operations for an entry that depends on the state, and for a division.
const ENTRY: usize = 3;
const DIVISION: usize = 4;

/// The non-zero entries of a symmetric matrix of equations, and operations beside the elimination.
pub(super) struct Pattern {
    /// The rows that meet each row, itself left out.
    neighbours: Vec<BTreeSet<usize>>,
    beside: usize,
}

/// The pattern of a mass matrix.
pub(super) fn of_mass(bench: &Workbench, mass: &[Vec<ExprId>]) -> Pattern {
    let l = mass.len();
    let graph = &bench.graph;
    let mut moving = 0;
    let mut neighbours = vec![BTreeSet::new(); l];
    for s in 0..l {
        for t in 0..s {
            if !graph.is_zero(mass[s][t]) {
                neighbours[s].insert(t);
                neighbours[t].insert(s);
            }
            moving += usize::from(!graph.roles(mass[s][t]).is_constant());
        }
        moving += usize::from(!graph.roles(mass[s][s]).is_constant());
    }
    if moving == 0 {
        // All factors are prepared.
        return Pattern { neighbours: Vec::new(), beside: 0 };
    }
    // Each entry has its centrifugal force.
    Pattern { neighbours, beside: 2 * ENTRY * moving }
}

impl Pattern {
    /// The pattern of the matrix of the constraint forces, whose entries are products of columns.
    pub(super) fn of_products(across: &[Vector], along: &[Vector]) -> Self {
        let columns = Columns::new(across);
        let met_by = |(s, own)| columns.meeting(own).into_iter().filter(|t| *t != s).collect();
        let neighbours: Vec<BTreeSet<usize>> = across.iter().enumerate().map(met_by).collect();
        let entries = neighbours.iter().map(BTreeSet::len).sum::<usize>() / 2;
        let outgoing: usize = along.iter().map(|row| columns.meeting(row).len()).sum();
        Pattern { neighbours, beside: ENTRY * (entries + outgoing + across.len()) }
    }

    /// Operations of the elimination in the order of least fill, and beside it.
    pub(super) fn cost(&self) -> usize {
        self.beside + elimination_cost(self.neighbours.clone())
    }
}

/// Operations of an elimination in the order of least fill.
fn elimination_cost(mut neighbours: Vec<BTreeSet<usize>>) -> usize {
    let mut left: BTreeSet<(usize, usize)> = neighbours.iter().map(BTreeSet::len).zip(0..).collect();
    let mut cost = 0;
    while let Some((n, k)) = left.pop_first() {
        cost += DIVISION + n + n * (n + 1) + 4 * n;
        let around = core::mem::take(&mut neighbours[k]);
        for r in &around {
            left.remove(&(neighbours[*r].len(), *r));
            neighbours[*r].remove(&k);
            neighbours[*r].extend(around.iter().filter(|other| *other != r));
            left.insert((neighbours[*r].len(), *r));
        }
    }
    cost
}
