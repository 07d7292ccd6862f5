//! Rotations and their products as matrices of expressions.

use crate::algebra::ExprId;
use crate::workbench::Workbench;

/// Components that are functions of time and coordinates.
pub(super) type Vector = [ExprId; 3];
pub(in crate::motion) type Matrix = [Vector; 3];
/// Cosine and sine of a constant angle.
pub(super) type Shift = [ExprId; 2];

/// Cosine and sine of a sum of two angles.
pub(super) fn further(bench: &mut Workbench, [c, s]: [ExprId; 2], [d, t]: Shift) -> [ExprId; 2] {
    let minus = bench.graph.neg(t);
    let turn = [bench.dot(&[d, minus], &[c, s]), bench.dot(&[t, d], &[c, s])];
    turn.map(|e| if bench.graph.roles(e).is_constant() { bench.tidy(e) } else { e })
}

/// The rotation about a coordinate axis.
pub(super) fn rotation_by(bench: &mut Workbench, axis: usize, [c, s]: Shift) -> Matrix {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let (zero, one) = (bench.graph.zero(), bench.graph.one());
    let mut matrix = [[zero; 3]; 3];
    matrix[axis][axis] = one;
    (matrix[i][i], matrix[j][j]) = (c, c);
    (matrix[j][i], matrix[i][j]) = (s, bench.graph.neg(s));
    matrix
}

pub(super) fn transposed(m: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i]))
}

pub(super) fn product(bench: &mut Workbench, a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|k| {
            let entry = bench.dot(&a[i], &columns[k]);
            bench.tidy(entry)
        })
    })
}

/// `M^T v`.
pub(super) fn applied_back(bench: &mut Workbench, m: &Matrix, v: &Vector) -> Vector {
    transposed(m).map(|row| {
        let entry = bench.dot(&row, v);
        bench.tidy(entry)
    })
}

/// The rotation by an angle about a unit vector, `c 1 + (1 - c) a a^T + s [a]x`.
pub(super) fn rotation(bench: &mut Workbench, axis: &Vector, angle: ExprId) -> Matrix {
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
pub(super) fn simplified(bench: &Workbench, m: Matrix) -> Option<Matrix> {
    let graph = &bench.graph;
    let is_unit = (0..3).all(|i| (0..3).all(|k| m[i][k] == if i == k { graph.one() } else { graph.zero() }));
    (!is_unit).then_some(m)
}
