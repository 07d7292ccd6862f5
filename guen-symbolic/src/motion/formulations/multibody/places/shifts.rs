//! Constant angles by which the axes of links are turned beyond those of their joints, so that few constant turns are left between
//! joints.
//!
//! Two joints of a link that are about any axes have a common normal. In axes with that as a coordinate axis one constant turn about
//! it, the twist of the link, leads from one joint to the other. The turns about the axes of the joints themselves are added to
//! their angles: `cos(q + a)` takes three operations, and the turn of a vector takes six.

use super::rotations::{Matrix, Shift, Vector, applied_back, product, rotation, rotation_by, transposed};
use crate::algebra::ExprId;
use crate::motion::graph::{SystemGraph, Turn};
use crate::workbench::Workbench;
use crate::zero::field;

/// The turn of axes against their parent's.
#[derive(Clone, Debug)]
pub(in crate::motion) enum Turned {
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
        /// Cosine and sine of a constant angle by which the axes are turned beyond that angle.
        shift: Option<Shift>,
    },
    /// Axes turned by any rotation.
    By {
        /// The rotation matrix from these axes to the parent's.
        matrix: Matrix,
        /// The angular velocity against the parent, in these axes, linear in the velocities.
        spin: Vector,
    },
}

/// The axes of the joints that a frame carries, on frames that are turned by constants too, in the frame.
pub(super) fn joint_axes(bench: &mut Workbench, system: &SystemGraph, index: usize) -> Vec<Vector> {
    let frames = system.frames();
    let mut found = Vec::new();
    // The matrix from the axes of each frame that is turned by constants to those of the frame.
    let mut fixed: Vec<(usize, Option<Matrix>)> = vec![(index, None)];
    for (place, child) in frames.iter().enumerate().skip(index + 1) {
        let Turn::About { axis, angle } = &child.turn else { continue };
        let Some((_, matrix)) = fixed.iter().find(|(known, _)| *known == child.parent.index()) else {
            continue;
        };
        let matrix = *matrix;
        if bench.graph.roles(*angle).is_constant() {
            let turn = rotation(bench, axis, *angle);
            let turn = matrix.map_or(turn, |matrix| product(bench, &matrix, &turn));
            fixed.push((place, Some(turn)));
        } else {
            let back = matrix.map(|matrix| transposed(&matrix));
            found.push(back.map_or(*axis, |back| applied_back(bench, &back, axis)));
        }
    }
    found
}

/// The constant turn about an axis after which the axes of joints are coordinate axes, or in coordinate planes, with the fewest
/// constant turns.
pub(super) fn shortest(bench: &mut Workbench, k: usize, joints: &[Vector]) -> Option<Shift> {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let turns = |bench: &mut Workbench, shift: Option<Shift>| -> usize {
        let seen = joints.iter().map(|v| match shift {
            None => *v,
            Some(shift) => {
                let matrix = rotation_by(bench, k, shift);
                applied_back(bench, &matrix, v)
            }
        });
        let seen: Vec<Vector> = seen.collect();
        let turns = seen.iter().map(|v| v.iter().filter(|e| !bench.vanishes(**e)).count() - 1);
        turns.sum()
    };
    let mut best = (turns(bench, None), None);
    for v in joints {
        let Some(shift) = direction(bench, [v[i], v[j]], v[k]) else { continue };
        let own = turns(bench, Some(shift));
        if own < best.0 {
            best = (own, Some(shift));
        }
    }
    best.1
}

/// The direction of what a unit vector has across an axis, where its length is the root of a number. Roots of other constants exist at
/// some points modulo the prime only, and those of some numbers at none.
fn direction(bench: &mut Workbench, across: [ExprId; 2], along: ExprId) -> Option<Shift> {
    let graph = &mut bench.graph;
    let square = graph.mul(along, along);
    let one = graph.one();
    let square = graph.sub(one, square);
    let square = bench.tidy(square);
    let number = bench.graph.as_number(square).filter(|square| !square.is_zero() && !square.is_negative())?;
    field::sqrt(field::residue(number)?)?;
    let length = bench.graph.sqrt(square);
    Some(across.map(|e| {
        let e = bench.graph.div(e, length);
        bench.tidy(e)
    }))
}

