//! A random point modulo the prime, with the values of the nodes that were asked for.

use super::field::{self, PRIME, Point, add, inverse, mul, neg, sub};
use super::table::{Op, Table};
use crate::algebra::{ExprId, FastMap, Function, Graph, Multivariate, Node, SignBound, SymbolId, mix};

// What a draw is for: each purpose has its own stream.
const OF_SYMBOL: u64 = 1;
const OF_ANGLE: u64 = 2;
const OF_UNIT: u64 = 3;
const OF_PI: u64 = 4;
const OF_ATOM: u64 = 5;
const OF_BRANCH: u64 = 6;

/// The encoding of stored values: one not yet computed, one that does not exist, and residues from [`SET`] on.
const UNSET: u64 = 0;
const POLE: u64 = 1;
const SET: u64 = 2;

const MINUS_ONE: u64 = PRIME - 1;

fn draw(seed: u64, purpose: u64, index: u64) -> u64 {
    mix(mix(seed ^ purpose) ^ index) % PRIME
}

/// The square roots at a point where they are drawn for their radicands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnRoots {
    seed: u64,
}

impl DrawnRoots {
    /// The root of a radicand.
    pub(crate) fn of(self, radicand: u64) -> u64 {
        draw(self.seed, OF_ATOM + Function::Root(2).code() * 256, radicand)
    }
}

/// The order and the radicand of a root, which may be kept whole.
fn root(graph: &Graph, e: ExprId) -> Option<(u32, ExprId)> {
    match graph.node(e) {
        Node::Kept(x) => root(graph, *x),
        Node::Function(Function::Root(q), x) => Some((*q, *x)),
        _ => None,
    }
}

