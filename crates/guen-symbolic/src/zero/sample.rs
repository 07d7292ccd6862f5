//! One random point modulo the prime, with the values of the nodes that were asked for.

use super::field::{self, PRIME, Point, add, inverse, mix, mul, neg, sub};
use super::table::{Op, Table};
use crate::algebra::{Bound, ExprId, FastMap, Function, Graph, SymbolId};

// What a draw is for: each purpose has its own stream.
const OF_SYMBOL: u64 = 1;
const OF_ANGLE: u64 = 2;
const OF_UNIT: u64 = 3;
const OF_PI: u64 = 4;
const OF_ATOM: u64 = 5;

/// A residue not yet computed, or one that does not exist: no residue is that large.
const UNSET: u64 = u64::MAX;
const POLE: u64 = u64::MAX - 1;

/// A random point.
#[derive(Debug, Default)]
pub(crate) struct Sample {
    seed: u64,
    /// Whether symbols without a promise are squares as well, so that more roots exist.
    squares: bool,
    generation: u32,
    /// Symbols with values other than their draw: those that a constraint determines.
    pub(crate) fixed: FastMap<SymbolId, u64>,
    values: Vec<u64>,
    points: Vec<Option<Point>>,
    units: Vec<Option<Option<u64>>>,
}

impl Sample {
    /// Every other point has squares for all symbols of unknown sign: there are roots of each then.
    pub(crate) fn new(number: u64) -> Self {
        Sample { seed: mix(number), squares: number % 2 == 1, ..Sample::default() }
    }

    fn draw(&self, purpose: u64, index: u64) -> u64 {
        mix(mix(self.seed ^ purpose) ^ index) % PRIME
    }

    /// The residue of a symbol: a square where the declaration says it is positive.
    pub(crate) fn symbol(&self, graph: &Graph, symbol: SymbolId) -> u64 {
        if let Some(value) = self.fixed.get(&symbol) {
            return *value;
        }
        let value = self.draw(OF_SYMBOL, symbol.index() as u64);
        match graph.symbol_info(symbol).bound {
            Bound::Free | Bound::NonZero if !self.squares => value,
            Bound::Free | Bound::NonZero => mul(value, value),
            Bound::Positive | Bound::NonNegative => mul(value, value),
            Bound::Negative | Bound::NonPositive => neg(mul(value, value)),
        }
    }

    /// The value at this point; `None` at a pole and where a root does not exist.
    pub(crate) fn value(&mut self, graph: &Graph, table: &Table, e: ExprId) -> Option<u64> {
        if self.generation != table.generation {
            self.generation = table.generation;
            self.values.clear();
            self.points.clear();
            self.units.clear();
        }
        if self.values.len() <= e.index() {
            self.values.resize(table.ops.len(), UNSET);
        }
        let mut stack = vec![e];
        while let Some(&id) = stack.last() {
            if self.values[id.index()] != UNSET {
                stack.pop();
                continue;
            }
            let before = stack.len();
            let mut pole = false;
            let mut need = |child: ExprId| match self.values[child.index()] {
                UNSET => stack.push(child),
                POLE => pole = true,
                _ => {}
            };
            match &table.ops[id.index()] {
                Op::Sum(_, terms) => terms.iter().for_each(|(term, _)| need(*term)),
                Op::Product(factors) => factors.iter().for_each(|(base, _)| need(*base)),
                Op::At(_, x) => need(*x),
                Op::Atan2(y, x) => [*y, *x].into_iter().for_each(need),
                Op::Constant(_) | Op::Pi | Op::Symbol(_) | Op::Of(..) => {}
            }
            if pole {
                stack.truncate(before - 1);
                self.values[id.index()] = POLE;
            } else if stack.len() == before {
                stack.pop();
                self.values[id.index()] = self.step(graph, table, &table.ops[id.index()]).unwrap_or(POLE);
            }
        }
        Some(self.values[e.index()]).filter(|value| *value != POLE)
    }

    /// The value of a node whose children are done and exist.
    fn step(&mut self, graph: &Graph, table: &Table, op: &Op) -> Option<u64> {
        let at = |id: &ExprId| self.values[id.index()];
        match op {
            Op::Constant(value) => *value,
            Op::Pi => Some(self.draw(OF_PI, 0)),
            Op::Symbol(symbol) => Some(self.symbol(graph, *symbol)),
            Op::Sum(constant, terms) => {
                Some(terms.iter().fold(*constant, |sum, (term, c)| add(sum, mul(*c, at(term)))))
            }
            Op::Product(factors) => {
                // One inversion for all denominators together.
                let (mut above, mut below) = (1, 1);
                for (base, e) in factors {
                    let power = field::pow(at(base), e.unsigned_abs().into());
                    let side = if *e < 0 { &mut below } else { &mut above };
                    *side = mul(*side, power);
                }
                if below == 1 { Some(above) } else { Some(mul(above, inverse(below)?)) }
            }
            Op::Of(function @ (Function::Sin | Function::Cos), argument) => {
                let point = self.point(table, *argument);
                Some(if *function == Function::Sin { point.sin } else { point.cos })
            }
            Op::Of(function, argument) => {
                let e = self.unit(table, *argument)?;
                let inverse = inverse(e)?;
                let half = PRIME.div_ceil(2);
                match function {
                    Function::Exp => Some(e),
                    Function::Sinh => Some(mul(sub(e, inverse), half)),
                    Function::Cosh => Some(mul(add(e, inverse), half)),
                    Function::Tanh => Some(mul(sub(e, inverse), field::inverse(add(e, inverse))?)),
                    _ => None,
                }
            }
            Op::At(Function::Root(q), x) => field::root(at(x), *q),
            Op::At(Function::Abs, x) => field::sqrt(mul(at(x), at(x))),
            Op::At(Function::Sign, x) => Some(match at(x) {
                0 => 0,
                x if field::is_residue(x) => 1,
                _ => PRIME - 1,
            }),
            Op::At(function, x) => Some(self.draw(OF_ATOM + function.code() * 256, at(x))),
            Op::Atan2(y, x) => Some(self.draw(OF_ATOM ^ mix(at(y)), at(x))),
        }
    }

    /// The point of the circle at an argument.
    fn point(&mut self, table: &Table, argument: u32) -> Point {
        if self.points.len() <= argument as usize {
            self.points.resize(table.arguments.len(), None);
        }
        if let Some(point) = self.points[argument as usize] {
            return point;
        }
        let whole = &table.arguments[argument as usize];
        let mut point = field::TURN.times(whole.turn);
        for &(monomial, n, d) in &whole.parts {
            let base = Point::from_half_tangent(self.draw(OF_ANGLE, monomial.into()));
            let lcm = table.lcms[monomial as usize];
            point = point.turn(base.times(i128::from(n) * i128::from(lcm / d)));
        }
        self.points[argument as usize] = Some(point);
        point
    }

    /// The exponential of an argument: always a square, so that its roots exist.
    fn unit(&mut self, table: &Table, argument: u32) -> Option<u64> {
        if self.units.len() <= argument as usize {
            self.units.resize(table.arguments.len(), None);
        }
        if let Some(unit) = self.units[argument as usize] {
            return unit;
        }
        let mut unit = Some(1);
        for &(monomial, n, d) in &table.arguments[argument as usize].parts {
            let base = self.draw(OF_UNIT, monomial.into());
            let lcm = table.lcms[monomial as usize];
            let power = field::unit_power(mul(base, base), i128::from(n) * i128::from(lcm / d));
            unit = unit.and_then(|unit| Some(mul(unit, power?)));
        }
        self.units[argument as usize] = Some(unit);
        unit
    }
}
