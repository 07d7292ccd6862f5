//! Vectors of which few components differ from zero.

use crate::algebra::{ExprId, Graph};
use crate::workbench::Workbench;

/// Components by their indices, in ascending order; none is manifestly zero.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct Vector(Vec<(usize, ExprId)>);

/// The vectors of a list that have a component at each index.
pub(in crate::motion) struct Columns(Vec<Vec<usize>>);

impl Vector {
    /// A multiple of a unit vector.
    pub(in crate::motion) fn unit(index: usize, e: ExprId) -> Self {
        Vector(vec![(index, e)])
    }

    /// The components of a list that are not zero.
    pub(in crate::motion) fn of_list(graph: &Graph, list: &[ExprId]) -> Self {
        let components = list.iter().copied().enumerate();
        Vector(components.filter(|(_, e)| !graph.is_zero(*e)).collect())
    }

    pub(in crate::motion) fn entries(&self) -> &[(usize, ExprId)] {
        &self.0
    }

    pub(in crate::motion) fn len(&self) -> usize {
        self.0.len()
    }

    pub(in crate::motion) fn get(&self, index: usize) -> Option<ExprId> {
        self.0.binary_search_by_key(&index, |entry| entry.0).ok().map(|place| self.0[place].1)
    }

    /// The components with their indices, each to be changed to one that is not zero.
    pub(in crate::motion) fn entries_mut(&mut self) -> impl Iterator<Item = (usize, &mut ExprId)> {
        self.0.iter_mut().map(|(index, e)| (*index, e))
    }

    /// Makes an expression the component at an index.
    pub(in crate::motion) fn set(&mut self, graph: &Graph, index: usize, e: ExprId) {
        match (self.0.binary_search_by_key(&index, |entry| entry.0), graph.is_zero(e)) {
            (Ok(place), true) => {
                self.0.remove(place);
            }
            (Ok(place), false) => self.0[place].1 = e,
            (Err(_), true) => {}
            (Err(place), false) => self.0.insert(place, (index, e)),
        }
    }

    /// Leaves out the component at an index.
    pub(in crate::motion) fn remove(&mut self, index: usize) {
        if let Ok(place) = self.0.binary_search_by_key(&index, |entry| entry.0) {
            self.0.remove(place);
        }
    }

    /// Adds to one component.
    pub(in crate::motion) fn add(&mut self, bench: &mut Workbench, index: usize, e: ExprId) {
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

    /// `sum_i a_i b_i w_i`, tidied.
    pub(in crate::motion) fn dot(&self, bench: &mut Workbench, other: &Vector, weights: &[ExprId]) -> ExprId {
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

impl Columns {
    pub(in crate::motion) fn new(vectors: &[Vector]) -> Self {
        let mut columns: Vec<Vec<usize>> = Vec::new();
        for (place, vector) in vectors.iter().enumerate() {
            for (index, _) in vector.entries() {
                if *index >= columns.len() {
                    columns.resize(index + 1, Vec::new());
                }
                columns[*index].push(place);
            }
        }
        Columns(columns)
    }

    /// The vectors that have a component at this index, in their order.
    pub(in crate::motion) fn at(&self, index: usize) -> &[usize] {
        self.0.get(index).map_or(&[], |column| column)
    }

    /// The vectors that have a component where a vector has one, in their order.
    pub(in crate::motion) fn meeting(&self, vector: &Vector) -> Vec<usize> {
        let mut found = Vec::new();
        for (index, _) in vector.entries() {
            found.extend_from_slice(self.at(*index));
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}
