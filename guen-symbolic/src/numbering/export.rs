//! Numbered expressions as expressions of the graph.

use super::{Num, Numbering, Op};
use crate::algebra::{ExprId, Graph, Node};

impl Numbering {
    /// Returns the numbers below some numbers, children first, and how often each is used; not below constants.
    fn reached(&self, roots: &[Num]) -> (Vec<usize>, Vec<u32>) {
        let mut uses = vec![0_u32; self.ops.len()];
        let mut seen = vec![false; self.ops.len()];
        let mut order = Vec::new();
        for root in roots {
            uses[root.index()] += 1;
            let mut stack = vec![(root.index(), false)];
            while let Some((index, done)) = stack.pop() {
                if done {
                    order.push(index);
                    continue;
                }
                if std::mem::replace(&mut seen[index], true) {
                    continue;
                }
                stack.push((index, true));
                if self.constant[index] {
                    continue;
                }
                for child in self.children(index).into_iter().flatten() {
                    uses[child.index()] += 1;
                    stack.push((child.index(), false));
                }
            }
        }
        (order, uses)
    }

    /// Returns the multiplications that some numbers take to compute, without what depends on constants alone.
    pub(crate) fn cost(&self, roots: &[Num]) -> usize {
        let (order, _) = self.reached(roots);
        let weight = |index: &usize| match self.ops[*index] {
            _ if self.constant[*index] => 0,
            Op::Expr(_) | Op::Function(..) => 0,
            Op::Sum(..) | Op::Product(..) => 1,
            Op::Quotient(..) => 4,
            Op::SquareRoot(_) => 6,
        };
        order.iter().map(weight).sum()
    }

    /// The expressions of the graph; what is used more than once is kept whole.
    pub(crate) fn export(&self, graph: &mut Graph, roots: &[Num]) -> Vec<ExprId> {
        let (order, uses) = self.reached(roots);
        let mut done: Vec<Option<ExprId>> = vec![None; self.ops.len()];
        for index in order {
            if self.constant[index] {
                let e = self.export_constant(graph, &mut done, index);
                done[index] = Some(e);
                continue;
            }
            let e = self.built(graph, &done, index);
            done[index] = Some(match uses[index] {
                0 | 1 => e,
                _ if self.is_over_a_pivot(index) => graph.keep_whole(e),
                _ => graph.keep(e),
            });
        }
        roots.iter().map(|root| signed(graph, &done, *root)).collect()
    }

    /// Whether an expression is a product with a quotient: an entry of a row over the pivot of an elimination, say, which one
    /// multiplication makes and each further row uses.
    fn is_over_a_pivot(&self, index: usize) -> bool {
        let is_quotient = |a: Num| matches!(self.ops[a.index()], Op::Quotient(..));
        matches!(self.ops[index], Op::Product(a, b) if is_quotient(a) || is_quotient(b))
    }

    fn export_constant(&self, graph: &mut Graph, done: &mut [Option<ExprId>], index: usize) -> ExprId {
        let mut stack = vec![index];
        while let Some(place) = stack.last().copied() {
            let pending: Vec<usize> = self
                .children(place)
                .into_iter()
                .flatten()
                .map(Num::index)
                .filter(|child| done[*child].is_none())
                .collect();
            if pending.is_empty() {
                stack.pop();
                done[place] = Some(self.built(graph, done, place));
            } else {
                stack.extend(pending);
            }
        }
        done[index].expect("it was the last one")
    }

    fn built(&self, graph: &mut Graph, done: &[Option<ExprId>], index: usize) -> ExprId {
        match self.ops[index] {
            Op::Expr(e) => e,
            Op::Function(e, arguments) => {
                let arguments: Vec<ExprId> =
                    arguments.into_iter().flatten().map(|a| signed(graph, done, a)).collect();
                match (graph.node(e).clone(), &arguments[..]) {
                    (Node::Function(function, _), [x]) => graph.function(function, *x),
                    (Node::Multivariate(function, _), arguments) => graph.multivariate(function, arguments),
                    _ => e,
                }
            }
            Op::Sum(a, b) => {
                let (a, b) = (signed(graph, done, a), signed(graph, done, b));
                graph.add(a, b)
            }
            Op::Product(a, b) => {
                let (a, b) = (signed(graph, done, a), signed(graph, done, b));
                graph.mul(a, b)
            }
            Op::Quotient(a, b) => {
                let (a, b) = (signed(graph, done, a), signed(graph, done, b));
                graph.div(a, b)
            }
            Op::SquareRoot(a) => {
                let a = signed(graph, done, a);
                graph.sqrt(a)
            }
        }
    }
}

fn signed(graph: &mut Graph, done: &[Option<ExprId>], a: Num) -> ExprId {
    let e = done[a.index()].expect("children come first");
    if a.is_negative() { graph.neg(e) } else { e }
}
