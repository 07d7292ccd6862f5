//! Parts of a system that nothing but forces couples: balls that roll side by side, joined by springs.

use std::collections::BTreeMap;

use crate::algebra::{ExprId, Role, SymbolId};
use crate::motion::graph::Turn;
use crate::motion::{FrameNode, Mechanics};
use crate::workbench::Workbench;

/// The most frames that turn in one part. Coordinates are of one part where a body moves with both, or a form has both.
pub(in crate::motion) fn joints_of_one_part(bench: &Workbench, system: &Mechanics) -> usize {
    let structure = &system.structure;
    let mut parts = Parts::default();
    for frame in structure.frames() {
        parts.join(bench, &[entries(frame), entries(structure.frame(frame.parent))].concat());
    }
    for body in &structure.bodies {
        let mut moved: Vec<ExprId> = body.frame.iter().flat_map(|id| entries(structure.frame(*id))).collect();
        for (frame, components) in body.center.iter().flat_map(|place| &place.terms) {
            moved.extend(components);
            moved.extend(entries(structure.frame(*frame)));
        }
        parts.join(bench, &moved);
    }
    for form in &system.forms.forms {
        let own = system.forms.coordinates.iter().zip(&form.row).filter(|(_, a)| !bench.graph.is_zero(**a));
        let moved: Vec<ExprId> = own.flat_map(|(x, a)| [*x, *a]).chain([form.offset]).collect();
        parts.join(bench, &moved);
    }
    let mut joints: BTreeMap<SymbolId, usize> = BTreeMap::new();
    for frame in structure.frames().iter().skip(1) {
        if let Some(x) = coordinates(bench, &entries(frame)).first() {
            *joints.entry(parts.of(*x)).or_default() += 1;
        }
    }
    joints.values().copied().max().unwrap_or(0)
}

/// A union-find forest over coordinates: each points to another one of its part, and the root stands for the part.
#[derive(Default)]
struct Parts {
    joined: BTreeMap<SymbolId, SymbolId>,
}

impl Parts {
    fn of(&self, x: SymbolId) -> SymbolId {
        let mut of = x;
        while let Some(next) = self.joined.get(&of) {
            of = *next;
        }
        of
    }

    /// Joins all coordinates that occur in some expressions.
    fn join(&mut self, bench: &Workbench, es: &[ExprId]) {
        let found = coordinates(bench, es);
        let Some(first) = found.first() else { return };
        for x in &found[1..] {
            let (one, other) = (self.of(*first), self.of(*x));
            if one != other {
                self.joined.insert(other, one);
            }
        }
    }
}

fn coordinates(bench: &Workbench, es: &[ExprId]) -> Vec<SymbolId> {
    let mut found = bench.graph.symbols_in(es);
    found.retain(|symbol| bench.graph.symbol_info(*symbol).role == Role::Coordinate);
    found
}

fn entries(frame: &FrameNode) -> Vec<ExprId> {
    match &frame.turn {
        Turn::About { axis, angle } => axis.iter().chain([angle]).copied().collect(),
        Turn::General { matrix, .. } => matrix.iter().flatten().copied().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::joints_of_one_part;
    use crate::algebra::{ExprId, Graph};
    use crate::geometry::Form;
    use crate::motion::Mechanics;
    use crate::motion::definition::proof::tests::system;
    use crate::motion::graph::{BodyNode, FrameId, Place, SystemGraph, Turn};
    use crate::workbench::Workbench;

    /// Two arms of two joints each, on a base that is turned by a number; `joins` is given the frames of the joints.
    fn joints(joins: impl FnOnce(&mut Graph, &mut Mechanics, &[FrameId])) -> usize {
        let mut bench = Workbench::new(Graph::new());
        let mut arms = system(&mut bench, &["a", "b", "c", "d"], 4, |graph, _, _, _| {
            let (zero, one) = (graph.zero(), graph.one());
            let row = |i: usize| (0..4).map(|j| if i == j { one } else { zero }).collect();
            ((0..4).map(|i| Form { row: row(i), offset: zero }).collect(), zero, zero)
        });
        let graph = &mut bench.graph;
        arms.structure = SystemGraph::new(graph);
        let (zero, one) = (graph.zero(), graph.one());
        let base = arms.structure.turned(FrameId::WORLD, Turn::About { axis: [zero, zero, one], angle: one });
        let mut frames = Vec::new();
        for (i, angle) in arms.forms.coordinates.iter().enumerate() {
            let (parent, axis) =
                if i % 2 == 0 { (base, [zero, zero, one]) } else { (frames[i - 1], [one, zero, zero]) };
            frames.push(arms.structure.turned(parent, Turn::About { axis, angle: *angle }));
        }
        joins(graph, &mut arms, &frames);
        joints_of_one_part(&bench, &arms)
    }

    fn with_body(joins: impl FnOnce(&[ExprId], &[FrameId]) -> (FrameId, (FrameId, ExprId))) -> usize {
        joints(|graph, arms, frames| {
            let (zero, one) = (graph.zero(), graph.one());
            let (frame, (axes, component)) = joins(&arms.forms.coordinates, frames);
            let component = graph.add(component, one);
            let center = Place { terms: vec![(axes, [component, zero, zero])] };
            let (frame, center, inertia) = (Some(frame), Some(center), [one; 6]);
            arms.structure.bodies.push(BodyNode { name: String::new(), frame, center, mass: one, inertia });
        })
    }

    /// Frames on a base that stands belong to parts of their own, until a body or a form has coordinates of both.
    #[test]
    fn parts_are_joined_by_bodies_and_by_forms() {
        assert_eq!(joints(|_, _, _| {}), 2);
        // A body of one arm in the axes of the other, or at a place of it.
        assert_eq!(with_body(|x, frames| (frames[1], (frames[1], x[0]))), 2);
        assert_eq!(with_body(|x, frames| (frames[3], (frames[1], x[1]))), 4);
        assert_eq!(with_body(|x, frames| (frames[2], (FrameId::WORLD, x[1]))), 4);
        assert_eq!(with_body(|x, frames| (FrameId::WORLD, (frames[1], x[3]))), 4);
        let with_form = |joins: fn(&mut Form, &[ExprId], ExprId)| {
            joints(|graph, arms, _| {
                let one = graph.one();
                joins(&mut arms.forms.forms[0], &arms.forms.coordinates, one);
            })
        };
        assert_eq!(with_form(|form, _, one| form.row[1] = one), 2);
        assert_eq!(with_form(|form, _, one| form.row[3] = one), 4);
        assert_eq!(with_form(|form, x, _| form.row[0] = x[3]), 4);
        assert_eq!(with_form(|form, x, _| form.offset = x[2]), 4);
    }
}