/// A random point.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sample {
    seed: u64,
    /// Whether symbols without a promise are squares as well, so that more roots exist.
    squares: bool,
    /// Whether symbols have any values, whatever is promised of them.
    is_unbound: bool,
    /// Whether roots, absolute values and signs are drawn for their arguments.
    has_drawn_roots: bool,
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

    /// A point at which positive symbols are no squares.
    pub(super) fn without_bounds(number: u64) -> Self {
        Sample { seed: mix(number), is_unbound: true, ..Sample::default() }
    }

    /// Returns the point without values.
    pub(crate) fn fresh(&self) -> Self {
        let Sample { seed, squares, is_unbound, has_drawn_roots, ref fixed, .. } = *self;
        Sample { seed, squares, is_unbound, has_drawn_roots, fixed: fixed.clone(), ..Sample::default() }
    }

    /// Returns the point without values, with numbers drawn for roots, absolute values and signs. What vanishes there does for any values
    /// of these, and so for the true ones; what does not may vanish all the same, as `(sqrt(x) + 1)^2 - x - 2 sqrt(x) - 1` does.
    pub(crate) fn with_drawn_roots(&self) -> Self {
        Sample { has_drawn_roots: true, ..self.fresh() }
    }

    /// Returns the point with a symbol at zero, given all nodes that depend on it.
    pub(crate) fn without(&self, symbol: SymbolId, dependent: &[ExprId]) -> Self {
        let mut sample = self.clone();
        sample.fixed.insert(symbol, 0);
        for id in dependent {
            if let Some(value) = sample.values.get_mut(id.index()) {
                *value = UNSET;
            }
        }
        sample
    }

    fn draw(&self, purpose: u64, index: u64) -> u64 {
        draw(self.seed, purpose, index)
    }

    /// The square roots at the point with drawn roots.
    pub(crate) fn roots(&self) -> DrawnRoots {
        DrawnRoots { seed: self.seed }
    }

    /// The residue of a symbol: a square where the declaration says it is positive.
    pub(crate) fn symbol(&self, graph: &Graph, symbol: SymbolId) -> u64 {
        if let Some(value) = self.fixed.get(&symbol) {
            return *value;
        }
        let value = self.draw(OF_SYMBOL, symbol.index() as u64);
        match graph.symbol_info(symbol).bound {
            _ if self.is_unbound => value,
            SignBound::Free | SignBound::NonZero if !self.squares => value,
            SignBound::Free | SignBound::NonZero => mul(value, value),
            SignBound::Positive | SignBound::NonNegative => mul(value, value),
            SignBound::Negative | SignBound::NonPositive => neg(mul(value, value)),
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
            self.make_room(table.ops.len());
        }
        let known = self.values[e.index()];
        if known != UNSET {
            return if known == POLE { None } else { Some(known - SET) };
        }
        let ops: &[Op] = &table.ops;
        let mut stack = vec![e.0];
        while let Some(&id) = stack.last() {
            let op = &ops[id as usize];
            let values: &[u64] = &self.values;
            if values[id as usize] != UNSET {
                stack.pop();
                continue;
            }
            let before = stack.len();
            let mut pole = false;
            let mut need = |child: ExprId| match values[child.0 as usize] {
                UNSET => stack.push(child.0),
                POLE => pole = true,
                _ => {}
            };
            match op {
                Op::Sum(_, terms) => {
                    let terms: &[(ExprId, u64)] = terms;
                    let mut index = 0;
                    while index < terms.len() {
                        need(terms[index].0);
                        index += 1;
                    }
                }
                Op::Product => {
                    let factors = graph.factors(ExprId(id));
                    let mut index = 0;
                    while index < factors.len() {
                        need(factors[index].0);
                        index += 1;
                    }
                }
                Op::At(_, x) => need(*x),
                Op::Several(_) => {
                    for argument in graph.arguments(ExprId(id)) {
                        need(*argument);
                    }
                }
                Op::Constant(_) | Op::Pi | Op::Symbol(_) | Op::Of(..) => {}
            }
            if pole {
                stack.truncate(before - 1);
                self.values[id as usize] = POLE;
            } else if stack.len() == before {
                stack.pop();
                let value = self.step(graph, table, ExprId(id), op);
                self.values[id as usize] = value.map_or(POLE, |value| value + SET);
            }
        }
        match self.values[e.index()] {
            POLE => None,
            value => Some(value - SET),
        }
    }

    /// Room for the values of so many nodes, in powers of two: zeroed memory is cheap also without optimisation.
    fn make_room(&mut self, nodes: usize) {
        let mut values = vec![UNSET; nodes.next_power_of_two()];
        values[..self.values.len()].copy_from_slice(&self.values);
        self.values = values;
    }

    /// The value of a node whose children are done and exist.
    fn step(&mut self, graph: &Graph, table: &Table, id: ExprId, op: &Op) -> Option<u64> {
        let values: &[u64] = &self.values;
        let at = |id: &ExprId| values[id.0 as usize] - SET;
        match op {
            Op::Constant(value) => *value,
            Op::Pi => Some(self.draw(OF_PI, 0)),
            Op::Symbol(symbol) => Some(self.symbol(graph, *symbol)),
            Op::Sum(constant, terms) => {
                let terms: &[(ExprId, u64)] = terms;
                let mut sum = *constant;
                let mut index = 0;
                while index < terms.len() {
                    let (term, c) = &terms[index];
                    let value = at(term);
                    sum = match *c {
                        1 => add(sum, value),
                        MINUS_ONE => sub(sum, value),
                        c => add(sum, mul(c, value)),
                    };
                    index += 1;
                }
                Some(sum)
            }
            Op::Product => {
                // One inversion for all denominators together.
                let (mut above, mut below) = (1, 1);
                let factors = graph.factors(id);
                let mut index = 0;
                while index < factors.len() {
                    let (base, e) = &factors[index];
                    index += 1;
                    let value = at(base);
                    // The square of a root is the radicand, whatever is drawn for the root.
                    if self.has_drawn_roots
                        && let Some((q, radicand)) = root(graph, *base)
                    {
                        let q = i32::try_from(q).ok()?;
                        above = mul(above, field::pow(value, u64::try_from(e.rem_euclid(q)).ok()?));
                        let power = field::pow(at(&radicand), e.div_euclid(q).unsigned_abs().into());
                        let side = if *e < 0 { &mut below } else { &mut above };
                        *side = mul(*side, power);
                        continue;
                    }
                    match *e {
                        1 => above = mul(above, value),
                        2 => above = mul(above, mul(value, value)),
                        -1 => below = mul(below, value),
                        e => {
                            let power = field::pow(value, e.unsigned_abs().into());
                            let side = if e < 0 { &mut below } else { &mut above };
                            *side = mul(*side, power);
                        }
                    }
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
            Op::At(function, x) if self.has_drawn_roots => {
                Some(self.draw(OF_ATOM + function.code() * 256, at(x)))
            }
            Op::At(Function::Root(q), x) => field::root(at(x), *q),
            Op::At(Function::Abs, x) => field::sqrt(mul(at(x), at(x))),
            Op::At(Function::Sign, x) => Some(match at(x) {
                0 => 0,
                x if field::is_residue(x) => 1,
                _ => PRIME - 1,
            }),
            Op::At(function, x) => Some(self.draw(OF_ATOM + function.code() * 256, at(x))),
            Op::Several(function) => Some(self.several(*function, graph.arguments(id))),
        }
    }

    /// A function of several arguments that are done.
    fn several(&self, function: Multivariate, arguments: &[ExprId]) -> u64 {
        let at = |place: usize| self.values[arguments[place].0 as usize] - SET;
        match function {
            Multivariate::Atan2 => self.draw(OF_ATOM ^ mix(at(0)), at(1)),
            Multivariate::Select => self.between(at(0), at(1), at(2)),
            Multivariate::Maximum => self.between(sub(at(0), at(1)), at(0), at(1)),
            Multivariate::Minimum => self.between(sub(at(0), at(1)), at(1), at(0)),
            Multivariate::Supplied { .. } => {
                let last = arguments.len() - 1;
                let purpose = (0..last).fold(mix(function.code()), |hash, place| mix(hash ^ at(place)));
                self.draw(OF_ATOM ^ purpose, at(last))
            }
        }
    }

    /// `s a + (1 - s) b` with a number `s` drawn for `c`, and `1 - s` for `-c`. What holds for all `s` holds for zero and one, and
    /// so on both sides of every switch, however many there are; a residue that chose one side would say nothing of the other.
    fn between(&self, c: u64, a: u64, b: u64) -> u64 {
        let (c, a, b) = if c > PRIME / 2 { (neg(c), b, a) } else { (c, a, b) };
        add(b, mul(self.draw(OF_BRANCH, c), sub(a, b)))
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
