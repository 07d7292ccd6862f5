//! Estimates the cost of an elimination from the pattern of its matrix alone.

use super::sparse::Vector;
use crate::algebra::ExprId;
use crate::workbench::Workbench;

/// Operations for an entry that depends on the state, and for a division.
const ENTRY: usize = 3;
const DIVISION: usize = 4;

/// The non-zero entries of a symmetric matrix of equations, and operations beside the elimination.
pub(super) struct Pattern {
    neighbours: Vec<Vec<bool>>,
    beside: usize,
}

/// The pattern of a mass matrix.
pub(super) fn of_mass(bench: &Workbench, mass: &[Vec<ExprId>]) -> Pattern {
    let l = mass.len();
    let graph = &bench.graph;
    let mut moving = 0;
    let mut neighbours = vec![vec![false; l]; l];
    for s in 0..l {
        for t in 0..s {
            let filled = !graph.is_zero(mass[s][t]);
            (neighbours[s][t], neighbours[t][s]) = (filled, filled);
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
        let count = across.len();
        let mut neighbours = vec![vec![false; count]; count];
        let mut entries = 0;
        for s in 0..count {
            for t in 0..s {
                let filled = across[s].meets(&across[t]);
                (neighbours[s][t], neighbours[t][s]) = (filled, filled);
                entries += usize::from(filled);
            }
        }
        let outgoing: usize =
            along.iter().map(|row| across.iter().filter(|column| column.meets(row)).count()).sum();
        Pattern { neighbours, beside: ENTRY * (entries + outgoing + count) }
    }

    /// Operations of the elimination in the order of least fill, and beside it.
    pub(super) fn cost(&self) -> usize {
        self.beside + elimination_cost(self.neighbours.clone())
    }
}

/// Non-zero components in all differences beyond which nothing is gained.
pub(super) fn densest(parameters: usize, forms: usize) -> usize {
    parameters * forms / 2 + 2 * forms
}

/// Operations of an elimination in the order of least fill.
pub(super) fn elimination_cost(mut neighbours: Vec<Vec<bool>>) -> usize {
    let mut left: Vec<usize> = (0..neighbours.len()).collect();
    let mut cost = 0;
    while let Some(place) =
        (0..left.len()).min_by_key(|place| left.iter().filter(|r| neighbours[left[*place]][**r]).count())
    {
        let k = left.remove(place);
        let around: Vec<usize> = left.iter().copied().filter(|r| neighbours[k][*r]).collect();
        let n = around.len();
        cost += DIVISION + n + n * (n + 1) + 4 * n;
        for a in &around {
            for b in &around {
                neighbours[*a][*b] = a != b;
            }
        }
    }
    cost
}
