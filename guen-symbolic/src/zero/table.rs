//! The table that all sample points share: nodes with residues for coefficients, arguments of functions taken apart,
//! and flags.
//!
//! The graph only grows, so a scan reads each node once. An argument of `sin`, `exp` and their kin is a
//! rational combination of monomials; each monomial, divided by the lcm of all its denominators in the
//! graph, will be an independent point of the circle (or a unit) in a sample.

use std::collections::BTreeMap;

use super::field;
use crate::algebra::{ExprId, FastMap, Function, Graph, Multivariate, Node, Rational, SymbolId};

/// The flags of the nodes below an expression, by which a verdict is reached; a set of the constants here.
pub(crate) type Flags = u8;
/// Roots, absolute values, signs: a residue knows them up to a sign.
pub(crate) const ROOT: Flags = 1;
/// `ln`, `asin`, `acos`, `atan`, `atan2`, `floor`: hashes that only agree for equal arguments.
pub(crate) const ATOM: Flags = 2;
/// Numbers such as `pi`, `sin(0.3)`: independent unknowns.
pub(crate) const TRANSCENDENTAL: Flags = 4;
/// Arguments of functions that may be equal without being seen to be.
pub(crate) const OPAQUE: Flags = 8;
/// Absolute values and signs: at a point they are one of a number and its opposite, and elsewhere the other.
pub(crate) const SIGN: Flags = 32;
/// Functions that are constant between jumps, or have branches: a derivative that vanishes does not make them constant.
pub(crate) const PIECEWISE: Flags = 64;
/// A division by the number zero, or a number that the prime cannot represent.
pub(crate) const UNDEFINED: Flags = 16;

/// A node for evaluation modulo the prime.
#[derive(Debug)]
pub(crate) enum Op {
    /// A number; `None` if it has no residue.
    Constant(Option<u64>),
    Pi,
    Symbol(SymbolId),
    Sum(u64, Box<[(ExprId, u64)]>),
    /// The factors are those of the graph's node.
    Product,
    /// A function of a combination of monomials.
    Of(Function, u32),
    /// An algebraic function, or an atom.
    At(Function, ExprId),
    /// A function of several arguments, those of the graph's node.
    Several(Multivariate),
}

/// `sum (n/d) * monomial + (a/b) pi`, the last part where an exact root of unity serves it.
#[derive(Debug)]
pub(crate) struct Argument {
    pub(crate) parts: Vec<(u32, i64, i64)>,
    /// The power of [`field::TURN`].
    pub(crate) turn: i128,
}

type Monomial = Box<[(ExprId, i32)]>;
type Combination = BTreeMap<Monomial, Rational>;

/// Halves, thirds and quarters are so common that monomials start with this denominator: it rarely grows.
const FIRST_LCM: i64 = 12;
/// The least common denominator above which an argument is opaque.
const LARGEST_LCM: i64 = 1 << 50;
/// The number of terms above which an argument is not multiplied out.
const ARGUMENT_TERMS: usize = 200;
/// Higher powers of sums in arguments are not multiplied out.
const ARGUMENT_POWER: i32 = 4;

/// The nodes of one graph, prepared.
#[derive(Debug, Default)]
pub(crate) struct Table {
    pub(crate) ops: Vec<Op>,
    pub(crate) flags: Vec<Flags>,
    pub(crate) arguments: Vec<Argument>,
    argument_of: FastMap<ExprId, (u32, Flags)>,
    monomials: FastMap<Monomial, u32>,
    /// The common denominator of each monomial.
    pub(crate) lcms: Vec<i64>,
    /// Changes when a denominator does: values computed before are of no use then.
    pub(crate) generation: u32,
}

impl Table {
    /// Reads the nodes that are new.
    pub(crate) fn scan(&mut self, graph: &Graph) {
        for index in self.ops.len()..graph.len() {
            let id = ExprId(index as u32);
            let mut below = 0;
            graph.visit_children(id, |child| below |= self.flags[child.index()]);
            let (op, own) = self.read(graph, id);
            self.ops.push(op);
            self.flags.push(below | own);
        }
    }

