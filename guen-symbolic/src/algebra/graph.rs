//! The graph: nodes, symbols, and the table that makes equal nodes one.

use std::cell::Cell;

use super::base_angles::BaseAngles;
use super::function::{Multivariate, SuppliedFunction};
use super::id::{ExprId, SymbolId, mix};
use super::map::{FastMap, spread};
use super::node::{Node, content_of};
use super::search::{Search, sort_ids};
use super::support::Support;
use super::symbol::{Role, Roles, SignBound, Symbol};
use super::{Function, Rational};

fn is_product(node: &Node, factors: &[(ExprId, i32)]) -> bool {
    let Node::Product(others) = node else { return false };
    let others: &[(ExprId, i32)] = others;
    if others.len() != factors.len() {
        return false;
    }
    let mut index = 0;
    while index < factors.len() {
        if others[index].0.0 != factors[index].0.0 || others[index].1 != factors[index].1 {
            return false;
        }
        index += 1;
    }
    true
}

fn same_terms(others: &[(ExprId, Rational)], terms: &[(ExprId, Rational)]) -> bool {
    if others.len() != terms.len() {
        return false;
    }
    let mut index = 0;
    while index < terms.len() {
        if others[index].0.0 != terms[index].0.0 || others[index].1 != terms[index].1 {
            return false;
        }
        index += 1;
    }
    true
}

/// The order of a list by the graph's keys.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    Ascending,
    Descending,
}

/// A sum whose coefficients have no factor in common, the first one positive.
const PRIMITIVE: u8 = 1;
/// A product with a sine whose exponent is at least two.
pub(super) const SINE_SQUARED: u8 = 2;
/// A product with a cosine whose exponent is at least two, or negative: without one of these nothing folds with a square
/// of a sine.
pub(super) const COSINES: u8 = 4;

/// A hash-consed graph of expressions over its own symbols.
///
/// Factors and terms are ordered by a structural key that depends on what an expression is, not on
/// when or in which order it was written, so that differently written declarations of one system meet.
///
/// ```
/// use guen_symbolic::{Graph, Role};
/// let mut g = Graph::new();
/// let x = g.symbol("x", Role::Coordinate);
/// let (s, c) = (g.sin(x), g.cos(x));
/// let (s2, c2) = (g.powi(s, 2), g.powi(c, 2));
/// let sum = g.add(s2, c2);
/// assert_eq!(sum, g.one());
/// ```
#[derive(Default)]
pub struct Graph {
    pub(crate) nodes: Vec<Node>,
    keys: Vec<u64>,
    supports: Vec<Support>,
    depths: Vec<u32>,
    // What is known of sums and products by their looks, see the constants.
    flags: Vec<u8>,
    // Content and primitive part of sums that are not primitive.
    pub(super) contents: FastMap<ExprId, (Rational, ExprId)>,
    // A cell, because looking at expressions is work too.
    work: Cell<u64>,
    search: Cell<Search>,
    // Places of the nodes by their keys: one more than an identifier, zero for none; a power of two of them.
    slots: Vec<u32>,
    symbols: Vec<Symbol>,
    symbol_nodes: Vec<ExprId>,
    role_counts: [u32; 8],
    // Constants that differ from zero by what they are, whatever was promised.
    indispensable: Vec<SymbolId>,
    pub(super) base_angles: BaseAngles,
    pub(super) supplied: Vec<SuppliedFunction>,
    // Whether a piecewise function was made.
    branches: bool,
    // Whether sums of sums stay nested: see `nest_sums`.
    pub(super) nests: bool,
}

impl Graph {
    /// Lets a sum with a nested sum among its terms stay nested in further sums, so that partial sums along a long family are each the one
    /// before and a term, and no group of them looks different.
    pub fn nest_sums(&mut self) {
        self.nests = true;
    }

    /// Whether sums of sums stay nested.
    pub fn nests_sums(&self) -> bool {
        self.nests
    }

    /// An empty graph.
    pub fn new() -> Self {
        let mut graph = Graph::default();
        // Zero and one get the first two identifiers.
        graph.intern(Node::Number(Rational::ZERO));
        graph.intern(Node::Number(Rational::ONE));
        graph
    }

