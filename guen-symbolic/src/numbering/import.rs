//! Expressions of the graph as numbered ones.

use super::{Num, Numbering, Op};
use crate::algebra::{ExprId, Function, Node, Rational, Role, Roles};
use crate::workbench::Workbench;
use crate::zero::field;

/// The roles of symbols that have no value of their own at a point, but the one that the motion gives them.
const MOVING: Roles = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiAcceleration));

impl Numbering {
    /// Says what a symbol stands for.
    pub(crate) fn define(&mut self, symbol: ExprId, value: Num) {
        self.imported.insert(symbol, value);
    }

    /// An expression of the graph. One that has the value of something numbered is that, without a further look.
    pub(crate) fn import(&mut self, bench: &mut Workbench, e: ExprId) -> Num {
        if let Some(known) = self.imported.get(&e) {
            return *known;
        }
        let number = self.numbered(bench, e);
        self.imported.insert(e, number);
        number
    }

    fn numbered(&mut self, bench: &mut Workbench, e: ExprId) -> Num {
        let roles = bench.graph.roles(e);
        let constant = roles.is_constant();
        let signs = bench.zero.has_signs(&bench.graph, e);
        let moves = roles.meets(MOVING);
        let residue = if moves || signs { None } else { self.at_point(bench, e) };
        if let Some(residue) = residue {
            if residue == 0 {
                return Num::ZERO;
            }
            if let Some(known) = self.with_residue(residue)
                && (self.is_constant(known) || !constant)
            {
                return known;
            }
            if constant {
                return self.push(Op::Expr(e), residue, true);
            }
        }
        match bench.graph.node(e).clone() {
            Node::Kept(x) => self.import(bench, x),
            Node::Sum { constant, terms } => {
                let constant = bench.graph.number(constant);
                let mut sum = self.import(bench, constant);
                for (term, c) in terms.iter() {
                    let term = self.import(bench, *term);
                    let term = self.times(bench, c, term);
                    sum = self.add(sum, term);
                }
                sum
            }
            Node::Product(factors) => {
                let (mut above, mut below) = (Num::ONE, Num::ONE);
                for (base, k) in factors.iter() {
                    let base = self.import(bench, *base);
                    let power = self.power(base, k.unsigned_abs());
                    let side = if *k > 0 { &mut above } else { &mut below };
                    *side = self.mul(*side, power);
                }
                self.div(above, below)
            }
            Node::Function(Function::Root(2), x) if moves || !signs => {
                let x = self.import(bench, x);
                self.sqrt(x)
            }
            // |x| is x at some points and -x at others: a value that no other expression has.
            _ if signs && !moves => {
                self.push(Op::Expr(e), field::mix(e.index() as u64) % field::PRIME, constant)
            }
            _ => match residue {
                Some(residue) => self.push(Op::Expr(e), residue, constant),
                None => self.fail(),
            },
        }
    }

    /// The value of an expression of the graph at the point.
    pub(crate) fn at_point(&mut self, bench: &mut Workbench, e: ExprId) -> Option<u64> {
        let (point, on_manifold) = self.point;
        let value = bench.zero.value_at(&mut bench.graph, point, e, on_manifold);
        if bench.zero.generation() != self.generation {
            // The point has moved.
            self.failed = true;
            return None;
        }
        value
    }

    /// A rational multiple.
    pub(crate) fn times(&mut self, bench: &mut Workbench, factor: &Rational, a: Num) -> Num {
        if factor.is_one() {
            return a;
        }
        let negative = factor.is_negative();
        let number = bench.graph.number(factor.abs());
        let Some(residue) = field::residue(&factor.abs()) else { return self.fail() };
        let factor = self.push(Op::Expr(number), residue, true);
        self.mul(factor, a).signed(negative)
    }

    fn power(&mut self, base: Num, exponent: u32) -> Num {
        let (mut result, mut square, mut left) = (Num::ONE, base, exponent);
        while left > 0 {
            if left & 1 == 1 {
                result = self.mul(result, square);
            }
            left >>= 1;
            if left > 0 {
                square = self.square(square);
            }
        }
        result
    }
}
