//! Finds the variables that an expression depends on as a function, whatever it is written in.

use crate::algebra::{ExprId, FastMap, Node, Rational, Substitution};
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// Answers whether expressions depend on symbols, with a memory.
///
/// An expression `f` does not depend on `x` if and only if `f(x) - f(x*)` vanishes for an independent twin `x*` of `x`:
/// one substitution and one zero test, where the derivative by `x` would be several times as large as `f`.
///
/// ```
/// use guen_symbolic::{Dependence, Graph, Role, Workbench};
/// let mut bench = Workbench::new(Graph::new());
/// let g = &mut bench.graph;
/// let (x, y) = (g.symbol("x", Role::Coordinate), g.symbol("y", Role::Coordinate));
/// // sin(x + y) - sin(x) cos(y) - cos(x) sin(y) + y is written in both and depends on y alone.
/// let sum = g.add(x, y);
/// let ((sx, cx), (sy, cy), s) = (g.sin_cos(x), g.sin_cos(y), g.sin(sum));
/// let (a, b) = (g.mul(sx, cy), g.mul(cx, sy));
/// let (a, b) = (g.neg(a), g.neg(b));
/// let f = g.sum(vec![s, a, b, y]);
/// let mut dependence = Dependence::default();
/// assert!(!dependence.depends(&mut bench, f, x));
/// assert!(dependence.depends(&mut bench, f, y));
/// ```
#[derive(Default)]
pub struct Dependence {
    twins: FastMap<ExprId, (ExprId, Substitution)>,
    known: FastMap<ExprId, FastMap<ExprId, bool>>,
    symbols: FastMap<ExprId, Vec<ExprId>>,
}

impl Dependence {
    /// The symbols that occur in an expression, as it is written.
    fn occurring(&mut self, bench: &Workbench, e: ExprId) -> &[ExprId] {
        self.symbols.or_insert_with(e, || {
            let graph = &bench.graph;
            graph.symbols_in(&[e]).into_iter().map(|symbol| graph.symbol_expr(symbol)).collect()
        })
    }

    /// Whether an expression depends on a symbol; `false` only where that is proved.
    pub fn depends(&mut self, bench: &mut Workbench, e: ExprId, symbol: ExprId) -> bool {
        if !self.occurring(bench, e).contains(&symbol) {
            return false;
        }
        if let Some(known) = self.known.get(&e).and_then(|known| known.get(&symbol)) {
            return *known;
        }
        let (_, twin) = self.twins.or_insert_with(symbol, || {
            let id = bench.graph.as_symbol(symbol).expect("dependence is on symbols");
            let (role, bound) = (bench.graph.symbol_info(id).role, bench.graph.symbol_info(id).bound);
            let twin = bench.graph.bounded_symbol("", role, bound);
            (twin, Substitution::new([(symbol, twin)]))
        });
        let moved = twin.of(&mut bench.graph, e);
        let difference = bench.graph.sub(e, moved);
        let depends = bench.zero.verdict(&mut bench.graph, difference) != Verdict::Zero;
        self.known.or_default(e).insert(symbol, depends);
        depends
    }

    /// An equal expression in which symbols that it does not depend on do not occur; where no number can stand in for
    /// one of them the expression is left with it.
    pub fn without_idle(&mut self, bench: &mut Workbench, e: ExprId, symbols: &[ExprId]) -> ExprId {
        let mut clean = e;
        for symbol in symbols {
            if !self.occurring(bench, clean).contains(symbol) || self.depends(bench, clean, *symbol) {
                continue;
            }
            // Any number will do at which nothing is divided by zero.
            for (n, d) in [(0, 1), (1, 1), (2, 1), (1, 2), (3, 1), (-1, 1), (1, 3)] {
                let number = bench.graph.number(Rational::new(n, d));
                let image = Substitution::new([(*symbol, number)]).of(&mut bench.graph, clean);
                let parts = bench.graph.reachable(&[image], |_| false);
                if parts.iter().any(|part| matches!(bench.graph.node(*part), Node::Undefined)) {
                    continue;
                }
                let difference = bench.graph.sub(clean, image);
                if bench.zero.verdict(&mut bench.graph, difference) == Verdict::Zero {
                    clean = image;
                    break;
                }
            }
        }
        clean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Graph, Role};

    #[test]
    fn a_number_at_which_nothing_is_divided_by_zero_stands_in() {
        let mut bench = Workbench::new(Graph::new());
        let g = &mut bench.graph;
        let (x, y) = (g.symbol("x", Role::Coordinate), g.symbol("y", Role::Coordinate));
        // (x^2 - x)/x - x + y is y - 1, and at x = 0 undefined.
        let square = g.powi(x, 2);
        let numerator = g.sub(square, x);
        let kept = g.keep(numerator);
        let quotient = g.div(kept, x);
        let difference = g.sub(quotient, x);
        let f = g.add(difference, y);
        let mut dependence = Dependence::default();
        assert!(!dependence.depends(&mut bench, f, x) && dependence.depends(&mut bench, f, y));
        let clean = dependence.without_idle(&mut bench, f, &[x, y]);
        let one = bench.graph.one();
        assert_eq!(clean, bench.graph.sub(y, one));
    }
}