    fn read(&mut self, graph: &Graph, id: ExprId) -> (Op, Flags) {
        match graph.node(id) {
            Node::Undefined => (Op::Constant(None), UNDEFINED),
            Node::Number(value) => constant(value),
            Node::Pi => (Op::Pi, TRANSCENDENTAL),
            Node::Symbol(symbol) => (Op::Symbol(*symbol), 0),
            Node::Sum { constant, terms } => {
                let mut residues = Vec::with_capacity(terms.len());
                for (term, c) in terms {
                    let Some(residue) = field::residue(c) else { return (Op::Constant(None), UNDEFINED) };
                    residues.push((*term, residue));
                }
                match field::residue(constant) {
                    Some(constant) => (Op::Sum(constant, residues.into_boxed_slice()), 0),
                    None => (Op::Constant(None), UNDEFINED),
                }
            }
            Node::Product(_) => (Op::Product, 0),
            Node::Kept(x) => (Op::Sum(0, Box::new([(*x, 1)])), 0),
            Node::Multivariate(function, _) => {
                let flags = match function {
                    Multivariate::Atan2 => ATOM,
                    // All derivatives at all arguments are free: what holds for random values holds for every function.
                    Multivariate::Supplied { .. } => 0,
                    // A residue has neither of both branches, but something between them.
                    _ => OPAQUE | PIECEWISE,
                };
                (Op::Several(*function), flags)
            }
            Node::Function(function, x) => {
                let (function, x) = (*function, *x);
                match function {
                    Function::Asin | Function::Acos | Function::Atan | Function::Ln => {
                        (Op::At(function, x), ATOM)
                    }
                    Function::Abs | Function::Sign => (Op::At(function, x), ROOT | SIGN | PIECEWISE),
                    Function::Floor => (Op::At(function, x), ATOM | PIECEWISE),
                    Function::Root(_) => (Op::At(function, x), ROOT),
                    Function::Sin | Function::Cos => self.of_argument(graph, function, x, true),
                    Function::Exp | Function::Sinh | Function::Cosh | Function::Tanh => {
                        self.of_argument(graph, function, x, false)
                    }
                }
            }
        }
    }

    fn of_argument(&mut self, graph: &Graph, function: Function, x: ExprId, circular: bool) -> (Op, Flags) {
        // Circular and exponential functions of one argument differ in how they treat pi; few graphs have both.
        if circular && let Some(&(argument, flags)) = self.argument_of.get(&x) {
            return (Op::Of(function, argument), flags);
        }
        let (argument, flags) = self.take_apart(graph, x, circular);
        let index = self.arguments.len() as u32;
        self.arguments.push(argument);
        if circular {
            self.argument_of.insert(x, (index, flags));
        }
        (Op::Of(function, index), flags)
    }

    fn take_apart(&mut self, graph: &Graph, x: ExprId, circular: bool) -> (Argument, Flags) {
        let mut flags = 0;
        let combination = expand(graph, x).unwrap_or_else(|| {
            flags |= OPAQUE;
            BTreeMap::from([(Box::from([(x, 1)]), Rational::ONE)])
        });
        let mut argument = Argument { parts: Vec::new(), turn: 0 };
        for (monomial, c) in combination {
            let is_pi = monomial.len() == 1 && monomial[0].1 == 1 && *graph.node(monomial[0].0) == Node::Pi;
            if monomial.is_empty() || is_pi {
                flags |= TRANSCENDENTAL;
            }
            let clean =
                monomial.iter().all(|(base, _)| matches!(graph.node(*base), Node::Symbol(_) | Node::Pi));
            if !clean {
                flags |= OPAQUE;
            }
            let pair = c.to_i64_pair();
            if circular
                && is_pi
                && let Some((n, d)) = pair
                && d < field::TURN_ORDER as i64
                && field::TURN_ORDER as i64 % (2 * d) == 0
            {
                argument.turn = i128::from(n) * i128::from(field::TURN_ORDER / 2 / d as u64);
                continue;
            }
            let index = self.monomial(monomial.clone());
            match pair.filter(|(_, d)| self.admit(index, *d)) {
                Some((n, d)) => argument.parts.push((index, n, d)),
                None => {
                    // The whole term becomes an unknown of its own, named by its coefficient's text.
                    flags |= OPAQUE;
                    let own = self.monomial(Box::from([(x, 1)]));
                    argument.parts.push((own, 1, 1));
                }
            }
        }
        (argument, flags)
    }

