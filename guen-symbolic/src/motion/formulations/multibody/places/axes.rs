//! Axes: one set for all frames that turn together, each turned about a coordinate axis of its parent where that can be.
//!
//! A frame that is turned by constants alone has the axes of its parent, and so has the body in it, with constants that are
//! turned once. Where joints of a link are about other axes than its own, the link is given axes in which they are
//! coordinate axes, or lie in coordinate planes, if a turn about its own joint's axis does it (`shifts`).

use std::collections::{BTreeMap, BTreeSet};

use super::rotations::{
    Matrix, Shift, Vector, applied_back, further, product, rotation, rotation_by, simplified, transposed,
};
use super::shifts::{Turned, coordinate_axis, joint_axes, shortest, upright};
use crate::algebra::{AngleParts, ExprId, Rational};
use crate::motion::graph::{FrameId, SystemGraph, Turn};
use crate::workbench::Workbench;

/// A set of axes.
#[derive(Clone, Debug)]
pub(in crate::motion) struct Axes {
    /// The axes in which these are turned; older.
    pub(super) parent: usize,
    /// The turn against the parent.
    pub(in crate::motion) turned: Turned,
}

/// A turn of axes in any way, as it is declared.
#[derive(Clone, Debug)]
pub(super) struct DeclaredTurn {
    pub(super) axes: usize,
    /// The axes against which they are declared.
    pub(super) against: usize,
    /// The rotation matrix to these.
    pub(super) matrix: Matrix,
    /// The angular velocity against these, in their own axes.
    pub(super) spin: Vector,
}

/// A turn about one axis over any number of joints: from the oldest axes from which on all are about it.
#[derive(Clone, PartialEq, Eq)]
struct Whole {
    root: usize,
    axis: usize,
    /// The terms of the angle, by symbol: a sum of sums is no other angle.
    angle: AngleParts,
    shift: Option<Shift>,
}

/// All axes, and which of them each frame has.
pub(in crate::motion) struct AllAxes {
    /// The world's first.
    pub(in crate::motion) list: Vec<Axes>,
    /// The whole turn of each of them, as it is declared; none where it is no turn about an axis.
    wholes: Vec<Option<Whole>>,
    /// The frames along which bodies have places.
    with_places: BTreeSet<usize>,
    /// The axes of each frame, and the constant matrix that leads from components in them to those in the frame.
    frames: Vec<(usize, Option<Matrix>)>,
    /// The turns of general axes as they are declared.
    pub(super) general: Vec<DeclaredTurn>,
}

impl AllAxes {
    /// The axes of a graph's frames; `None` where a joint is about an axis of constants that may point anywhere.
    pub(super) fn new(bench: &mut Workbench, system: &SystemGraph) -> Option<Self> {
        let places =
            system.bodies.iter().filter_map(|body| body.center.as_ref()).flat_map(|place| &place.terms);
        let mut all = AllAxes {
            list: vec![Axes { parent: 0, turned: Turned::World }],
            wholes: vec![None],
            with_places: places.map(|(frame, _)| frame.index()).collect(),
            frames: vec![(0, None)],
            general: Vec::new(),
        };
        for index in 1..system.frames().len() {
            let frame = &system.frames()[index];
            let (parent, base) = all.frames[frame.parent.index()];
            let entry = match &frame.turn {
                Turn::About { axis, angle } if bench.graph.roles(*angle).is_constant() => {
                    // v_frame = R^T v_parent
                    let back = bench.graph.neg(*angle);
                    let turn = rotation(bench, axis, back);
                    let turn = base.map_or(turn, |base| product(bench, &turn, &base));
                    (parent, simplified(bench, turn))
                }
                Turn::About { axis, angle } => {
                    let own = base.as_ref().map_or(*axis, |base| applied_back(bench, base, axis));
                    all.turned_about(bench, (parent, base), own, *angle, (system, index))?
                }
                Turn::General { matrix, spin } => {
                    let matrix = base.as_ref().map_or(*matrix, |base| {
                        let back = transposed(base);
                        product(bench, &back, matrix)
                    });
                    let place = all.push(parent, Turned::By { matrix, spin: *spin }, None);
                    all.general.push(DeclaredTurn { axes: place, against: parent, matrix, spin: *spin });
                    (place, None)
                }
            };
            all.frames.push(entry);
        }
        Some(all)
    }

