//! Axes: one set for all frames that turn together, each turned about a coordinate axis of its parent where that can be.
//!
//! A frame that is turned by constants alone has the axes of its parent, and so has the body in it, with constants that are
//! turned once. Where joints of a link are about other axes than its own, the link is given axes in which they are
//! coordinate axes, if a turn about its own joint's axis does it.

use crate::algebra::ExprId;
use crate::motion::graph::{FrameId, SystemGraph, Turn};
use crate::workbench::Workbench;

/// Components that are functions of time and coordinates.
pub(super) type Vector = [ExprId; 3];
pub(super) type Matrix = [Vector; 3];

/// The turn of axes against their parent's.
#[derive(Clone, Debug)]
pub(super) enum Turned {
    /// The axes of the world.
    World,
    /// About a coordinate axis.
    About {
        /// The axis of the turn; 0 is the first.
        axis: usize,
        /// Cosine and sine of the angle.
        turn: [ExprId; 2],
        /// The angle, where it is not constant.
        angle: Option<ExprId>,
    },
    /// Axes turned by any rotation.
    By {
        /// The rotation matrix from these axes to the parent's.
        matrix: Matrix,
        /// The angular velocity against the parent, in these axes, linear in the velocities.
        spin: Vector,
    },
}

/// A set of axes.
#[derive(Clone, Debug)]
pub(super) struct Axes {
    /// The axes in which these are turned; older.
    pub(super) parent: usize,
    /// The turn against the parent.
    pub(super) turned: Turned,
}

/// All axes, and which of them each frame has.
pub(super) struct AllAxes {
    /// The world's first.
    pub(super) list: Vec<Axes>,
    /// The axes of each frame, and the constant matrix that leads from components in them to those in the frame.
    frames: Vec<(usize, Option<Matrix>)>,
}

impl AllAxes {
    /// The axes of a graph's frames; `None` where a joint is about an axis of constants that may point anywhere.
    pub(super) fn new(bench: &mut Workbench, system: &SystemGraph) -> Option<Self> {
        let mut all =
            AllAxes { list: vec![Axes { parent: 0, turned: Turned::World }], frames: vec![(0, None)] };
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
                    let ahead = all.absorbed(bench, system, index);
                    all.turned_about(bench, (parent, base), own, *angle, ahead)?
                }
                Turn::General { matrix, spin } => {
                    let matrix = base.as_ref().map_or(*matrix, |base| {
                        let back = transposed(base);
                        product(bench, &back, matrix)
                    });
                    (all.push(parent, Turned::By { matrix, spin: *spin }), None)
                }
            };
            all.frames.push(entry);
        }
        Some(all)
    }

    fn push(&mut self, parent: usize, turned: Turned) -> usize {
        self.list.push(Axes { parent, turned });
        self.list.len() - 1
    }

    /// Axes turned about a constant vector of the parent's axes, and further by a constant angle.
    fn turned_about(
        &mut self,
        bench: &mut Workbench,
        (parent, base): (usize, Option<Matrix>),
        own: Vector,
        angle: ExprId,
        ahead: Option<ExprId>,
    ) -> Option<(usize, Option<Matrix>)> {
        if let Some((axis, negative)) = coordinate_axis(bench, &own) {
            let mut turned = |e: ExprId| if negative { bench.graph.neg(e) } else { e };
            let (own, ahead) = (turned(angle), ahead.map(&mut turned));
            let whole = ahead.map_or(own, |ahead| bench.graph.add(own, ahead));
            let place = self.push(parent, about(bench, axis, whole));
            // v_frame = base R(ahead) v_axes
            let base = match ahead {
                None => base,
                Some(ahead) => {
                    let turn = rotation(bench, &unit(bench, axis), ahead);
                    let turn = base.map_or(turn, |base| product(bench, &base, &turn));
                    simplified(bench, turn)
                }
            };
            return Some((place, base));
        }
        // First the axis is made a coordinate axis, by a constant turn.
        let (constant, axis, turn) = upright(bench, &own)?;
        let middle = self.push(parent, constant);
        let place = self.push(middle, about(bench, axis, angle));
        let base = base.map_or(turn, |base| product(bench, &base, &turn));
        Some((place, simplified(bench, base)))
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
    pub(super) fn hangs_on(&self, axes: usize, other: usize) -> bool {
        let mut place = axes;
        while place > other {
            place = self.list[place].parent;
        }
        place == other
    }
}

fn about(bench: &mut Workbench, axis: usize, angle: ExprId) -> Turned {
    let (sine, cosine) = bench.graph.sin_cos(angle);
    Turned::About { axis, turn: [cosine, sine], angle: Some(angle) }
}

