//! Expressions as tapes: evaluation of graph nodes in any [`Scalar`], without the library's own evaluator.

use std::collections::BTreeMap;

use guen_symbolic::{ExprId, Function, Graph, Node};

use crate::scalar::Scalar;

enum Op {
    Constant(f64),
    /// The position of a symbol in the point.
    Symbol(usize),
    Sum(f64, Vec<(usize, f64)>),
    Product(Vec<(usize, i32)>),
    Sine(usize),
    Cosine(usize),
}

/// The steps that compute some expressions.
pub struct Tape {
    ops: Vec<Op>,
    roots: Vec<usize>,
}

impl Tape {
    pub fn new(graph: &Graph, roots: &[ExprId]) -> Self {
        let listed = graph.reachable(roots, |_| false);
        let place: BTreeMap<ExprId, usize> = listed.iter().enumerate().map(|(k, id)| (*id, k)).collect();
        let ops = listed
            .iter()
            .map(|id| match graph.node(*id) {
                Node::Number(value) => Op::Constant(value.to_f64()),
                Node::Pi => Op::Constant(std::f64::consts::PI),
                Node::Symbol(symbol) => Op::Symbol(symbol.index()),
                Node::Sum { constant, terms } => Op::Sum(
                    constant.to_f64(),
                    terms.iter().map(|(term, c)| (place[term], c.to_f64())).collect(),
                ),
                Node::Product(factors) => {
                    Op::Product(factors.iter().map(|(base, e)| (place[base], *e)).collect())
                }
                Node::Function(Function::Sin, x) => Op::Sine(place[x]),
                Node::Function(Function::Cos, x) => Op::Cosine(place[x]),
                // Of numbers alone.
                Node::Function(Function::Root(2), x) => match graph.node(*x) {
                    Node::Number(value) => Op::Constant(value.to_f64().sqrt()),
                    other => panic!("drawn systems have no root of {other:?}"),
                },
                Node::Kept(x) => Op::Sum(0.0, vec![(place[x], 1.0)]),
                other => panic!("drawn systems have no {other:?}"),
            })
            .collect();
        Tape { ops, roots: roots.iter().map(|id| place[id]).collect() }
    }

    /// The expressions at a point, which lists the values of all symbols in the order of their making.
    pub fn at<R: Scalar>(&self, point: &[R]) -> Vec<R> {
        let mut values: Vec<R> = Vec::with_capacity(self.ops.len());
        for op in &self.ops {
            let value = match op {
                Op::Constant(value) => R::constant(*value),
                Op::Symbol(index) => point[*index].clone(),
                Op::Sum(constant, terms) => terms
                    .iter()
                    .fold(R::constant(*constant), |sum, (term, c)| sum.plus(&values[*term].scaled(*c))),
                Op::Product(factors) => factors
                    .iter()
                    .map(|(base, e)| values[*base].power(*e))
                    .reduce(|product, factor| product.times(&factor))
                    .unwrap_or(R::constant(1.0)),
                Op::Sine(x) => values[*x].sine_cosine().0,
                Op::Cosine(x) => values[*x].sine_cosine().1,
            };
            values.push(value);
        }
        self.roots.iter().map(|root| values[*root].clone()).collect()
    }
}
