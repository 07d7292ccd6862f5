//! A linear function of velocity forms, by the sums that they have in common.

use super::sums::Relative;
use crate::algebra::{ExprId, FastMap, Node, Rational};
use crate::motion::quasi_velocities::velocity_forms::VELOCITIES;
use crate::workbench::Workbench;

/// A linear function of velocity forms: a component along an operator, or the value in a motion.
pub(super) struct Component<'a> {
    sums: &'a FastMap<ExprId, Relative>,
    /// The definitions of symbols that have no value of their own.
    definitions: &'a FastMap<ExprId, ExprId>,
    known: FastMap<ExprId, ExprId>,
    /// Whether what has no velocity in it counts.
    with_offsets: bool,
}

impl<'a> Component<'a> {
    pub(super) fn new(
        sums: &'a FastMap<ExprId, Relative>,
        definitions: &'a FastMap<ExprId, ExprId>,
        with_offsets: bool,
    ) -> Self {
        Component { sums, definitions, known: FastMap::default(), with_offsets }
    }

    /// Gives a symbol its value.
    pub(super) fn set(&mut self, symbol: ExprId, value: ExprId) {
        self.known.insert(symbol, value);
    }

    /// The value of a form; `None` where it is not affine as it is written, or has a symbol without a value.
    pub(super) fn of(&mut self, bench: &mut Workbench, e: ExprId) -> Option<ExprId> {
        let mut hidden = FastMap::default();
        self.evaluate(bench, e, &mut hidden)
    }

    /// Evaluates with one velocity, of which nothing is known yet, at zero.
    pub(super) fn without(&mut self, bench: &mut Workbench, velocity: ExprId, e: ExprId) -> Option<ExprId> {
        let mut hidden = FastMap::default();
        hidden.insert(velocity, bench.graph.zero());
        self.evaluate(bench, e, &mut hidden)
    }

    /// Evaluates an expression, and remembers its parts: those that depend on a hidden velocity in `hidden` only.
    fn evaluate(
        &mut self,
        bench: &mut Workbench,
        e: ExprId,
        hidden: &mut FastMap<ExprId, ExprId>,
    ) -> Option<ExprId> {
        let mut stack = vec![e];
        while let Some(e) = stack.pop() {
            if self.known.contains_key(&e) || hidden.contains_key(&e) {
                continue;
            }
            let below = self.below(bench, e)?;
            let open: Vec<ExprId> = below
                .iter()
                .copied()
                .filter(|e| !self.known.contains_key(e) && !hidden.contains_key(e))
                .collect();
            if !open.is_empty() {
                stack.push(e);
                stack.extend(open);
                continue;
            }
            let is_hidden = below.iter().any(|e| hidden.contains_key(e));
            let value = self.combined(bench, e, &*hidden);
            if is_hidden {
                hidden.insert(e, value);
            } else {
                self.known.insert(e, value);
            }
        }
        Some(hidden.get(&e).copied().unwrap_or_else(|| self.known[&e]))
    }

    /// Returns the operands of a value; `None` for an expression that is not affine as it is written.
    fn below(&self, bench: &Workbench, e: ExprId) -> Option<Vec<ExprId>> {
        let graph = &bench.graph;
        let moves = |e: &ExprId| graph.roles(*e).meets(VELOCITIES);
        if !moves(&e) {
            return Some(Vec::new());
        }
        match graph.node(e) {
            Node::Symbol(_) => self.definitions.get(&e).map(|value| vec![*value]),
            Node::Kept(x) => Some(vec![*x]),
            Node::Sum { terms, .. } => match self.sums.get(&e) {
                Some(Relative { parent, rest, .. }) => {
                    Some(rest.iter().map(|(e, _)| *e).filter(moves).chain([*parent]).collect())
                }
                None => Some(terms.iter().map(|(e, _)| *e).filter(moves).collect()),
            },
            Node::Product(factors) => {
                let mut moving = factors.iter().filter(|(base, _)| moves(base));
                match (moving.next(), moving.next()) {
                    (Some((base, 1)), None) => Some(vec![*base]),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The value of what all is known of.
    fn combined(&self, bench: &mut Workbench, e: ExprId, hidden: &FastMap<ExprId, ExprId>) -> ExprId {
        let moves = |bench: &Workbench, e: ExprId| bench.graph.roles(e).meets(VELOCITIES);
        let known = |e: &ExprId| hidden.get(e).copied().unwrap_or_else(|| self.known[e]);
        if !moves(bench, e) {
            return if self.with_offsets { e } else { bench.graph.zero() };
        }
        match bench.graph.node(e).clone() {
            Node::Sum { constant, terms } => {
                let relative = self.sums.get(&e);
                let (constant, own) = match relative {
                    Some(relative) => (relative.constant.clone(), &relative.rest[..]),
                    None => (constant, &terms[..]),
                };
                let mut parts: Vec<(ExprId, Rational)> = Vec::with_capacity(own.len() + 2);
                for (term, c) in own {
                    if moves(bench, *term) {
                        parts.push((known(term), c.clone()));
                    } else if self.with_offsets {
                        parts.push((*term, c.clone()));
                    }
                }
                if self.with_offsets {
                    parts.push((bench.graph.number(constant), Rational::ONE));
                }
                if let Some(relative) = relative {
                    parts.push((known(&relative.parent), relative.multiple.clone()));
                }
                let sum = bench.graph.linear(&parts);
                if relative.is_some() { bench.graph.keep(sum) } else { bench.keep_large(sum) }
            }
            Node::Product(factors) => {
                let all: Vec<(ExprId, i32)> = factors
                    .iter()
                    .map(|(base, k)| if moves(bench, *base) { (known(base), *k) } else { (*base, *k) })
                    .collect();
                bench.graph.product(&all)
            }
            Node::Kept(x) => known(&x),
            Node::Symbol(_) => bench.graph.keep(known(&self.definitions[&e])),
            _ => unreachable!("`below` has turned it away"),
        }
    }
}
