//! Expressions drawn at random, of every kind of node, with names that look like each other.

use guen_symbolic::{ExprId, Function, Graph, Rational, Role};

use super::names::{ALIKE, Scope};
use crate::random_declarations::draw::Draw;

/// A graph with a symbol for each name.
pub fn world() -> (Graph, Vec<ExprId>, Scope) {
    let mut graph = Graph::new();
    let mut scope = Scope::default();
    let roles = [Role::Constant, Role::Coordinate, Role::Coordinate, Role::QuasiVelocity];
    let mut symbols = Vec::new();
    for (i, name) in ALIKE.iter().enumerate() {
        let role = roles[i % roles.len()];
        let mut add = |name: &str, role: Role| {
            let e = graph.symbol(name, role);
            scope.add(name, e);
            symbols.push(e);
        };
        add(name, role);
        match role {
            Role::Coordinate => add(&format!("dot({name})"), Role::Velocity),
            Role::QuasiVelocity => add(&format!("{name}'"), Role::QuasiAcceleration),
            _ => {}
        }
    }
    scope.add("pi", graph.pi());
    (graph, symbols, scope)
}

/// A number that is not zero.
fn number(draw: &mut Draw) -> Rational {
    let sign = if draw.once_in(2) { -1 } else { 1 };
    match draw.below(4) {
        0 => Rational::integer(sign),
        1 => Rational::new(sign * draw.between(1, 9) as i64, draw.between(1, 9) as i64),
        _ => Rational::integer(sign * draw.between(1, 9) as i64),
    }
}

/// An expression.
pub fn expression(draw: &mut Draw, graph: &mut Graph, symbols: &[ExprId], depth: usize) -> ExprId {
    if depth == 0 || draw.once_in(8) {
        return if draw.once_in(6) { graph.number(number(draw)) } else { draw.pick(symbols) };
    }
    let part = |draw: &mut Draw, graph: &mut Graph| expression(draw, graph, symbols, depth - 1);
    match draw.below(12) {
        0..3 => {
            let terms: Vec<_> = (0..draw.between(1, 4)).map(|_| (part(draw, graph), number(draw))).collect();
            graph.linear(&terms)
        }
        3..6 => {
            let mut factors = Vec::new();
            for _ in 0..draw.between(1, 4) {
                let (base, k) = (part(draw, graph), draw.pick(&[1, 1, 1, 2, 3, -1, -1, -2]));
                if k > 0 || !graph.is_zero(base) {
                    factors.push((base, k));
                }
            }
            graph.product(&factors)
        }
        6 => {
            let (y, x) = (part(draw, graph), part(draw, graph));
            // Not of zero and zero.
            let x = graph.product(&[(x, 2)]);
            let two = graph.number(2);
            let x = graph.add(x, two);
            graph.atan2(y, x)
        }
        7 => {
            let e = part(draw, graph);
            let square = graph.powi(e, 2);
            let shift = graph.number(Rational::new(1, draw.between(1, 5) as i64));
            let positive = graph.add(square, shift);
            let root = graph.root(positive, draw.pick(&[2, 2, 3, 4]));
            graph.powi(root, draw.pick(&[1, 1, 2, -1, -3]))
        }
        8 | 9 => {
            let e = part(draw, graph);
            graph.keep(e)
        }
        _ => {
            let e = part(draw, graph);
            // Quotients of sine and cosine are tangents.
            if draw.once_in(4) {
                let (s, c) = graph.sin_cos(e);
                let (up, down) = if draw.once_in(2) { (s, c) } else { (c, s) };
                if !graph.is_zero(down) {
                    return graph.product(&[(up, draw.pick(&[1, 2, 3])), (down, draw.pick(&[-1, -2, -3]))]);
                }
            }
            let function = draw.pick(&[
                Function::Sin,
                Function::Cos,
                Function::Asin,
                Function::Acos,
                Function::Atan,
                Function::Exp,
                Function::Ln,
                Function::Sinh,
                Function::Cosh,
                Function::Tanh,
                Function::Abs,
                Function::Sign,
            ]);
            // Where there is a value.
            let argument = match function {
                Function::Asin | Function::Acos => graph.scale(draw.pick(symbols), &Rational::new(1, 9)),
                Function::Ln => {
                    let square = graph.powi(e, 2);
                    graph.add(square, graph.one())
                }
                _ => e,
            };
            graph.function(function, argument)
        }
    }
}
