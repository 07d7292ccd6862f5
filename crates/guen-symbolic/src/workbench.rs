//! What every stage of the derivation works with: the graph, the zero test, and tidying with a memory.

use crate::algebra::FastMap;
use crate::algebra::{ExprId, Flow, Graph};
use crate::normal::{Limits, normal_form};
use crate::zero::{Verdict, ZeroTest};

/// The graph together with what answers questions about it.
pub struct Workbench {
    /// The expressions.
    pub graph: Graph,
    /// The zero test.
    pub zero: ZeroTest,
    tidied: FastMap<ExprId, ExprId>,
    limits: Limits,
}

impl Workbench {
    /// A workbench around a graph.
    pub fn new(graph: Graph) -> Self {
        Workbench { graph, zero: ZeroTest::new(), tidied: FastMap::default(), limits: Limits::default() }
    }

    /// The expression in normal form where that is small, zero if it is proved to vanish, else as it is.
    pub fn tidy(&mut self, e: ExprId) -> ExprId {
        if self.graph.as_number(e).is_some() || self.graph.as_symbol(e).is_some() {
            return e;
        }
        if let Some(known) = self.tidied.get(&e) {
            return *known;
        }
        let tidy = if self.vanishes(e) {
            self.graph.zero()
        } else {
            normal_form(&mut self.graph, e, &self.limits).unwrap_or(e)
        };
        self.tidied.insert(e, tidy);
        self.tidied.insert(tidy, tidy);
        tidy
    }

    /// Whether the expression is proved to be zero as a function of all its symbols.
    pub fn vanishes(&mut self, e: ExprId) -> bool {
        if self.graph.as_number(e).is_some() {
            return self.graph.is_zero(e);
        }
        self.zero.verdict(&mut self.graph, e) == Verdict::Zero
    }

    /// Whether the expression vanishes wherever the holonomic constraints hold.
    pub fn verdict_on_manifold(&mut self, e: ExprId) -> Verdict {
        if self.graph.as_number(e).is_some() {
            return if self.graph.is_zero(e) { Verdict::Zero } else { Verdict::Nonzero };
        }
        self.zero.verdict_on_manifold(&mut self.graph, e)
    }

    /// Zero if it is proved to vanish, else the expression as it is: cheaper than [`Workbench::tidy`].
    pub fn dropped(&mut self, e: ExprId) -> ExprId {
        if self.vanishes(e) { self.graph.zero() } else { e }
    }

    /// `sum a_i b_i`.
    pub fn dot(&mut self, a: &[ExprId], b: &[ExprId]) -> ExprId {
        let products: Vec<_> = a.iter().zip(b).map(|(a, b)| self.graph.mul(*a, *b)).collect();
        self.graph.sum(products)
    }

    /// The derivative of `e` by a symbol; for many derivatives by one symbol keep a [`Flow`].
    pub fn partial(&mut self, e: ExprId, symbol: ExprId) -> ExprId {
        Flow::partial(&self.graph, symbol).of(&mut self.graph, e)
    }
}