    /// The number zero.
    pub fn zero(&self) -> ExprId {
        ExprId(0)
    }

    /// The number one.
    pub fn one(&self) -> ExprId {
        ExprId(1)
    }

    /// The number of nodes so far: the measure that limits on work are stated in.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Elementary steps so far, about one for each term or factor that was put together, and for each node that was
    /// visited: a measure of work that is the same on every machine.
    pub fn work(&self) -> u64 {
        self.work.get()
    }

    /// The number of nodes on the longest way from an expression down to a symbol or a number.
    pub fn depth(&self, id: ExprId) -> u32 {
        self.depths[id.index()]
    }

    /// Whether there is no node; never the case after [`Graph::new`].
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The node behind an identifier.
    pub fn node(&self, id: ExprId) -> &Node {
        &self.nodes[id.index()]
    }

    /// The structural key: the order of terms and factors.
    pub(crate) fn key(&self, id: ExprId) -> (u64, ExprId) {
        (self.keys[id.index()], id)
    }

    /// Returns the kinds of symbol that occur in an expression.
    pub fn roles(&self, id: ExprId) -> Roles {
        self.support(id).roles()
    }

    /// The symbols below a node.
    pub(crate) fn support(&self, id: ExprId) -> Support {
        self.supports[id.index()]
    }

    /// The value, if the expression is a number.
    pub fn as_number(&self, id: ExprId) -> Option<&Rational> {
        match self.node(id) {
            Node::Number(value) => Some(value),
            _ => None,
        }
    }

    /// Whether the expression is the number zero (structurally; see `crate::zero` for functions that vanish).
    pub fn is_zero(&self, id: ExprId) -> bool {
        id == self.zero()
    }

