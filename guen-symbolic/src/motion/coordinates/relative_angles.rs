//! The angles between base angles: what entries of sparse equations are short in, and what velocities keep their digits in.

use crate::algebra::{ExprId, FastMap, Function, Graph, Node, Rational};
use crate::workbench::Workbench;

/// Differences of angles that meet in an expression, as the edges of a forest.
pub(in crate::motion) struct RelativeAngles {
    edges: Vec<(ExprId, ExprId, ExprId)>,
    /// The edges at each angle.
    at: FastMap<ExprId, Vec<usize>>,
}

impl RelativeAngles {
    /// Collects the angles between two base angles from expressions that depend on two of them each.
    pub(in crate::motion) fn new(bench: &mut Workbench, entries: &[ExprId]) -> Self {
        let mut edges = Vec::new();
        let mut trees = Trees::default();
        for e in entries {
            if let [a, b] = angles_in(&bench.graph, *e)[..]
                && trees.join(a, b)
            {
                edges.push((a, b, shorter(bench, *e, a, b)));
            }
        }
        Self::of_edges(edges)
    }

    fn of_edges(edges: Vec<(ExprId, ExprId, ExprId)>) -> Self {
        let mut at: FastMap<ExprId, Vec<usize>> = FastMap::default();
        for (place, (a, b, _)) in edges.iter().enumerate() {
            at.or_default(*a).push(place);
            at.or_default(*b).push(place);
        }
        RelativeAngles { edges, at }
    }

    /// The edges at an angle, in their order.
    fn edges_at(&self, angle: ExprId) -> impl Iterator<Item = &(ExprId, ExprId, ExprId)> {
        self.at.get(&angle).into_iter().flatten().map(|place| &self.edges[*place])
    }

    /// Drops the angles that are not shorter than those that they are between.
    pub(in crate::motion) fn shorter(mut self, graph: &Graph) -> Self {
        let length = |angle: ExprId| graph.linear_parts(angle).len();
        self.edges.retain(|(a, b, angle)| length(*angle) < length(*a).max(length(*b)));
        Self::of_edges(self.edges)
    }

    pub(in crate::motion) fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Does something with an expression while its own base angles are those between neighbours; `None` if it does not
    /// depend on two of these. Only on what it depends: a sum of many angles between neighbours is long when multiplied out.
    pub(in crate::motion) fn within<T>(
        &self,
        bench: &mut Workbench,
        e: ExprId,
        work: impl FnOnce(&mut Workbench) -> T,
    ) -> Option<T> {
        let mut own = angles_in(&bench.graph, e);
        own.extend(self.middles(&own));
        let mut inside: Vec<usize> =
            own.iter().filter_map(|angle| self.at.get(angle)).flatten().copied().collect();
        inside.sort_unstable();
        inside.dedup();
        let inside = inside.into_iter().map(|place| &self.edges[place]);
        let inside: Vec<_> = inside.filter(|(a, b, _)| own.contains(a) && own.contains(b)).collect();
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
            for middle in self.edges_at(*first).filter_map(|edge| other(edge, *first)) {
                let joins = |edge: &(ExprId, ExprId, ExprId)| {
                    other(edge, middle).is_some_and(|end| end != *first && own.contains(&end))
                };
                if !own.contains(&middle) && !found.contains(&middle) && self.edges_at(middle).any(joins) {
                    found.push(middle);
                }
            }
        }
        found
    }
}

/// Angles that are joined, as trees.
#[derive(Default)]
struct Trees {
    places: FastMap<ExprId, usize>,
    /// The angle above each angle; a root is its own.
    above: Vec<usize>,
}

impl Trees {
    fn root(&mut self, angle: ExprId) -> usize {
        let next = self.above.len();
        let mut place = *self.places.or_insert_with(angle, || next);
        if place == next {
            self.above.push(next);
        }
        while self.above[place] != place {
            // Halves the way.
            self.above[place] = self.above[self.above[place]];
            place = self.above[place];
        }
        place
    }

    /// Joins the trees of two angles, if they are two.
    fn join(&mut self, a: ExprId, b: ExprId) -> bool {
        let (first, second) = (self.root(a), self.root(b));
        self.above[second] = first;
        first != second
    }

    /// Whether an angle stands for its tree, or is in none.
    fn is_root(&self, angle: ExprId) -> bool {
        self.places.get(&angle).is_none_or(|place| self.above[*place] == *place)
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
