//! Elimination of vertices from a linearised computational graph.
//!
//! A vertex `v` goes by `w_ps += w_pv w_vs` for all predecessors `p` and successors `s`. What is left when all went
//! are the edges from variables to outputs: the Jacobian. Forward mode eliminates in the order of the program, reverse
//! mode in the opposite one; Markowitz' rule takes the vertex next that makes the fewest products. (Finding the
//! cheapest order of all is hard; Griewank and Walther, *Evaluating Derivatives*, 2nd ed., chapters 9 and 10.)

use std::collections::{BTreeMap, BTreeSet};

use super::Pattern;
use super::factors::{Code, Factor};

/// The order in which vertices are eliminated.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Order {
    /// The one with the fewest products next.
    Markowitz,
    /// The order in which the program computes them.
    Forward,
    /// Backwards.
    Reverse,
}

impl Order {
    pub(super) const ALL: [Order; 3] = [Order::Markowitz, Order::Forward, Order::Reverse];
}

/// Vertices with the edges between them: variables first, then values of the program.
pub(super) struct LinearGraph {
    variables: usize,
    before: Vec<BTreeMap<usize, Factor>>,
    after: Vec<BTreeSet<usize>>,
    outputs: Vec<Option<usize>>,
}

impl LinearGraph {
    pub(super) fn new(variables: usize) -> Self {
        LinearGraph {
            variables,
            before: vec![BTreeMap::new(); variables],
            after: vec![BTreeSet::new(); variables],
            outputs: Vec::new(),
        }
    }

    /// A new vertex behind others; edges from the same one are added.
    pub(super) fn vertex(&mut self, code: &mut Code, edges: &[(usize, Factor)]) -> usize {
        let vertex = self.before.len();
        self.before.push(BTreeMap::new());
        self.after.push(BTreeSet::new());
        for (from, factor) in edges {
            self.add(code, *from, vertex, *factor);
        }
        vertex
    }

    /// The vertices of the outputs, `None` for one that does not vary. Each gets a vertex of its own, that stays.
    pub(super) fn set_outputs(&mut self, outputs: Vec<Option<usize>>) {
        for output in outputs {
            let Some(source) = output else {
                self.outputs.push(None);
                continue;
            };
            let vertex = self.before.len();
            self.before.push(BTreeMap::from([(source, Factor::ONE)]));
            self.after.push(BTreeSet::new());
            self.after[source].insert(vertex);
            self.outputs.push(Some(vertex));
        }
    }

    fn add(&mut self, code: &mut Code, from: usize, to: usize, factor: Factor) {
        let sum = match self.before[to].get(&from) {
            Some(known) => code.sum(*known, factor),
            None => Some(factor),
        };
        match sum {
            Some(sum) => {
                self.before[to].insert(from, sum);
                self.after[from].insert(to);
            }
            None => {
                self.before[to].remove(&from);
                self.after[from].remove(&to);
            }
        }
    }

    fn eliminate(&mut self, code: &mut Code, vertex: usize) {
        let before = std::mem::take(&mut self.before[vertex]);
        let after = std::mem::take(&mut self.after[vertex]);
        for to in &after {
            let Some(onward) = self.before[*to].remove(&vertex) else { continue };
            for (from, factor) in &before {
                let product = code.product(*factor, onward);
                self.add(code, *from, *to, product);
            }
        }
        for from in before.keys() {
            self.after[*from].remove(&vertex);
        }
    }

    /// The entries of the Jacobian that do not vanish, row by row.
    pub(super) fn eliminated(mut self, code: &mut Code, order: Order) -> (Vec<Factor>, Pattern) {
        let kept: BTreeSet<usize> = self.outputs.iter().flatten().copied().collect();
        let inner: Vec<usize> =
            (self.variables..self.before.len()).filter(|vertex| !kept.contains(vertex)).collect();
        match order {
            Order::Forward => inner.into_iter().for_each(|vertex| self.eliminate(code, vertex)),
            Order::Reverse => inner.into_iter().rev().for_each(|vertex| self.eliminate(code, vertex)),
            Order::Markowitz => self.eliminate_cheapest_first(code, &inner),
        }
        let mut entries = Vec::new();
        let mut pattern = Pattern::new();
        for (row, output) in self.outputs.iter().enumerate() {
            for (column, factor) in output.iter().flat_map(|vertex| &self.before[*vertex]) {
                entries.push(*factor);
                pattern.push((row, *column));
            }
        }
        (entries, pattern)
    }

    fn eliminate_cheapest_first(&mut self, code: &mut Code, inner: &[usize]) {
        let degree = |graph: &Self, v: usize| graph.before[v].len() * graph.after[v].len();
        let mut current: BTreeMap<usize, usize> = inner.iter().map(|v| (*v, degree(self, *v))).collect();
        let mut queue: BTreeSet<(usize, usize)> = current.iter().map(|(v, d)| (*d, *v)).collect();
        while let Some((_, vertex)) = queue.pop_first() {
            current.remove(&vertex);
            let touched: Vec<usize> =
                self.before[vertex].keys().chain(&self.after[vertex]).copied().collect();
            self.eliminate(code, vertex);
            for v in touched {
                if let Some(known) = current.get_mut(&v) {
                    queue.remove(&(*known, v));
                    *known = degree(self, v);
                    queue.insert((*known, v));
                }
            }
        }
    }
}
