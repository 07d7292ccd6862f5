//! Points: the origins at which bodies are seen, each in its axes, from the places of a graph.
//!
//! A body is seen from the origin of its own axes, which is where the terms of its place in other axes lead. So the origin
//! of a link is on its joint, and its body's centre and the joints that it carries are constants in its axes.

use super::axes::{AllAxes, about};
use super::rotations::{Matrix, Shift, Vector, further};
use super::shifts::Turned;
use crate::algebra::{ExprId, Node};
use crate::motion::graph::Place;
use crate::workbench::Workbench;

/// A point with axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    /// The axes that move with it.
    pub(super) axes: usize,
    /// The point that it is seen from; older.
    pub(super) parent: usize,
    /// The place as seen from that point, in its axes.
    pub(super) offset: Vector,
    /// Whether that is no constant: then it has the axes of the point that it is seen from.
    pub(super) slides: bool,
    /// The axes in which it is constant nevertheless, and what it is there: axes that hang on those of the point.
    pub(super) arm: Option<(usize, Vector)>,
}

/// A place by the axes of its terms, in ascending order.
pub(super) type Terms = Vec<(usize, Vector)>;

/// The points; the first is the origin of the world.
pub(super) struct Points {
    pub(super) list: Vec<Point>,
}

impl Points {
    pub(super) fn new(bench: &Workbench) -> Self {
        let offset = [bench.graph.zero(); 3];
        Points { list: vec![Point { axes: 0, parent: 0, offset, slides: false, arm: None }] }
    }

    /// The point, new or known.
    pub(super) fn push(&mut self, point: Point) -> usize {
        if let Some(known) = self.list.iter().position(|known| *known == point) {
            return known;
        }
        self.list.push(point);
        self.list.len() - 1
    }

    /// A place as an offset, constant in some axes, from a point with these axes.
    pub(super) fn locate(
        &mut self,
        bench: &mut Workbench,
        all: &AllAxes,
        axes: usize,
        terms: &Terms,
    ) -> (usize, Vector) {
        // What hangs elsewhere is seen in the axes where the ways part.
        let mut own = [bench.graph.zero(); 3];
        let mut fixed = own;
        let (mut rest, mut arms) = (Terms::new(), Vec::new());
        for (place, vector) in terms {
            let is_fixed = vector.iter().all(|e| bench.graph.roles(*e).is_constant());
            if *place == axes && is_fixed {
                fixed = [0, 1, 2].map(|i| bench.graph.add(fixed[i], vector[i]));
            } else if *place == axes
                || !all.hangs_on(axes, *place) && self.parts_at(all, axes, *place) == axes
            {
                let seen = all.seen_from(bench, axes, *place, vector);
                if *place != axes && is_fixed {
                    arms.push((seen, (*place, *vector)));
                } else {
                    own = [0, 1, 2].map(|i| bench.graph.add(own[i], seen[i]));
                }
            } else {
                rest.push((*place, *vector));
            }
        }
        let (mut base, ahead) = self.origin(bench, all, axes, &rest);
        // One after the other, so that what hangs further out is seen from the same points.
        for (offset, arm) in arms {
            base = self.push(Point { axes, parent: base, offset, slides: true, arm: Some(arm) });
        }
        if let Turned::About { axis, .. } = all.list[axes].turned {
            fixed[axis] = bench.graph.add(fixed[axis], ahead);
        }
        let zero = bench.graph.zero();
        let is_fixed = |e: ExprId| bench.graph.roles(e).is_constant();
        let moving = own.map(|e| if is_fixed(e) { zero } else { e });
        let own = own.map(|e| if is_fixed(e) { e } else { zero });
        let fixed = [0, 1, 2].map(|i| bench.graph.add(fixed[i], own[i]));
        // What is fixed in the world neither moves nor weighs anything there.
        let fixed = if axes == 0 { [zero; 3] } else { fixed };
        if moving == [zero; 3] {
            return (base, fixed);
        }
        (self.push(Point { axes, parent: base, offset: moving, slides: true, arm: None }), fixed)
    }

    /// The origin of axes whose place has these terms, none of them in the axes themselves, and how far that place is from it
    /// along the axis of the joint: origins may be anywhere there.
    fn origin(&mut self, bench: &mut Workbench, all: &AllAxes, axes: usize, rest: &Terms) -> (usize, ExprId) {
        if axes == 0 {
            return (0, bench.graph.zero());
        }
        let (parent, mut offset) = self.locate(bench, all, all.list[axes].parent, rest);
        let mut ahead = bench.graph.zero();
        if let Turned::About { axis, .. } = all.list[axes].turned {
            ahead = core::mem::replace(&mut offset[axis], ahead);
        }
        (self.push(Point { axes, parent, offset, slides: false, arm: None }), ahead)
    }

    /// The youngest axes on which both hang.
    fn parts_at(&self, all: &AllAxes, a: usize, b: usize) -> usize {
        let mut place = b;
        while !all.hangs_on(a, place) {
            place = all.list[place].parent;
        }
        place
    }
}

