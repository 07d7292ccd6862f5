//! Vectors of which few components differ from zero.

use crate::algebra::ExprId;
use crate::workbench::Workbench;

/// Components by their indices, in ascending order; none is manifestly zero.
#[derive(Clone, Debug, Default)]
pub(super) struct Vector(Vec<(usize, ExprId)>);

impl Vector {
    /// A multiple of a unit vector.
    pub(super) fn unit(index: usize, e: ExprId) -> Self {
        Vector(vec![(index, e)])
    }

    pub(super) fn entries(&self) -> &[(usize, ExprId)] {
        &self.0
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn get(&self, index: usize) -> Option<ExprId> {
        self.0.binary_search_by_key(&index, |entry| entry.0).ok().map(|place| self.0[place].1)
    }

    /// Adds to one component.
    pub(super) fn add(&mut self, bench: &mut Workbench, index: usize, e: ExprId) {
        if bench.graph.is_zero(e) {
            return;
        }
        match self.0.binary_search_by_key(&index, |entry| entry.0) {
            Err(place) => self.0.insert(place, (index, e)),
            Ok(place) => {
                let sum = bench.graph.add(self.0[place].1, e);
                let sum = bench.tidy(sum);
                if bench.graph.is_zero(sum) {
                    self.0.remove(place);
                } else {
                    self.0[place].1 = sum;
                }
            }
        }
    }

    /// Whether there is an index at which neither component is zero.
    pub(super) fn meets(&self, other: &Vector) -> bool {
        self.0.iter().any(|(index, _)| other.0.binary_search_by_key(index, |entry| entry.0).is_ok())
    }

    /// `sum_i a_i b_i w_i`, tidied.
    pub(super) fn dot(&self, bench: &mut Workbench, other: &Vector, weights: &[ExprId]) -> ExprId {
        let mut terms = Vec::new();
        for (index, a) in &self.0 {
            if let Some(b) = other.get(*index) {
                terms.push(bench.graph.product(&[(*a, 1), (b, 1), (weights[*index], 1)]));
            }
        }
        if terms.is_empty() {
            return bench.graph.zero();
        }
        let sum = bench.graph.sum(terms);
        bench.tidy(sum)
    }
}
