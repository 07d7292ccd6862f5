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

/// Coordinates that are joined, each with another one of its part; none with the one that stands for the part.
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