/// The terms of a sum that are constants.
fn constant_terms(bench: &mut Workbench, e: ExprId) -> ExprId {
    let graph = &mut bench.graph;
    if graph.roles(e).is_constant() {
        return e;
    }
    let Node::Sum { constant, terms } = graph.node(e).clone() else { return graph.zero() };
    let mut fixed = vec![graph.number(constant)];
    for (term, c) in terms.iter() {
        if graph.roles(*term).is_constant() {
            let c = graph.number(c.clone());
            fixed.push(graph.mul(c, *term));
        }
    }
    graph.sum(fixed)
}

impl AllAxes {
    /// The terms of a place in axes.
    pub(in crate::motion) fn terms(&self, bench: &mut Workbench, place: &Place) -> Terms {
        let mut terms = Terms::new();
        for (frame, vector) in &place.terms {
            let axes = self.of(*frame);
            let fixed = vector.map(|e| constant_terms(bench, e));
            let moving = [0, 1, 2].map(|i| bench.graph.sub(vector[i], fixed[i]));
            for own in [fixed, moving] {
                let own = self.vector(bench, *frame, &own);
                let is_fixed = |vector: &Vector| vector.iter().all(|e| bench.graph.roles(*e).is_constant());
                let same = |(other, known): &&mut (usize, Vector)| {
                    *other == axes && is_fixed(known) == is_fixed(&own)
                };
                match terms.iter_mut().find(same) {
                    Some((_, known)) => *known = [0, 1, 2].map(|i| bench.graph.add(known[i], own[i])),
                    None => terms.push((axes, own)),
                }
            }
        }
        terms.sort_by_key(|(axes, _)| *axes);
        terms.retain(|(_, vector)| vector.iter().any(|e| !bench.graph.is_zero(*e)));
        terms
    }

    /// A vector in axes that hang on others, seen in these.
    fn seen_from(&self, bench: &mut Workbench, axes: usize, place: usize, vector: &Vector) -> Vector {
        let (mut place, mut vector) = (place, *vector);
        while place != axes {
            let matrix = self.matrix(bench, place);
            vector = matrix.map(|row| bench.dot(&row, &vector));
            place = self.list[place].parent;
        }
        vector
    }

    /// The matrix from axes to their parent's.
    fn matrix(&self, bench: &mut Workbench, axes: usize) -> Matrix {
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let mut matrix = [[zero; 3]; 3];
        match &self.list[axes].turned {
            Turned::World => (0..3).for_each(|i| matrix[i][i] = one),
            Turned::About { axis, turn: [c, s], .. } => {
                let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
                matrix[*axis][*axis] = one;
                matrix[j][j] = *c;
                matrix[k][k] = *c;
                matrix[k][j] = *s;
                matrix[j][k] = bench.graph.neg(*s);
            }
            Turned::By { matrix: own, .. } => matrix = *own,
        }
        matrix
    }

    /// Lets axes hang on those of the link before them: where a place leads through axes that are turned about the same axis
    /// of the same parent, the difference of the angles is the joint's.
    pub(super) fn settle(&mut self, bench: &mut Workbench, axes: usize, terms: &Terms) {
        let Turned::About { axis, angle: Some(angle), shift, .. } = self.list[axes].turned else { return };
        let parent = self.list[axes].parent;
        // The link before: as deep as any other, about parallel axes.
        let before = terms.iter().map(|(place, _)| *place).filter(|place| *place < axes && *place != parent);
        let found = before.filter_map(|place| Some((place, self.whole_angle(bench, place, parent, axis)?)));
        let Some((before, (whole, behind))) =
            found.collect::<Vec<_>>().into_iter().max_by_key(|(place, _)| self.depth(*place))
        else {
            return;
        };
        let others = terms.iter().map(|(place, _)| *place).filter(|place| *place != axes);
        if !others.into_iter().all(|other| self.hangs_on(before, other)) {
            return;
        }
        let bend = bench.graph.sub(angle, whole);
        let shift = match (shift, behind) {
            (shift, None) => shift,
            (shift, Some([c, s])) => {
                let back = [c, bench.graph.neg(s)];
                Some(shift.map_or(back, |shift| further(bench, shift, back)))
            }
        };
        self.list[axes] = super::axes::Axes { parent: before, turned: about(bench, axis, bend, shift) };
    }

    fn depth(&self, axes: usize) -> usize {
        let (mut place, mut depth) = (axes, 0);
        while place > 0 {
            place = self.list[place].parent;
            depth += 1;
        }
        depth
    }

    /// The angle by which axes are turned against others about one axis, over any number of joints, and the constant shift beyond it.
    fn whole_angle(
        &self,
        bench: &mut Workbench,
        axes: usize,
        other: usize,
        about: usize,
    ) -> Option<(ExprId, Option<Shift>)> {
        let mut place = axes;
        let mut whole = bench.graph.zero();
        let mut beyond: Option<Shift> = None;
        while place != other {
            let Turned::About { axis, angle: Some(angle), shift, .. } = self.list[place].turned else {
                return None;
            };
            if axis != about || place == 0 {
                return None;
            }
            whole = bench.graph.add(whole, angle);
            beyond = match (beyond, shift) {
                (Some(beyond), Some(shift)) => Some(further(bench, beyond, shift)),
                (beyond, shift) => beyond.or(shift),
            };
            place = self.list[place].parent;
        }
        Some((whole, beyond))
    }
}