    fn push(&mut self, parent: usize, turned: Turned, whole: Option<Whole>) -> usize {
        self.list.push(Axes { parent, turned });
        self.wholes.push(whole);
        self.list.len() - 1
    }

    /// The axes that are turned about an axis of a parent: new ones, or where bodies have places along them those that are turned so already, by
    /// joints one after the other or by the sum of their angles at once.
    fn joint(
        &mut self,
        bench: &mut Workbench,
        parent: usize,
        axis: usize,
        (angle, shift): (ExprId, Option<Shift>),
        has_places: bool,
    ) -> usize {
        let own = bench.graph.linear_parts(angle);
        let whole = match &self.wholes[parent] {
            Some(before) if before.axis == axis => {
                let shift = match (before.shift, shift) {
                    (Some(before), Some(shift)) => Some(further(bench, before, shift)),
                    (before, shift) => before.or(shift),
                };
                Whole { root: before.root, axis, angle: joined(before.angle.iter().chain(&own)), shift }
            }
            _ => Whole { root: parent, axis, angle: joined(own.iter()), shift },
        };
        let is_known = |known: &Option<Whole>| has_places && known.as_ref() == Some(&whole);
        let known = self.wholes.iter().position(is_known);
        known.unwrap_or_else(|| self.push(parent, about(bench, axis, angle, shift), Some(whole)))
    }

    /// Axes of a frame that is turned about a constant vector of the parent's axes, and further by a constant angle.
    fn turned_about(
        &mut self,
        bench: &mut Workbench,
        (mut parent, mut base): (usize, Option<Matrix>),
        own: Vector,
        angle: ExprId,
        (system, index): (&SystemGraph, usize),
    ) -> Option<(usize, Option<Matrix>)> {
        let (axis, negative) = match coordinate_axis(bench, &own) {
            Some(found) => found,
            None => {
                // First the axis is made a coordinate axis, by constant turns.
                let Some((turns, axis)) = upright(bench, &own) else {
                    return self.turned_beyond(bench, (parent, base?), angle, (system, index));
                };
                for turned in turns {
                    let turn = match turned {
                        Turned::About { axis, turn, .. } => rotation_by(bench, axis, turn),
                        Turned::By { matrix, .. } => matrix,
                        Turned::World => continue,
                    };
                    parent = self.push(parent, turned, None);
                    base = Some(base.map_or(turn, |base| product(bench, &base, &turn)));
                }
                (axis, false)
            }
        };
        let ahead = self.absorbed(bench, system, index);
        let mut turned = |e: ExprId| if negative { bench.graph.neg(e) } else { e };
        let (own, ahead) = (turned(angle), ahead.map(&mut turned));
        // v_frame = base R(ahead) v_axes
        let (whole, shift) = match ahead {
            Some(ahead) => {
                let (s, c) = bench.graph.sin_cos(ahead);
                base = turned_further(bench, base, axis, [c, s]);
                (bench.graph.add(own, ahead), None)
            }
            None => {
                let joints: Vec<Vector> = joint_axes(bench, system, index)
                    .iter()
                    .map(|v| base.as_ref().map_or(*v, |base| applied_back(bench, base, v)))
                    .collect();
                let shift = shortest(bench, axis, &joints);
                if let Some(shift) = shift {
                    base = turned_further(bench, base, axis, shift);
                }
                (own, shift)
            }
        };
        // A direction alone is short along axes of its own: the heading of a wheel is a turn against the world.
        let has_places = self.with_places.contains(&index);
        let place = self.joint(bench, parent, axis, (whole, shift), has_places);
        Some((place, base.and_then(|base| simplified(bench, base))))
    }