fn unit(bench: &Workbench, axis: usize) -> Vector {
    let mut unit = [bench.graph.zero(); 3];
    unit[axis] = bench.graph.one();
    unit
}

fn transposed(m: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i]))
}

fn product(bench: &mut Workbench, a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|k| {
            let entry = bench.dot(&a[i], &columns[k]);
            bench.tidy(entry)
        })
    })
}

/// `M^T v`.
fn applied_back(bench: &mut Workbench, m: &Matrix, v: &Vector) -> Vector {
    transposed(m).map(|row| {
        let entry = bench.dot(&row, v);
        bench.tidy(entry)
    })
}

/// The rotation by an angle about a unit vector, `c 1 + (1 - c) a a^T + s [a]x`.
fn rotation(bench: &mut Workbench, axis: &Vector, angle: ExprId) -> Matrix {
    let graph = &mut bench.graph;
    let (s, c) = graph.sin_cos(angle);
    let one = graph.one();
    let rest = graph.sub(one, c);
    let zero = graph.zero();
    let minus: Vector = axis.map(|e| graph.neg(e));
    let crossed = [[zero, minus[2], axis[1]], [axis[2], zero, minus[0]], [minus[1], axis[0], zero]];
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|k| {
            let outer = bench.graph.product(&[(rest, 1), (axis[i], 1), (axis[k], 1)]);
            let turning = bench.graph.mul(s, crossed[i][k]);
            let diagonal = if i == k { c } else { zero };
            let sum = bench.graph.sum([diagonal, outer, turning]);
            bench.tidy(sum)
        })
    })
}

/// `None` for the unit matrix.
fn simplified(bench: &Workbench, m: Matrix) -> Option<Matrix> {
    let graph = &bench.graph;
    let is_unit = (0..3).all(|i| (0..3).all(|k| m[i][k] == if i == k { graph.one() } else { graph.zero() }));
    (!is_unit).then_some(m)
}

/// The coordinate axis that a unit vector is, and whether it points the other way.
fn coordinate_axis(bench: &mut Workbench, v: &Vector) -> Option<(usize, bool)> {
    let axis = (0..3).find(|i| (0..3).all(|k| k == *i || bench.vanishes(v[k])))?;
    let one = bench.graph.one();
    let minus = bench.graph.neg(one);
    if v[axis] == one {
        Some((axis, false))
    } else if v[axis] == minus {
        Some((axis, true))
    } else {
        let difference = bench.graph.sub(v[axis], one);
        bench.vanishes(difference).then_some((axis, false))
    }
}

/// A constant rotation after which a unit vector is a coordinate axis, that axis, and the matrix of the rotation.
fn upright(bench: &mut Workbench, v: &Vector) -> Option<(Turned, usize, Matrix)> {
    let (zero, one) = (bench.graph.zero(), bench.graph.one());
    let level = (0..3).find(|i| bench.vanishes(v[*i]));
    Some(match level {
        Some(i) => {
            // In a coordinate plane: v = (v_j, v_k), and the k-th axis is turned onto it about the i-th.
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let mut matrix = [[zero; 3]; 3];
            matrix[i][i] = one;
            matrix[j][j] = v[k];
            matrix[k][k] = v[k];
            matrix[j][k] = v[j];
            matrix[k][j] = bench.graph.neg(v[j]);
            (Turned::About { axis: i, turn: [v[k], matrix[k][j]], angle: None }, k, matrix)
        }
        None => {
            // The rotation that takes e_k to v the shortest way: 1 + [w] + [w]^2/(1 + v_k), w = e_k x v.
            let k = (0..3).find(|k| bench.graph.as_number(v[*k]).is_some_and(|n| !n.is_negative()))?;
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let graph = &mut bench.graph;
            let below = graph.add(one, v[k]);
            let mut entry = |a: usize, b: usize| {
                let product = graph.product(&[(v[a], 1), (v[b], 1), (below, -1)]);
                let diagonal = if a == b { one } else { zero };
                graph.sub(diagonal, product)
            };
            let mut matrix = [[zero; 3]; 3];
            matrix[i][i] = entry(i, i);
            matrix[j][j] = entry(j, j);
            matrix[i][j] = entry(i, j);
            matrix[j][i] = matrix[i][j];
            for a in [i, j] {
                matrix[a][k] = v[a];
                matrix[k][a] = graph.neg(v[a]);
            }
            matrix[k][k] = v[k];
            (Turned::By { matrix, spin: [zero; 3] }, k, matrix)
        }
    })
}
