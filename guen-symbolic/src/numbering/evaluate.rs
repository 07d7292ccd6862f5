//! Values of numbered expressions at real points, where it matters whether a divisor may vanish.

use super::{Num, Numbering, Op};
use crate::algebra::{ExprId, Graph, SymbolId};
use crate::zero::evaluate_f64;

impl Numbering {
    /// The values of some numbers where the symbols have the values given.
    pub(crate) fn evaluate(
        &self,
        graph: &Graph,
        roots: &[Num],
        values: &dyn Fn(SymbolId) -> f64,
    ) -> Vec<f64> {
        // The expressions of the graph that they are made of.
        let mut is_met = vec![false; self.ops.len()];
        let mut stack: Vec<usize> = roots.iter().map(|root| root.index()).collect();
        let mut leaves: Vec<(usize, ExprId)> = Vec::new();
        while let Some(place) = stack.pop() {
            if std::mem::replace(&mut is_met[place], true) {
                continue;
            }
            match self.ops[place] {
                Op::Expr(e) | Op::Function(e, _) => leaves.push((place, e)),
                _ => stack.extend(self.children(place).iter().flatten().map(|child| child.index())),
            }
        }
        let expressions: Vec<ExprId> = leaves.iter().map(|(_, e)| *e).collect();
        let mut found: Vec<Option<f64>> = vec![None; self.ops.len()];
        for ((index, _), value) in leaves.iter().zip(evaluate_f64(graph, &expressions, values)) {
            found[*index] = Some(value);
        }
        let mut stack: Vec<usize> = roots.iter().map(|root| root.index()).collect();
        while let Some(place) = stack.last().copied() {
            if found[place].is_some() {
                stack.pop();
                continue;
            }
            let children = self.children(place);
            let pending: Vec<usize> =
                children.iter().flatten().map(|c| c.index()).filter(|c| found[*c].is_none()).collect();
            if !pending.is_empty() {
                stack.extend(pending);
                continue;
            }
            let at = |a: Num| {
                let value = found[a.index()].unwrap_or(f64::NAN);
                if a.is_negative() { -value } else { value }
            };
            found[place] = Some(match self.ops[place] {
                Op::Expr(_) | Op::Function(..) => f64::NAN,
                Op::Sum(a, b) => at(a) + at(b),
                Op::Product(a, b) => at(a) * at(b),
                Op::Quotient(a, b) => at(a) / at(b),
                Op::SquareRoot(a) => at(a).sqrt(),
            });
        }
        let value = |root: &Num| {
            let value = found[root.index()].unwrap_or(f64::NAN);
            if root.is_negative() { -value } else { value }
        };
        roots.iter().map(value).collect()
    }
}