/// The coordinate axis that a unit vector is, and whether it points the other way.
pub(super) fn coordinate_axis(bench: &mut Workbench, v: &Vector) -> Option<(usize, bool)> {
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

/// Constant turns after which a unit vector is a coordinate axis, and that axis.
pub(super) fn upright(bench: &mut Workbench, v: &Vector) -> Option<(Vec<Turned>, usize)> {
    let about = |axis: usize, turn: Shift| Turned::About { axis, turn, angle: None, shift: None };
    if let Some(i) = (0..3).find(|i| bench.vanishes(v[*i])) {
        // In a coordinate plane: v = (v_j, v_k), and the k-th axis is turned onto it about the i-th.
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        return Some((vec![about(i, [v[k], bench.graph.neg(v[j])])], k));
    }
    // Into a coordinate plane first.
    let level = (0..3).find_map(|k| {
        let across = [v[(k + 1) % 3], v[(k + 2) % 3]];
        Some((k, direction(bench, across, v[k])?))
    });
    let Some((k, shift)) = level else { return shortest_turn(bench, v) };
    let matrix = rotation_by(bench, k, shift);
    let level = applied_back(bench, &matrix, v);
    let (turns, axis) = upright(bench, &level)?;
    Some(([vec![about(k, shift)], turns].concat(), axis))
}

/// The rotation that takes a coordinate axis `e_k` to a unit vector `v` the shortest way, `1 + [w] + [w]^2/(1 + v_k)` with `w = e_k x v`.
fn shortest_turn(bench: &mut Workbench, v: &Vector) -> Option<(Vec<Turned>, usize)> {
    let (zero, one) = (bench.graph.zero(), bench.graph.one());
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
    (matrix[i][i], matrix[j][j]) = (entry(i, i), entry(j, j));
    matrix[i][j] = entry(i, j);
    matrix[j][i] = matrix[i][j];
    for a in [i, j] {
        matrix[a][k] = v[a];
        matrix[k][a] = graph.neg(v[a]);
    }
    matrix[k][k] = v[k];
    Some((vec![Turned::By { matrix, spin: [zero; 3] }], k))
}

#[cfg(test)]
mod tests {
    use super::super::axes::AllAxes;
    use super::*;
    use crate::algebra::{Graph, Rational, Role};
    use crate::motion::graph::FrameId;
    use crate::zero::evaluate_f64;

    /// Unit vectors, two of them with a root: numerators below the root of the denominator.
    const AXES: [([i64; 3], i64); 6] =
        [([2, 1, -2], 9), ([1, 2, 2], 9), ([0, 1, -1], 2), ([1, 1, 1], 3), ([0, 0, -1], 1), ([3, 0, 4], 25)];

    /// A chain of joints about oblique axes, with further joints on its second frame.
    fn graph_of(bench: &mut Workbench, beside: &[usize]) -> (SystemGraph, Vec<FrameId>, Vec<ExprId>) {
        let mut structure = SystemGraph::new(&bench.graph);
        let (mut frames, mut angles) = (vec![FrameId::WORLD], Vec::new());
        let chain = (0..AXES.len()).map(|place| (place, place));
        for (joint, (place, parent)) in chain.chain(beside.iter().map(|place| (*place, 2))).enumerate() {
            let angle = bench.graph.symbol(&format!("q{joint}"), Role::Coordinate);
            let (numerators, square) = AXES[place];
            let square = bench.graph.number(Rational::integer(square));
            let length = bench.graph.sqrt(square);
            let axis = numerators.map(|n| {
                let n = bench.graph.number(Rational::integer(n));
                bench.graph.div(n, length)
            });
            let frame = structure.turned(frames[parent], Turn::About { axis, angle });
            frames.push(frame);
            angles.push(angle);
        }
        (structure, frames, angles)
    }

    /// The matrix from axes to the world's.
    fn to_world(bench: &mut Workbench, all: &AllAxes, axes: usize) -> Matrix {
        let own = match all.list[axes].turned {
            Turned::World => {
                let unit = [bench.graph.one(), bench.graph.zero()];
                return rotation_by(bench, 0, unit);
            }
            Turned::About { axis, turn, .. } => rotation_by(bench, axis, turn),
            Turned::By { matrix, .. } => matrix,
        };
        let before = to_world(bench, all, all.list[axes].parent);
        product(bench, &before, &own)
    }

    #[test]
    fn joints_about_any_axes_are_one_constant_turn_apart() {
        for beside in [&[][..], &[3, 5]] {
            let mut bench = Workbench::new(Graph::new());
            let (structure, frames, angles) = graph_of(&mut bench, beside);
            let all = AllAxes::new(&mut bench, &structure).expect("the axes are numbers");
            let own = |axes: usize| matches!(all.list[axes].turned, Turned::About { angle: Some(_), .. });
            let (joints, constant): (Vec<usize>, Vec<usize>) =
                (1..all.list.len()).partition(|axes| own(*axes));
            assert_eq!(joints.len(), AXES.len() + beside.len());
            // A joint beside may need two turns; one in the world is about any axis.
            let most = AXES.len() - 1 + 2 * beside.len();
            assert!(constant.len() <= most + 2, "{} constant turns", constant.len());
            // The frames are where Rodrigues' formula has them.
            for (joint, frame) in frames.iter().enumerate().skip(1) {
                let axes = all.of(*frame);
                let mut found = to_world(&mut bench, &all, axes);
                if let Some(base) = all.base(*frame).copied() {
                    let back = transposed(&base);
                    found = product(&mut bench, &found, &back);
                }
                let unit = [bench.graph.one(), bench.graph.zero()];
                let mut expected = rotation_by(&mut bench, 0, unit);
                for turn in structure.turns(*frame) {
                    let Turn::About { axis, angle } = turn else { unreachable!() };
                    let own = rotation(&mut bench, &axis, angle);
                    expected = product(&mut bench, &expected, &own);
                }
                let value = |symbol| {
                    let place = angles.iter().position(|q| bench.graph.as_symbol(*q) == Some(symbol));
                    0.3 + 0.7 * place.expect("an angle") as f64
                };
                for (a, b) in found.iter().flatten().zip(expected.iter().flatten()) {
                    let values = evaluate_f64(&bench.graph, &[*a, *b], &value);
                    assert!((values[0] - values[1]).abs() < 1e-13, "frame {joint}: {values:?}");
                }
            }
        }
    }
}
