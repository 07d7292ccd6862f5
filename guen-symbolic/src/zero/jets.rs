//! Derivatives at a point modulo the prime: rates along a motion, forwards, and slopes by all symbols at once, backwards, with the
//! rates of the slopes.
//!
//! Nothing is built but the slopes of elementary functions: the work grows with the nodes.

use super::ZeroTest;
use super::field::{add, inverse, mul, neg};
use super::sample::Sample;
use super::table::Op;
use crate::algebra::{ExprId, FastMap, Graph, Node, Role, Roles};

/// The roles of symbols that change along a motion.
const MOVING: Roles = Roles::of(Role::Time)
    .or(Roles::of(Role::Coordinate))
    .or(Roles::of(Role::Velocity))
    .or(Roles::of(Role::QuasiVelocity));

/// A number and its rate.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct Jet {
    pub(crate) value: u64,
    pub(crate) rate: u64,
}

impl Jet {
    pub(crate) const ONE: Jet = Jet { value: 1, rate: 0 };

    pub(crate) fn plus(self, other: Jet) -> Jet {
        Jet { value: add(self.value, other.value), rate: add(self.rate, other.rate) }
    }

    pub(crate) fn times(self, other: Jet) -> Jet {
        let rate = add(mul(self.value, other.rate), mul(self.rate, other.value));
        Jet { value: mul(self.value, other.value), rate }
    }

    fn scaled(self, c: u64) -> Jet {
        Jet { value: mul(self.value, c), rate: mul(self.rate, c) }
    }

    /// An integer power, and its slope.
    fn power(self, e: i32) -> Option<(Jet, Jet)> {
        if e == 1 {
            return Some((self, Jet::ONE));
        }
        let size = e.unsigned_abs();
        // b^(e-1)
        let lower = if e < 0 { self.inverse()?.raised(size + 1) } else { self.raised(size - 1) };
        let exponent = if e < 0 { neg(size.into()) } else { size.into() };
        Some((lower.times(self), lower.scaled(exponent)))
    }

    fn raised(self, e: u32) -> Jet {
        (0..e).fold(Jet::ONE, |power, _| power.times(self))
    }

    fn inverse(self) -> Option<Jet> {
        let value = inverse(self.value)?;
        Some(Jet { value, rate: neg(mul(self.rate, mul(value, value))) })
    }
}

/// Expressions that are differentiated at points.
#[derive(Debug, Default)]
pub(crate) struct Tape {
    /// The nodes that change along a motion, operands first.
    nodes: Vec<ExprId>,
    is_known: Vec<bool>,
    /// The slopes of the functions among the nodes, by each argument.
    slopes: FastMap<ExprId, Vec<ExprId>>,
}

impl Tape {
    /// Takes further expressions in; how many nodes there are then.
    pub(crate) fn extend(&mut self, graph: &mut Graph, roots: &[ExprId]) -> usize {
        let mut roots = roots.to_vec();
        // The rates of slopes need the slopes of slopes, and no more.
        for _ in 0..2 {
            let known = |id: ExprId| self.is_known.get(id.index()) == Some(&true);
            let fresh = graph.reachable(&roots, |id| !graph.roles(id).meets(MOVING) || known(id));
            roots.clear();
            for id in &fresh {
                let slopes: Vec<ExprId> = match graph.node(*id).clone() {
                    Node::Function(function, x) => vec![graph.function_derivative(function, x, *id)],
                    Node::Multivariate(function, arguments) => (0..arguments.len())
                        .map(|place| graph.multivariate_partial(function, &arguments, place))
                        .collect(),
                    _ => continue,
                };
                roots.extend(&slopes);
                self.slopes.insert(*id, slopes);
            }
            self.is_known.resize(graph.len(), false);
            for id in &fresh {
                self.is_known[id.index()] = true;
            }
            self.nodes.extend(fresh);
        }
        self.nodes.len()
    }
}

/// A point that moves.
pub(crate) struct Moving<'a> {
    graph: &'a Graph,
    zero: &'a ZeroTest,
    tape: &'a Tape,
    sample: Sample,
    rates: Vec<u64>,
}

