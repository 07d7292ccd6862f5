//! Costs of operations: exact counts of programs, and a quick estimate for expressions.

use crate::algebra::{ExprId, FastMap, Function, Graph, Node};

// Rough reciprocal throughputs in units of a multiplication, as measured on current x86-64 and ARM cores.
const DIVISION: u64 = 4;
const ROOT: u64 = 6;
const SINE_COSINE: u64 = 20;
const CALL: u64 = 25;

/// The operations of a program.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct OperationCount {
    /// Additions and subtractions.
    pub additions: u32,
    /// Multiplications.
    pub multiplications: u32,
    /// Divisions.
    pub divisions: u32,
    /// Changes of sign.
    pub negations: u32,
    /// Roots.
    pub roots: u32,
    /// Sines and cosines; both of one angle count once.
    pub sines: u32,
    /// Calls of all other elementary functions.
    pub calls: u32,
}

impl OperationCount {
    /// Additions, multiplications, divisions, negations and roots: everything but the elementary functions.
    pub fn operations(&self) -> u32 {
        self.additions + self.multiplications + self.divisions + self.negations + self.roots
    }

    /// Returns one figure to compare programs by, in units of a multiplication.
    pub fn weighted(&self) -> u64 {
        u64::from(self.additions + self.multiplications + self.negations)
            + u64::from(self.divisions) * DIVISION
            + u64::from(self.roots) * ROOT
            + u64::from(self.sines) * SINE_COSINE
            + u64::from(self.calls) * CALL
    }
}

/// An estimate of what expressions cost together, each shared node once; what depends on physical constants
/// alone is free, because it is computed once per system.
pub fn weighted_cost(graph: &Graph, roots: &[ExprId]) -> u64 {
    let nodes = graph.reachable(roots, |id| graph.roles(id).is_constant());
    let mut angles: FastMap<ExprId, ()> = FastMap::default();
    let mut cost = 0;
    for id in nodes {
        cost += match graph.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined | Node::Kept(_) => 0,
            Node::Sum { constant, terms } => sum_cost(graph, terms.len(), !constant.is_zero(), terms),
            Node::Product(factors) => product_cost(graph, factors),
            Node::Function(Function::Sin | Function::Cos, x) => match angles.insert(*x, ()) {
                None => SINE_COSINE,
                Some(()) => 0,
            },
            Node::Function(Function::Root(_), _) => ROOT,
            Node::Function(..) | Node::Multivariate(..) => CALL,
        };
    }
    cost
}

fn sum_cost(graph: &Graph, terms: usize, constant: bool, list: &[(ExprId, crate::algebra::Rational)]) -> u64 {
    // Constant terms are one prepared value; a rational coefficient is a multiplication unless it joins a constant factor.
    let state: Vec<_> = list.iter().filter(|(term, _)| !graph.roles(*term).is_constant()).collect();
    let constants = usize::from(constant || state.len() < terms);
    let scaled = state
        .iter()
        .filter(|(term, c)| !c.is_one() && !c.is_minus_one() && !has_constant_factor(graph, *term))
        .count();
    (state.len() + constants - 1 + scaled) as u64
}

fn has_constant_factor(graph: &Graph, id: ExprId) -> bool {
    matches!(graph.node(id), Node::Product(factors) if factors.iter().any(|(base, _)| graph.roles(*base).is_constant()))
}

fn product_cost(graph: &Graph, factors: &[(ExprId, i32)]) -> u64 {
    let (mut multiplications, mut parts, mut below) = (0_u64, 0_u64, 0_u64);
    let mut constant = false;
    for (base, e) in factors {
        if graph.roles(*base).is_constant() {
            constant = true;
            continue;
        }
        let n = e.unsigned_abs();
        multiplications += u64::from(n.ilog2() + n.count_ones() - 1);
        if *e > 0 {
            parts += 1;
        } else {
            below += 1;
        }
    }
    parts += u64::from(constant);
    multiplications + parts.saturating_sub(1) + below.saturating_sub(1) + if below > 0 { DIVISION } else { 0 }
}