    /// Axes of a frame that is turned beyond constant turns, about an axis that is a coordinate axis where it was declared: the first axes have
    /// these turns.
    fn turned_beyond(
        &mut self,
        bench: &mut Workbench,
        (parent, base): (usize, Matrix),
        angle: ExprId,
        (system, index): (&SystemGraph, usize),
    ) -> Option<(usize, Option<Matrix>)> {
        let Turn::About { axis, .. } = &system.frames()[index].turn else { return None };
        let spin = [bench.graph.zero(); 3];
        let parent = self.push(parent, Turned::By { matrix: transposed(&base), spin }, None);
        self.turned_about(bench, (parent, None), *axis, angle, (system, index))
    }

    /// The constant angle by which a frame's axes are turned further about its own axis, because a frame that is turned so
    /// has joints.
    fn absorbed(&self, bench: &mut Workbench, system: &SystemGraph, index: usize) -> Option<ExprId> {
        let frame = &system.frames()[index];
        let Turn::About { axis: own, .. } = &frame.turn else { return None };
        let frames = system.frames();
        let has_joints = |id: FrameId| {
            frames.iter().any(|child| {
                child.parent == id
                    && match &child.turn {
                        Turn::About { angle, .. } => !bench.graph.roles(*angle).is_constant(),
                        Turn::General { .. } => true,
                    }
            })
        };
        let mut found = None;
        for (place, child) in frames.iter().enumerate().skip(index + 1) {
            if child.parent.index() != index {
                continue;
            }
            let Turn::About { axis, angle } = &child.turn else { continue };
            if axis == own
                && bench.graph.roles(*angle).is_constant()
                && has_joints(system.id(place))
                && !has_joints(system.id(index))
            {
                found = Some(*angle);
                break;
            }
        }
        found
    }

    /// The axes of a frame.
    pub(super) fn of(&self, frame: FrameId) -> usize {
        self.frames[frame.index()].0
    }

    /// The constant matrix from components in the frame's axes to components in the frame, if they differ.
    pub(super) fn base(&self, frame: FrameId) -> Option<&Matrix> {
        self.frames[frame.index()].1.as_ref()
    }

    /// A vector of a frame in its axes.
    pub(super) fn vector(&self, bench: &mut Workbench, frame: FrameId, v: &Vector) -> Vector {
        match self.base(frame) {
            None => *v,
            Some(base) => applied_back(bench, base, v),
        }
    }

    /// A symmetric matrix of a frame, `xx, yy, zz, xy, yz, zx`, in its axes.
    pub(super) fn tensor(&self, bench: &mut Workbench, frame: FrameId, t: &[ExprId; 6]) -> [ExprId; 6] {
        let Some(base) = self.base(frame) else { return *t };
        let [xx, yy, zz, xy, yz, zx] = *t;
        let whole = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
        let right = product(bench, &whole, base);
        let back = transposed(base);
        let own = product(bench, &back, &right);
        [own[0][0], own[1][1], own[2][2], own[0][1], own[1][2], own[2][0]]
    }

    /// Whether axes are others or hang on them.
    pub(in crate::motion) fn hangs_on(&self, axes: usize, other: usize) -> bool {
        let mut place = axes;
        while place > other {
            place = self.list[place].parent;
        }
        place == other
    }
}

/// The terms of a sum of angles, each symbol once, in one order.
fn joined<'a>(terms: impl Iterator<Item = &'a (ExprId, Rational)>) -> AngleParts {
    let mut sum: BTreeMap<ExprId, Rational> = BTreeMap::new();
    for (e, c) in terms {
        let slot = sum.entry(*e).or_default();
        *slot = &*slot + c;
    }
    sum.into_iter().filter(|(_, c)| !c.is_zero()).collect()
}

pub(super) fn about(bench: &mut Workbench, axis: usize, angle: ExprId, shift: Option<Shift>) -> Turned {
    let (sine, cosine) = bench.graph.sin_cos(angle);
    let turn = shift.map_or([cosine, sine], |shift| further(bench, [cosine, sine], shift));
    Turned::About { axis, turn, angle: Some(angle), shift }
}

fn turned_further(bench: &mut Workbench, base: Option<Matrix>, axis: usize, shift: Shift) -> Option<Matrix> {
    let turn = rotation_by(bench, axis, shift);
    let turn = base.map_or(turn, |base| product(bench, &base, &turn));
    simplified(bench, turn)
}
