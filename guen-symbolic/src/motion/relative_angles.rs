//! The angles between base angles: what entries of sparse equations are short in, and what velocities keep their digits in.

use crate::algebra::{ExprId, Function, Graph, Node, Rational};
use crate::workbench::Workbench;

/// Differences of angles that meet in an expression, as the edges of a forest.
pub(super) struct RelativeAngles {
    edges: Vec<(ExprId, ExprId, ExprId)>,
}

impl RelativeAngles {
    /// Collects the angles between two base angles from expressions that depend on two of them each.
    pub(super) fn new(bench: &mut Workbench, entries: &[ExprId]) -> Self {
        let mut edges = Vec::new();
        let mut trees = Trees::default();
        for e in entries {
            if let [a, b] = angles_in(&bench.graph, *e)[..]
                && trees.join(a, b)
            {
                edges.push((a, b, shorter(bench, *e, a, b)));
            }
        }
        RelativeAngles { edges }
    }

    /// Drops the angles that are not shorter than those that they are between.
    pub(super) fn shorter(mut self, graph: &Graph) -> Self {
        let length = |angle: ExprId| graph.linear_parts(angle).len();
        self.edges.retain(|(a, b, angle)| length(*angle) < length(*a).max(length(*b)));
        self
    }

    pub(super) fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Does something with an expression while its own base angles are those between neighbours; `None` if it does not
    /// depend on two of these. Only on what it depends: a sum of many angles between neighbours is long when multiplied out.
    pub(super) fn within<T>(
        &self,
        bench: &mut Workbench,
        e: ExprId,
        work: impl FnOnce(&mut Workbench) -> T,
    ) -> Option<T> {
        let mut own = angles_in(&bench.graph, e);
        own.extend(self.middles(&own));
        let inside: Vec<_> =
            self.edges.iter().filter(|(a, b, _)| own.contains(a) && own.contains(b)).collect();
        if inside.is_empty() {
            return None;
        }
        let mut trees = Trees::default();
        for (a, b, _) in &inside {
            trees.join(*a, *b);
        }
        let roots = own.into_iter().filter(|angle| trees.is_root(*angle));
        let angles: Vec<ExprId> = roots.chain(inside.iter().map(|(_, _, angle)| *angle)).collect();
        let sines: Vec<ExprId> = angles.into_iter().map(|angle| bench.graph.sin(angle)).collect();
        Some(bench.in_base_angles(&sines, work))
    }
}

impl RelativeAngles {
    /// Angles that join two of some angles that have no edge: two links that hang from a third one.
    fn middles(&self, own: &[ExprId]) -> Vec<ExprId> {
        let other = |edge: &(ExprId, ExprId, ExprId), end: ExprId| match edge {
            (a, b, _) if *a == end => Some(*b),
            (a, b, _) if *b == end => Some(*a),
            _ => None,
        };
        let mut found: Vec<ExprId> = Vec::new();
        for first in own {
            for middle in self.edges.iter().filter_map(|edge| other(edge, *first)) {
                let joins = |edge: &(ExprId, ExprId, ExprId)| {
                    other(edge, middle).is_some_and(|end| end != *first && own.contains(&end))
                };
                if !own.contains(&middle) && !found.contains(&middle) && self.edges.iter().any(joins) {
                    found.push(middle);
                }
            }
        }
        found
    }
}

/// Angles that are joined, each with the number of its tree.
#[derive(Default)]
struct Trees(Vec<(ExprId, usize)>);

impl Trees {
    fn place(&mut self, angle: ExprId) -> usize {
        self.0.iter().position(|(known, _)| *known == angle).unwrap_or_else(|| {
            self.0.push((angle, self.0.len()));
            self.0.len() - 1
        })
    }

    /// Joins the trees of two angles, if they are two.
    fn join(&mut self, a: ExprId, b: ExprId) -> bool {
        let (a, b) = (self.place(a), self.place(b));
        let (first, second) = (self.0[a].1, self.0[b].1);
        self.0.iter_mut().filter(|(_, tree)| *tree == second).for_each(|(_, tree)| *tree = first);
        first != second
    }

    /// Whether an angle stands for its tree, or is in none.
    fn is_root(&self, angle: ExprId) -> bool {
        let place = self.0.iter().position(|(known, _)| *known == angle);
        place.is_none_or(|place| self.0[place].1 == place)
    }
}

/// The base angles of an expression's sines and cosines.
fn angles_in(graph: &Graph, e: ExprId) -> Vec<ExprId> {
    let mut found = Vec::new();
    for id in graph.reachable(&[e], |id| graph.roles(id).is_constant()) {
        if let Node::Function(Function::Sin | Function::Cos, x) = graph.node(id) {
            for (angle, _) in graph.angle_parts(*x) {
                if !graph.roles(angle).is_constant() && !found.contains(&angle) {
                    found.push(angle);
                }
            }
        }
    }
    found
}

/// The difference of two angles, or their sum if an expression is shorter in that: one may be measured the other way round.
fn shorter(bench: &mut Workbench, e: ExprId, a: ExprId, b: ExprId) -> ExprId {
    let [difference, sum] =
        [Rational::MINUS_ONE, Rational::ONE].map(|sign| bench.graph.linear(&[(a, Rational::ONE), (b, sign)]));
    let [short, long] = [difference, sum].map(|angle| {
        let roots = [a, angle].map(|angle| bench.graph.sin(angle));
        let tidy = bench.in_base_angles(&roots, |bench| bench.tidy(e));
        angles_in_written(&bench.graph, tidy)
    });
    if long < short { sum } else { difference }
}

/// Returns the number of different arguments that the sines and cosines of an expression have.
fn angles_in_written(graph: &Graph, e: ExprId) -> usize {
    let mut found: Vec<ExprId> = Vec::new();
    for id in graph.reachable(&[e], |id| graph.roles(id).is_constant()) {
        if let Node::Function(Function::Sin | Function::Cos, x) = graph.node(id)
            && !found.contains(x)
        {
            found.push(*x);
        }
    }
    found.len()
}
