//! Expressions of the graph as numbered ones.

use super::{Num, Numbering, Op};
use crate::algebra::{ExprId, Function, Node, Rational, Role, Roles, mix};
use crate::workbench::Workbench;
use crate::zero::field;

/// The roles of symbols that have no value of their own at a point, but the one that the motion gives them.
const MOVING: Roles = Roles::of(Role::Velocity).or(Roles::of(Role::QuasiAcceleration));

/// The roles of symbols that places and velocities depend on.
const STATE: Roles = Roles::of(Role::Coordinate).or(Roles::of(Role::QuasiVelocity));

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
            if let Some(multiple) = self.multiple_of_known(bench, e, residue) {
                return multiple;
            }
        }
        match bench.graph.node(e).clone() {
            Node::Kept(x) => self.import(bench, x),
            Node::Sum { constant, terms } => {
                if let Some((place, others)) = self.place_in(bench, &terms) {
                    let number = bench.graph.number(constant);
                    let others = bench.graph.linear(&others);
                    let others = bench.graph.add(others, number);
                    let others = self.import(bench, others);
                    return self.add(place, others);
                }
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
            _ if signs && !moves => self.push(Op::Expr(e), mix(e.index() as u64) % field::PRIME, constant),
            _ => match residue {
                Some(residue) => match self.arguments(bench, e) {
                    Some(arguments) => self.push(Op::Function(e, arguments), residue, constant),
                    None => self.push(Op::Expr(e), residue, constant),
                },
                None => self.fail(),
            },
        }
    }

    /// Notes the number that an expression is a multiple of. Sums in products are divided by such numbers, so they are looked up as
    /// multiples of numbered expressions from now on.
    pub(crate) fn look_for_multiples(&mut self, bench: &mut Workbench, e: ExprId) {
        /// Of many expressions hardly one has another factor.
        const MOST_MULTIPLES: usize = 12;
        let (content, _) = bench.graph.split_content(e);
        if !content.is_one()
            && let Some(inverse) = content.recip()
            && self.multiples.len() < MOST_MULTIPLES
            && !self.multiples.contains(&inverse)
        {
            self.multiples.push(inverse);
        }
    }

    /// A sum as a multiple of something numbered.
    fn multiple_of_known(&mut self, bench: &mut Workbench, e: ExprId, residue: u64) -> Option<Num> {
        if self.multiples.is_empty()
            || !matches!(bench.graph.node(e), Node::Sum { terms, .. } if terms.len() > 1)
        {
            return None;
        }
        self.multiples.clone().into_iter().find_map(|factor| {
            let part = field::mul(residue, field::inverse(field::residue(&factor)?)?);
            let known = self.with_residue(part).filter(|known| !self.is_constant(*known))?;
            Some(self.times(bench, &factor, known))
        })
    }

    /// The terms of a sum that depend on the state, where their sum is numbered, and the others: the end of an arm stands beside the place
    /// that it is wanted at.
    fn place_in(
        &mut self,
        bench: &mut Workbench,
        terms: &[(ExprId, Rational)],
    ) -> Option<(Num, Vec<(ExprId, Rational)>)> {
        let moves = |(e, _): &(ExprId, Rational)| bench.graph.roles(*e).meets(STATE);
        let (place, others): (Vec<_>, Vec<_>) = terms.iter().cloned().partition(moves);
        if place.len() < 2 || others.is_empty() {
            return None;
        }
        let place = bench.graph.linear(&place);
        if bench.graph.roles(place).meets(MOVING) {
            return None;
        }
        let residue = self.at_point(bench, place)?;
        let known = self.with_residue(residue).or_else(|| self.multiple_of_known(bench, place, residue));
        known.map(|known| (known, others))
    }

    /// The arguments of a function, where one of them has the value of an operation that is numbered.
    fn arguments(&mut self, bench: &mut Workbench, e: ExprId) -> Option<[Option<Num>; 3]> {
        let children = bench.graph.children(e);
        let is_angle = matches!(bench.graph.node(e), Node::Function(Function::Sin | Function::Cos, _));
        if is_angle || children.len() > 3 {
            return None;
        }
        let mut is_operation = |child: &ExprId| {
            let residue = self.at_point(bench, *child)?;
            let known = self.with_residue(residue)?;
            Some(!matches!(self.ops[known.index()], Op::Expr(_) | Op::Function(..)))
        };
        if !children.iter().any(|child| is_operation(child) == Some(true)) {
            return None;
        }
        let mut arguments = [None; 3];
        for (argument, child) in arguments.iter_mut().zip(children) {
            *argument = Some(self.import(bench, child));
        }
        Some(arguments)
    }

    /// The value of an expression of the graph at the point.
    pub(crate) fn at_point(&mut self, bench: &mut Workbench, e: ExprId) -> Option<u64> {
        let (point, on_manifold) = self.point;
        let value = match self.roots {
            Some(_) => bench.zero.drawn_value_at(&bench.graph, point, e, on_manifold),
            None => bench.zero.value_at(&mut bench.graph, point, e, on_manifold),
        };
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