impl<'a> Moving<'a> {
    /// A point at rest.
    pub(crate) fn new(graph: &'a Graph, zero: &'a ZeroTest, tape: &'a Tape, sample: Sample) -> Self {
        Moving { graph, zero, tape, sample, rates: vec![0; tape.is_known.len()] }
    }

    /// The value of an expression; `None` where it has none.
    pub(crate) fn value(&mut self, e: ExprId) -> Option<u64> {
        self.sample.value(self.graph, &self.zero.table, e)
    }

    /// The values of expressions.
    pub(crate) fn values(&mut self, es: &[ExprId]) -> Option<Vec<u64>> {
        es.iter().map(|e| self.value(*e)).collect()
    }

    /// Gives a symbol a value that is not its draw, before anything is asked that depends on it.
    pub(crate) fn place(&mut self, symbol: ExprId, value: u64) {
        if let Some(symbol) = self.graph.as_symbol(symbol) {
            self.sample.fixed.insert(symbol, value);
        }
    }

    /// Gives a symbol a rate.
    pub(crate) fn set_rate(&mut self, symbol: ExprId, rate: u64) {
        if let Some(place) = self.rates.get_mut(symbol.index()) {
            *place = rate;
        }
    }

    /// The rate of what was passed.
    pub(crate) fn rate(&self, e: ExprId) -> u64 {
        self.rates.get(e.index()).copied().unwrap_or(0)
    }

    /// Value and rate of what was passed.
    pub(crate) fn jet(&mut self, e: ExprId) -> Option<Jet> {
        Some(Jet { value: self.value(e)?, rate: self.rate(e) })
    }

    /// Passes some nodes of the tape: their rates, from those of the symbols.
    pub(crate) fn pass(&mut self, nodes: core::ops::Range<usize>) -> Option<()> {
        let (graph, table, tape) = (self.graph, &self.zero.table, self.tape);
        for id in &tape.nodes[nodes] {
            let rate = match graph.node(*id) {
                Node::Symbol(_) => continue,
                Node::Function(..) | Node::Multivariate(..) => {
                    let mut sum = 0;
                    for (slope, x) in tape.slopes[id].iter().zip(graph.children(*id)) {
                        match self.rate(x) {
                            0 => {}
                            inner => sum = add(sum, mul(self.value(*slope)?, inner)),
                        }
                    }
                    sum
                }
                Node::Product(factors) => {
                    let mut product = Jet::ONE;
                    if factors.iter().any(|(base, _)| self.rate(*base) != 0) {
                        for (base, e) in factors {
                            product = product.times(self.jet(*base)?.power(*e)?.0);
                        }
                    }
                    product.rate
                }
                _ => match &table.ops[id.index()] {
                    Op::Sum(_, terms) => terms.iter().fold(0, |sum, (term, c)| match self.rate(*term) {
                        0 => sum,
                        rate => add(sum, mul(*c, rate)),
                    }),
                    _ => return None,
                },
            };
            self.rates[id.index()] = rate;
        }
        Some(())
    }

    /// Goes back over some nodes: what each has of the slopes goes to its operands.
    pub(crate) fn go_back(&mut self, nodes: core::ops::Range<usize>, slopes: &mut Slopes) -> Option<()> {
        let (graph, table, tape) = (self.graph, &self.zero.table, self.tape);
        for id in tape.nodes[nodes].iter().rev() {
            let own = slopes.of(*id);
            if own == Jet::default() {
                continue;
            }
            match graph.node(*id) {
                Node::Symbol(_) => {}
                Node::Function(..) | Node::Multivariate(..) => {
                    for (slope, x) in tape.slopes[id].iter().zip(graph.children(*id)) {
                        if graph.roles(x).meets(MOVING) {
                            let slope = self.jet(*slope)?;
                            slopes.add(x, own.times(slope));
                        }
                    }
                }
                Node::Product(factors) => {
                    let mut powers = Vec::with_capacity(factors.len());
                    for (base, e) in factors {
                        powers.push(self.jet(*base)?.power(*e)?);
                    }
                    for (moved, (base, _)) in factors.iter().enumerate() {
                        if !graph.roles(*base).meets(MOVING) {
                            continue;
                        }
                        let mut share = own.times(powers[moved].1);
                        for (other, (power, _)) in powers.iter().enumerate() {
                            if other != moved {
                                share = share.times(*power);
                            }
                        }
                        slopes.add(*base, share);
                    }
                }
                _ => match &table.ops[id.index()] {
                    Op::Sum(_, terms) => {
                        for (term, c) in terms.iter() {
                            slopes.add(*term, own.scaled(*c));
                        }
                    }
                    _ => return None,
                },
            }
        }
        Some(())
    }

