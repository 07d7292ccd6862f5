//! Vectors and matrices of expressions in the axes of a link, every component kept whole: it has several users.

use crate::algebra::{ExprId, Graph};

pub(super) type Vector = [ExprId; 3];

/// Row by row.
pub(super) type Matrix = [Vector; 3];

pub(super) fn zero(graph: &Graph) -> Vector {
    [graph.zero(); 3]
}

pub(super) fn identity(graph: &Graph) -> Matrix {
    let (zero, one) = (graph.zero(), graph.one());
    [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
}

pub(super) fn vanishes(graph: &Graph, v: &Vector) -> bool {
    v.iter().all(|e| graph.is_zero(*e))
}

/// The components in an order of their own: `f(i, i + 1, i + 2)` modulo three.
fn cyclic(mut f: impl FnMut(usize, usize, usize) -> ExprId) -> Vector {
    [f(0, 1, 2), f(1, 2, 0), f(2, 0, 1)]
}

pub(super) fn kept(graph: &mut Graph, v: Vector) -> Vector {
    v.map(|e| graph.keep(e))
}

pub(super) fn dot(graph: &mut Graph, a: &Vector, b: &Vector) -> ExprId {
    let products = [0, 1, 2].map(|i| graph.mul(a[i], b[i]));
    graph.sum(products)
}

pub(super) fn cross(graph: &mut Graph, a: &Vector, b: &Vector) -> Vector {
    cyclic(|_, j, k| {
        let (plus, minus) = (graph.mul(a[j], b[k]), graph.mul(a[k], b[j]));
        graph.sub(plus, minus)
    })
}

/// The sum of the vectors.
pub(super) fn sum<const K: usize>(graph: &mut Graph, vectors: [&Vector; K]) -> Vector {
    [0, 1, 2].map(|i| graph.sum(vectors.iter().map(|v| v[i])))
}

pub(super) fn minus(graph: &mut Graph, a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| graph.sub(a[i], b[i]))
}

pub(super) fn scaled(graph: &mut Graph, a: ExprId, v: &Vector) -> Vector {
    v.map(|e| graph.mul(a, e))
}

pub(super) fn transposed(m: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i]))
}

/// `M v`.
pub(super) fn applied(graph: &mut Graph, m: &Matrix, v: &Vector) -> Vector {
    [0, 1, 2].map(|i| dot(graph, &m[i], v))
}

/// `M^T v`.
pub(super) fn applied_back(graph: &mut Graph, m: &Matrix, v: &Vector) -> Vector {
    applied(graph, &transposed(m), v)
}

/// `A B`.
pub(super) fn product(graph: &mut Graph, a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| dot(graph, &a[i], &columns[k])))
}

/// The vector `v` of a matrix that is `[v]x` but for its symmetric part, which is left out.
pub(super) fn axial(graph: &mut Graph, m: &Matrix) -> Vector {
    cyclic(|_, j, k| {
        let difference = graph.sub(m[k][j], m[j][k]);
        graph.scale(difference, &crate::algebra::Rational::new(1, 2))
    })
}