    /// The symbol, if the expression is one.
    pub fn as_symbol(&self, id: ExprId) -> Option<SymbolId> {
        match self.node(id) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        }
    }

    /// A new symbol without a promise about its value. Symbols are never merged, also if names agree.
    pub fn symbol(&mut self, name: &str, role: Role) -> ExprId {
        self.bounded_symbol(name, role, SignBound::Free)
    }

    /// A new symbol with a promise about its value.
    pub fn bounded_symbol(&mut self, name: &str, role: Role, bound: SignBound) -> ExprId {
        let id = SymbolId(self.symbols.len() as u32);
        let ordinal = self.role_counts[role as usize];
        self.role_counts[role as usize] += 1;
        self.symbols.push(Symbol { name: name.to_owned(), role, bound });
        // The key is the place in the declaration, not the name: renaming must not change rounding.
        let key = mix(mix(0x5300 + role as u64) ^ u64::from(ordinal));
        let node = self.push(Node::Symbol(id), key, Support::of_symbol(Roles::of(role), ordinal), 0);
        self.symbol_nodes.push(node);
        node
    }

    /// Returns the name, the role and the bound of a symbol.
    pub fn symbol_info(&self, symbol: SymbolId) -> &Symbol {
        &self.symbols[symbol.index()]
    }

    /// Remembers that a constant differs from zero by what it is, beside what was promised of its sign.
    pub(crate) fn set_indispensable(&mut self, symbol: SymbolId) {
        let bound = &mut self.symbols[symbol.index()].bound;
        *bound = match *bound {
            SignBound::Free => SignBound::NonZero,
            SignBound::NonNegative => SignBound::Positive,
            SignBound::NonPositive => SignBound::Negative,
            known => known,
        };
        self.indispensable.push(symbol);
    }

    /// Whether a constant differs from zero by what it is.
    pub(crate) fn is_indispensable(&self, symbol: SymbolId) -> bool {
        self.indispensable.contains(&symbol)
    }

    /// The expression that a symbol is.
    pub fn symbol_expr(&self, symbol: SymbolId) -> ExprId {
        self.symbol_nodes[symbol.index()]
    }

    /// Returns all symbols, in the order of their making.
    pub fn symbols(&self) -> impl Iterator<Item = SymbolId> + use<> {
        (0..self.symbols.len() as u32).map(SymbolId)
    }

    /// The children of a node, in its order.
    pub fn children(&self, id: ExprId) -> Vec<ExprId> {
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => Vec::new(),
            Node::Sum { terms, .. } => terms.iter().map(|t| t.0).collect(),
            Node::Product(factors) => factors.iter().map(|f| f.0).collect(),
            Node::Function(_, x) | Node::Kept(x) => vec![*x],
            Node::Multivariate(_, arguments) => arguments.to_vec(),
        }
    }

    /// Calls `visit` with each child, without making a list.
    pub(crate) fn visit_children(&self, id: ExprId, mut visit: impl FnMut(ExprId)) {
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => {}
            Node::Sum { terms, .. } => {
                let terms: &[(ExprId, Rational)] = terms;
                let mut index = 0;
                while index < terms.len() {
                    visit(terms[index].0);
                    index += 1;
                }
            }
            Node::Product(factors) => {
                let factors: &[(ExprId, i32)] = factors;
                let mut index = 0;
                while index < factors.len() {
                    visit(factors[index].0);
                    index += 1;
                }
            }
            Node::Function(_, x) | Node::Kept(x) => visit(*x),
            Node::Multivariate(_, arguments) => {
                for argument in arguments {
                    visit(*argument);
                }
            }
        }
    }

    /// The factors of a product, none of any other node.
    pub(crate) fn factors(&self, id: ExprId) -> &[(ExprId, i32)] {
        match self.node(id) {
            Node::Product(factors) => factors,
            _ => &[],
        }
    }

    /// An expression without the number that it is a multiple of.
    pub(crate) fn monomial(&self, id: ExprId) -> ExprId {
        match self.node(id) {
            Node::Sum { constant, terms } if constant.is_zero() && terms.len() == 1 => terms[0].0,
            _ => id,
        }
    }

    /// The divisors of some expressions.
    pub(crate) fn divisors(&self, es: &[ExprId]) -> Vec<ExprId> {
        let below = self.reachable(es, |_| false).into_iter();
        let divided = below.flat_map(|id| self.factors(id)).filter(|(_, exponent)| *exponent < 0);
        divided.map(|(base, _)| *base).collect()
    }

    /// Whether some expression has branches: an absolute value, a sign, a step, a choice.
    pub fn has_branches(&self) -> bool {
        self.branches
    }

    /// The arguments of a function of several arguments, none of any other node.
    pub(crate) fn arguments(&self, id: ExprId) -> &[ExprId] {
        match self.node(id) {
            Node::Multivariate(_, arguments) => arguments,
            _ => &[],
        }
    }

    /// Everything below `roots`, roots included, children first; nodes for which `stop` holds are not entered nor listed.
    pub fn reachable(&self, roots: &[ExprId], mut stop: impl FnMut(ExprId) -> bool) -> Vec<ExprId> {
        // Whoever asks from within `stop` gets memory of its own.
        let mut search = self.search.take();
        search.begin(self.nodes.len());
        let mut found = Vec::new();
        for root in roots {
            search.push(*root);
        }
        while let Some(id) = search.pop() {
            if stop(id) {
                continue;
            }
            found.push(id);
            self.visit_children(id, |child| search.push(child));
        }
        self.search.set(search);
        self.spend(found.len());
        sort_ids(&mut found);
        found
    }

    /// The symbols that occur in an expression, in the order of their making.
    pub fn symbols_in(&self, roots: &[ExprId]) -> Vec<SymbolId> {
        let mut symbols: Vec<_> =
            self.reachable(roots, |_| false).into_iter().filter_map(|id| self.as_symbol(id)).collect();
        symbols.sort_unstable();
        symbols
    }

    pub(super) fn spend(&self, steps: usize) {
        self.work.set(self.work.get() + steps as u64);
    }

    /// The identifier of a node in normal form.
    pub(crate) fn intern(&mut self, node: Node) -> ExprId {
        self.spend(1);
        let key = self.structural_key(&node);
        if let Some(id) = self.lookup(key, |other| *other == node) {
            return id;
        }
        self.branches |= match &node {
            Node::Function(Function::Abs | Function::Sign | Function::Floor, _) => true,
            Node::Multivariate(function, _) => function.is_choice(),
            _ => false,
        };
        let depth = |child: &ExprId| self.depths[child.index()];
        let (support, below) = match &node {
            Node::Symbol(_) | Node::Sum { .. } | Node::Product(_) => {
                unreachable!("symbols, sums and products are made elsewhere")
            }
            Node::Number(_) | Node::Pi | Node::Undefined => (Support::default(), 0),
            Node::Function(_, x) | Node::Kept(x) => (self.support(*x), depth(x)),
            Node::Multivariate(_, arguments) => {
                arguments.iter().fold((Support::default(), 0), |(all, below), e| {
                    (all.or(self.support(*e)), below.max(depth(e)))
                })
            }
        };
        self.push(node, key, support, below)
    }

    /// The identifier of a sum with at least one term, in the graph's order.
    pub(super) fn intern_sum(&mut self, constant: Rational, terms: Vec<(ExprId, Rational)>) -> ExprId {
        self.spend(1 + terms.len());
        let key = self.sum_key(&constant, &terms);
        let same = |node: &Node| match node {
            Node::Sum { constant: other, terms: others } => *other == constant && same_terms(others, &terms),
            _ => false,
        };
        if let Some(id) = self.lookup(key, same) {
            return id;
        }
        let (mut support, mut depth) = (Support::default(), 0);
        let mut index = 0;
        while index < terms.len() {
            let child = terms[index].0.0 as usize;
            support = support.or(self.supports[child]);
            depth = depth.max(self.depths[child]);
            index += 1;
        }
        let primitive = content_of(&constant, &terms).is_one();
        let id = self.push(Node::Sum { constant, terms: terms.into_boxed_slice() }, key, support, depth);
        if primitive {
            self.flags[id.index()] = PRIMITIVE;
        }
        id
    }

    /// The identifier of a product of more than one power, in the graph's order.
    pub(super) fn intern_product(&mut self, factors: Vec<(ExprId, i32)>) -> ExprId {
        self.spend(1 + factors.len());
        let key = self.product_key(&factors);
        if let Some(id) = self.lookup(key, |node| is_product(node, &factors)) {
            return id;
        }
        let (mut support, mut depth, mut flags) = (Support::default(), 0, 0);
        let mut index = 0;
        while index < factors.len() {
            let (base, e) = factors[index];
            let child = base.0 as usize;
            support = support.or(self.supports[child]);
            depth = depth.max(self.depths[child]);
            match self.nodes[child] {
                Node::Function(Function::Sin, _) if e >= 2 => flags |= SINE_SQUARED,
                Node::Function(Function::Cos, _) if e != 0 && e != 1 => flags |= COSINES,
                _ => {}
            }
            index += 1;
        }
        let id = self.push(Node::Product(factors.into_boxed_slice()), key, support, depth);
        self.flags[id.index()] = flags;
        id
    }

    /// A product, if the graph has it already.
    pub(super) fn find_product(&self, factors: &[(ExprId, i32)]) -> Option<ExprId> {
        self.lookup(self.product_key(factors), |node| is_product(node, factors))
    }

    /// Whether the coefficients of a sum have no factor in common and the first is positive.
    pub(super) fn is_primitive(&self, id: ExprId) -> bool {
        self.flags[id.0 as usize] & PRIMITIVE != 0
    }

    /// Returns the flags of a sum or product: a set of the constants here.
    pub(super) fn looks(&self, id: ExprId) -> u8 {
        self.flags[id.0 as usize]
    }

    /// Returns the place of an expression in a list in the graph's order, or the place where it would have to be put.
    pub(super) fn place_of<T>(&self, list: &[(ExprId, T)], id: ExprId) -> Result<usize, usize> {
        self.place_in(list, id, Order::Ascending)
    }

    /// Returns the place of an expression in a list that is sorted in this order, or where it belongs.
    pub(super) fn place_in<T>(&self, list: &[(ExprId, T)], id: ExprId, order: Order) -> Result<usize, usize> {
        let keys: &[u64] = &self.keys;
        let key = keys[id.0 as usize];
        let (mut low, mut high) = (0, list.len());
        while low < high {
            // Lists are put together from sorted ones: often the end is the place.
            let at = if high == list.len() { high - 1 } else { (low + high) / 2 };
            let other = list[at].0;
            if other.0 == id.0 {
                return Ok(at);
            }
            let other_key = keys[other.0 as usize];
            let is_before = other_key < key || other_key == key && other.0 < id.0;
            if is_before == (order == Order::Ascending) {
                low = at + 1;
            } else {
                high = at;
            }
        }
        Err(low)
    }

    /// The identifier of a node, if the graph has it already.
    pub(crate) fn find(&self, node: &Node) -> Option<ExprId> {
        self.lookup(self.structural_key(node), |other| other == node)
    }

    fn lookup(&self, key: u64, same: impl Fn(&Node) -> bool) -> Option<ExprId> {
        let (slots, keys): (&[u32], &[u64]) = (&self.slots, &self.keys);
        let mask = slots.len().checked_sub(1)?;
        let mut at = spread(key) as usize & mask;
        while slots[at] != 0 {
            let id = slots[at] - 1;
            // Two nodes may have one key.
            if keys[id as usize] == key && same(&self.nodes[id as usize]) {
                return Some(ExprId(id));
            }
            at = (at + 1) & mask;
        }
        None
    }

    fn push(&mut self, node: Node, key: u64, support: Support, below: u32) -> ExprId {
        let id = ExprId(self.nodes.len() as u32);
        self.depths.push(below + 1);
        self.flags.push(0);
        self.nodes.push(node);
        self.keys.push(key);
        self.supports.push(support);
        if self.slots.len() < 2 * self.nodes.len() {
            self.slots = vec![0; (4 * self.nodes.len()).next_power_of_two()];
            (0..self.nodes.len()).for_each(|index| self.place(index));
        } else {
            self.place(id.index());
        }
        id
    }

    /// Gives a node its place in the table.
    fn place(&mut self, index: usize) {
        let slots: &mut [u32] = &mut self.slots;
        let mask = slots.len() - 1;
        let mut at = spread(self.keys[index]) as usize & mask;
        while slots[at] != 0 {
            at = (at + 1) & mask;
        }
        slots[at] = index as u32 + 1;
    }

    fn sum_key(&self, constant: &Rational, terms: &[(ExprId, Rational)]) -> u64 {
        let keys: &[u64] = &self.keys;
        let mut hash = mix(0x2b00 ^ constant.hash64());
        let mut index = 0;
        while index < terms.len() {
            let (term, c) = &terms[index];
            hash = mix(hash ^ keys[term.0 as usize]) ^ c.hash64();
            index += 1;
        }
        hash
    }

    fn product_key(&self, factors: &[(ExprId, i32)]) -> u64 {
        let keys: &[u64] = &self.keys;
        let mut hash = mix(0x2a00);
        let mut index = 0;
        while index < factors.len() {
            let (base, e) = factors[index];
            hash = mix(mix(hash ^ keys[base.0 as usize]) ^ e as u64);
            index += 1;
        }
        hash
    }

    fn structural_key(&self, node: &Node) -> u64 {
        let rational = |value: &Rational| value.hash64();
        let key = |id: ExprId| self.keys[id.index()];
        match node {
            Node::Number(value) => mix(0x4e00 ^ rational(value)),
            Node::Pi => mix(0x5000),
            Node::Undefined => mix(0x5500),
            Node::Kept(x) => mix(0x4b00 ^ key(*x)),
            Node::Symbol(symbol) => key(self.symbol_nodes[symbol.index()]),
            Node::Sum { constant, terms } => self.sum_key(constant, terms),
            Node::Product(factors) => self.product_key(factors),
            Node::Function(function, x) => mix(mix(0x4600 ^ function.code()) ^ key(*x)),
            Node::Multivariate(Multivariate::Atan2, arguments) => {
                mix(mix(0x4100 ^ key(arguments[0])) ^ key(arguments[1]))
            }
            Node::Multivariate(function, arguments) => arguments
                .iter()
                .fold(mix(0x4d00 ^ function.code() << 16), |hash, argument| mix(hash ^ key(*argument))),
        }
    }
}