    /// Returns a table without slopes.
    pub(crate) fn no_slopes(&self) -> Slopes {
        Slopes(vec![Jet::default(); self.rates.len()])
    }
}

/// The slope of the differentiated expression by each node.
pub(crate) struct Slopes(Vec<Jet>);

impl Slopes {
    /// The slope by a node.
    pub(crate) fn of(&self, e: ExprId) -> Jet {
        self.0.get(e.index()).copied().unwrap_or_default()
    }

    /// Adds to the slope by a node.
    pub(crate) fn add(&mut self, e: ExprId, share: Jet) {
        if let Some(sum) = self.0.get_mut(e.index()) {
            *sum = sum.plus(share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Flow, Function};

    /// A function of each kind, of a coordinate that moves, its velocity, and time.
    #[test]
    fn derivatives_are_those_of_expressions() {
        let mut g = Graph::new();
        let [x, v, t] = [("x", Role::Coordinate), ("v", Role::Velocity), ("t", Role::Time)]
            .map(|(name, role)| g.symbol(name, role));
        let (a, one) = (g.symbol("a", Role::Constant), g.one());
        let product = g.mul(x, v);
        let argument = g.add(product, t);
        let functions = [
            Function::Sin,
            Function::Cos,
            Function::Asin,
            Function::Acos,
            Function::Atan,
            Function::Exp,
            Function::Ln,
            Function::Sinh,
            Function::Cosh,
            Function::Tanh,
            Function::Abs,
            Function::Sign,
            Function::Floor,
            Function::Root(2),
            Function::Root(3),
        ];
        let mut roots: Vec<ExprId> = functions.iter().map(|f| g.function(*f, argument)).collect();
        let supplied = g.declare_function("f", &["x", "v"]);
        roots.extend([g.multivariate(supplied, &[x, product]), g.select(v, x, product), g.maximum(x, v)]);
        roots.extend([g.atan2(x, v), g.product(&[(argument, -2), (v, 3), (x, 1)]), g.keep(argument)]);
        for root in roots {
            let e = g.product(&[(root, 2), (x, 1), (a, 1)]);
            let mut tape = Tape::default();
            let nodes = tape.extend(&mut g, &[e]);
            let mut along = Flow::new(&g, [(x, v), (v, a), (t, one)]);
            let by_x = Flow::partial(&g, x).of(&mut g, e);
            let expected = [along.of(&mut g, e), by_x, along.of(&mut g, by_x)];
            let mut zero = ZeroTest::new();
            let mut seen = 0;
            for number in 0..64 {
                let Some(sample) = zero.fresh(&g, number, false) else { continue };
                let mut moving = Moving::new(&g, &zero, &tape, sample);
                let Some(expected) = moving.values(&expected) else { continue };
                for (symbol, rate) in [(x, v), (v, a), (t, one)] {
                    let rate = moving.value(rate).unwrap();
                    moving.set_rate(symbol, rate);
                }
                assert!(moving.pass(0..nodes).is_some());
                let mut slopes = moving.no_slopes();
                slopes.add(e, Jet::ONE);
                assert!(moving.go_back(0..nodes, &mut slopes).is_some());
                let slope = slopes.of(x);
                assert_eq!([moving.rate(e), slope.value, slope.rate], expected[..], "{}", g.text(e));
                seen += 1;
            }
            assert!(seen > 8, "{}", g.text(e));
        }
    }
}