    fn monomial(&mut self, monomial: Monomial) -> u32 {
        let next = self.lcms.len() as u32;
        let index = *self.monomials.or_insert_with(monomial, || next);
        if index == next {
            self.lcms.push(FIRST_LCM);
        }
        index
    }

    /// Makes the monomial's common denominator a multiple of `d`, if it stays small enough.
    fn admit(&mut self, monomial: u32, d: i64) -> bool {
        let lcm = &mut self.lcms[monomial as usize];
        if *lcm % d == 0 {
            return true;
        }
        match (d / num_integer::gcd(*lcm, d)).checked_mul(*lcm).filter(|lcm| *lcm <= LARGEST_LCM) {
            Some(larger) => {
                *lcm = larger;
                self.generation += 1;
                true
            }
            None => false,
        }
    }
}

fn constant(value: &Rational) -> (Op, Flags) {
    match field::residue(value) {
        Some(residue) => (Op::Constant(Some(residue)), 0),
        None => (Op::Constant(None), UNDEFINED),
    }
}

/// An argument as a combination of monomials in what is neither sum nor product; `None` if that is long.
fn expand(graph: &Graph, x: ExprId) -> Option<Combination> {
    let mut known: FastMap<ExprId, Combination> = FastMap::default();
    // Only sums and products below `x` are opened.
    let mut stack = vec![(x, false)];
    while let Some((id, ready)) = stack.pop() {
        if known.contains_key(&id) {
            continue;
        }
        let opens = match graph.node(id) {
            Node::Sum { .. } => true,
            Node::Product(factors) => {
                factors.iter().all(|(base, e)| {
                    !matches!(graph.node(*base), Node::Sum { .. }) || (1..=ARGUMENT_POWER).contains(e)
                }) && factors.iter().any(|(base, _)| matches!(graph.node(*base), Node::Sum { .. }))
            }
            _ => false,
        };
        if opens && !ready {
            stack.push((id, true));
            stack.extend(graph.children(id).into_iter().map(|child| (child, false)));
            continue;
        }
        let combination = match graph.node(id) {
            Node::Number(value) => BTreeMap::from([(Monomial::default(), value.clone())]),
            Node::Sum { constant, terms } => {
                let mut sum = Combination::new();
                if !constant.is_zero() {
                    sum.insert(Monomial::default(), constant.clone());
                }
                for (term, c) in terms {
                    for (monomial, k) in &known[term] {
                        let slot = sum.entry(monomial.clone()).or_default();
                        *slot = &*slot + &(k * c);
                    }
                }
                sum.retain(|_, c| !c.is_zero());
                sum
            }
            Node::Product(factors) if opens => {
                let mut product = BTreeMap::from([(Monomial::default(), Rational::ONE)]);
                for (base, e) in factors {
                    let (factor, times) = if *e > 0 && *e <= ARGUMENT_POWER {
                        (known[base].clone(), *e)
                    } else {
                        (BTreeMap::from([(Box::from([(*base, *e)]) as Monomial, Rational::ONE)]), 1)
                    };
                    for _ in 0..times {
                        product = multiply(&product, &factor)?;
                    }
                }
                product
            }
            Node::Product(factors) => {
                let mut sorted = factors.clone();
                sorted.sort_unstable();
                BTreeMap::from([(sorted, Rational::ONE)])
            }
            _ => BTreeMap::from([(Box::from([(id, 1)]) as Monomial, Rational::ONE)]),
        };
        if combination.len() > ARGUMENT_TERMS {
            return None;
        }
        known.insert(id, combination);
    }
    known.get(&x).cloned()
}

fn multiply(a: &Combination, b: &Combination) -> Option<Combination> {
    let mut product = Combination::new();
    for (m, c) in a {
        for (n, d) in b {
            let mut exponents: BTreeMap<ExprId, i32> = m.iter().copied().collect();
            for (base, e) in n.iter() {
                *exponents.entry(*base).or_default() += e;
            }
            let monomial: Monomial = exponents.into_iter().filter(|(_, e)| *e != 0).collect();
            let slot = product.entry(monomial).or_default();
            *slot = &*slot + &(c * d);
        }
    }
    product.retain(|_, c| !c.is_zero());
    (product.len() <= ARGUMENT_TERMS).then_some(product)
}
