//! The graph: nodes, symbols, and the table that makes equal nodes one.

use std::cell::Cell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use super::angles::BaseAngles;
use super::{Function, Rational};

/// An expression of a [`Graph`]; children always have smaller identifiers than their parents.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ExprId(pub(crate) u32);

impl ExprId {
    /// The position in the graph's table of nodes.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A symbol of a [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct SymbolId(pub(crate) u32);

impl SymbolId {
    /// The position in the graph's table of symbols.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a symbol stands for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Role {
    /// The time `t`.
    Time,
    /// A physical constant.
    Constant,
    /// A coordinate `x_i`.
    Coordinate,
    /// The rate `x_i'` of a coordinate.
    Velocity,
    /// A quasi-velocity `eta_j`.
    QuasiVelocity,
    /// The rate `eta_s'` of a quasi-velocity.
    QuasiAcceleration,
    /// A control input.
    Input,
}

/// A set of [`Role`]s: which kinds of symbol occur below a node.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Roles(u8);

impl Roles {
    /// No role at all.
    pub const NONE: Roles = Roles(0);

    /// The set of one role.
    pub const fn of(role: Role) -> Self {
        Roles(1 << role as u8)
    }

    /// The union.
    pub const fn or(self, other: Roles) -> Self {
        Roles(self.0 | other.0)
    }

    /// Whether the role is in the set.
    pub const fn has(self, role: Role) -> bool {
        self.0 & (1 << role as u8) != 0
    }

    /// Whether both sets share a role.
    pub const fn meets(self, other: Roles) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether nothing beyond physical constants occurs.
    pub const fn is_constant(self) -> bool {
        self.0 & !Roles::of(Role::Constant).0 == 0
    }
}

/// What a declaration promises about a physical constant.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Bound {
    /// Nothing.
    #[default]
    Free,
    /// `c > 0`.
    Positive,
    /// `c >= 0`.
    NonNegative,
    /// `c < 0`.
    Negative,
    /// `c <= 0`.
    NonPositive,
    /// `c != 0`.
    NonZero,
}

/// A named symbol.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// The name in the declaration.
    pub name: String,
    /// What it stands for.
    pub role: Role,
    /// The promise about its value.
    pub bound: Bound,
}

/// A node of the graph, in normal form.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Node {
    /// An exact number.
    Number(Rational),
    /// The number pi.
    Pi,
    /// A symbol.
    Symbol(SymbolId),
    /// `constant + sum coefficient * term`; at least one term, and more than that or not simply `1 * term`.
    Sum {
        /// The number added.
        constant: Rational,
        /// Terms with coefficients that are not zero, in the graph's order.
        terms: Box<[(ExprId, Rational)]>,
    },
    /// `product base^exponent`; exponents are not zero; not simply `base^1`.
    Product(Box<[(ExprId, i32)]>),
    /// An elementary function of one argument.
    Function(Function, ExprId),
    /// `atan2(y, x)`.
    Atan2(ExprId, ExprId),
    /// An expression that is kept whole: equal to what is inside, but neither flattened nor expanded into its users.
    Kept(ExprId),
    /// The result of a division by the number zero; whoever divides asks first, so that it shows a mistake of ours.
    Undefined,
}

/// Why a power was refused.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PowerError {
    /// The exponent is not a number.
    ExponentNotNumber,
    /// The exponent, or the number that would result, is too large.
    TooLarge,
    /// An even root of a negative number.
    NegativeBase,
    /// A negative power of zero.
    DivisionByZero,
}

/// Structural hashes are good hashes already.
#[derive(Default)]
pub(crate) struct Identity(u64);

impl Hasher for Identity {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(byte.into());
        }
    }
    fn write_u32(&mut self, value: u32) {
        self.write_u64(value.into());
    }
    fn write_u64(&mut self, value: u64) {
        self.0 = mix(self.0 ^ value);
    }
    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }
}

/// A map for look-ups only: nothing iterates over it, so its order never reaches an expansion.
pub(crate) type FastMap<K, V> = HashMap<K, V, BuildHasherDefault<Identity>>;

/// The finaliser of the splitmix64 generator (Steele, Lea, Flood 2014): a fixed mixing of 64 bits.
pub(crate) fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

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
    roles: Vec<Roles>,
    depths: Vec<u32>,
    // A cell, because looking at expressions is work too.
    work: Cell<u64>,
    // Chains of nodes that share a key: a list per key, since two nodes may collide.
    heads: FastMap<u64, ExprId>,
    next: Vec<Option<ExprId>>,
    symbols: Vec<Symbol>,
    symbol_nodes: Vec<ExprId>,
    role_counts: [u32; 8],
    pub(super) base_angles: BaseAngles,
}

impl Graph {
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

    /// Which kinds of symbol occur in an expression.
    pub fn roles(&self, id: ExprId) -> Roles {
        self.roles[id.index()]
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
        self.bounded_symbol(name, role, Bound::Free)
    }

    /// A new symbol with a promise about its value.
    pub fn bounded_symbol(&mut self, name: &str, role: Role, bound: Bound) -> ExprId {
        let id = SymbolId(self.symbols.len() as u32);
        let ordinal = self.role_counts[role as usize];
        self.role_counts[role as usize] += 1;
        self.symbols.push(Symbol { name: name.to_owned(), role, bound });
        // The key is the place in the declaration, not the name: renaming must not change rounding.
        let key = mix(mix(0x5300 + role as u64) ^ u64::from(ordinal));
        let node = self.push(Node::Symbol(id), key, Roles::of(role));
        self.symbol_nodes.push(node);
        node
    }

    /// What is known of a symbol.
    pub fn symbol_info(&self, symbol: SymbolId) -> &Symbol {
        &self.symbols[symbol.index()]
    }

    /// The expression that a symbol is.
    pub fn symbol_expr(&self, symbol: SymbolId) -> ExprId {
        self.symbol_nodes[symbol.index()]
    }

    /// All symbols, in the order of their making.
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
            Node::Atan2(y, x) => vec![*y, *x],
        }
    }

    /// Everything below `roots`, roots included, children first; nodes for which `stop` holds are not entered nor listed.
    pub fn reachable(&self, roots: &[ExprId], mut stop: impl FnMut(ExprId) -> bool) -> Vec<ExprId> {
        // A bit for each node: clearing them is nothing beside the nodes that are visited.
        let mut seen = vec![0_u64; self.nodes.len() / 64 + 1];
        let mut found = Vec::new();
        let mut stack = roots.to_vec();
        while let Some(id) = stack.pop() {
            let (word, bit) = (id.index() / 64, 1_u64 << (id.index() % 64));
            if seen[word] & bit != 0 {
                continue;
            }
            seen[word] |= bit;
            if stop(id) {
                continue;
            }
            found.push(id);
            match self.node(id) {
                Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => {}
                Node::Sum { terms, .. } => stack.extend(terms.iter().map(|t| t.0)),
                Node::Product(factors) => stack.extend(factors.iter().map(|f| f.0)),
                Node::Function(_, x) | Node::Kept(x) => stack.push(*x),
                Node::Atan2(y, x) => stack.extend([*y, *x]),
            }
        }
        self.spend(found.len());
        found.sort_unstable();
        found
    }

    /// The symbols that occur in an expression, in the order of their making.
    pub fn symbols_in(&self, roots: &[ExprId]) -> Vec<SymbolId> {
        let mut symbols: Vec<_> =
            self.reachable(roots, |_| false).into_iter().filter_map(|id| self.as_symbol(id)).collect();
        symbols.sort_unstable();
        symbols
    }

    fn spend(&self, steps: usize) {
        self.work.set(self.work.get() + steps as u64);
    }

    /// The identifier of a node in normal form.
    pub(crate) fn intern(&mut self, node: Node) -> ExprId {
        self.spend(match &node {
            Node::Sum { terms, .. } => 1 + terms.len(),
            Node::Product(factors) => 1 + factors.len(),
            _ => 1,
        });
        let key = self.structural_key(&node);
        if let Some(id) = self.lookup_key(key, &node) {
            return id;
        }
        let roles = match &node {
            Node::Symbol(_) => unreachable!("symbols are made by `symbol`"),
            Node::Number(_) | Node::Pi | Node::Undefined => Roles::NONE,
            Node::Sum { terms, .. } => {
                terms.iter().fold(Roles::NONE, |roles, (term, _)| roles.or(self.roles(*term)))
            }
            Node::Product(factors) => {
                factors.iter().fold(Roles::NONE, |roles, (base, _)| roles.or(self.roles(*base)))
            }
            Node::Function(_, x) | Node::Kept(x) => self.roles(*x),
            Node::Atan2(y, x) => self.roles(*y).or(self.roles(*x)),
        };
        self.push(node, key, roles)
    }

    /// The identifier of a node, if the graph has it already.
    pub(crate) fn find(&self, node: &Node) -> Option<ExprId> {
        self.lookup_key(self.structural_key(node), node)
    }

    fn lookup_key(&self, key: u64, node: &Node) -> Option<ExprId> {
        let mut candidate = self.heads.get(&key).copied();
        while let Some(id) = candidate {
            if self.node(id) == node {
                return Some(id);
            }
            candidate = self.next[id.index()];
        }
        None
    }

    fn push(&mut self, node: Node, key: u64, roles: Roles) -> ExprId {
        let id = ExprId(self.nodes.len() as u32);
        let depth = |child: &ExprId| self.depths[child.index()];
        let below = match &node {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => 0,
            Node::Sum { terms, .. } => terms.iter().map(|(term, _)| depth(term)).max().unwrap_or(0),
            Node::Product(factors) => factors.iter().map(|(base, _)| depth(base)).max().unwrap_or(0),
            Node::Function(_, x) | Node::Kept(x) => depth(x),
            Node::Atan2(y, x) => depth(y).max(depth(x)),
        };
        self.depths.push(below + 1);
        self.nodes.push(node);
        self.keys.push(key);
        self.roles.push(roles);
        let head = self.heads.insert(key, id);
        self.next.push(head);
        id
    }

    fn structural_key(&self, node: &Node) -> u64 {
        let rational = |value: &Rational| match value.to_i64_pair() {
            Some((n, d)) => mix(n as u64) ^ mix(d as u64).rotate_left(1),
            None => {
                let (n, d) = value.to_big_pair();
                n.iter_u64_digits()
                    .chain(d.iter_u64_digits())
                    .fold(u64::from(value.is_negative()), |h, w| mix(h ^ w))
            }
        };
        let key = |id: ExprId| self.keys[id.index()];
        match node {
            Node::Number(value) => mix(0x4e00 ^ rational(value)),
            Node::Pi => mix(0x5000),
            Node::Undefined => mix(0x5500),
            Node::Kept(x) => mix(0x4b00 ^ key(*x)),
            Node::Symbol(symbol) => key(self.symbol_nodes[symbol.index()]),
            Node::Sum { constant, terms } => terms
                .iter()
                .fold(mix(0x2b00 ^ rational(constant)), |h, (term, c)| mix(h ^ key(*term)) ^ rational(c)),
            Node::Product(factors) => {
                factors.iter().fold(mix(0x2a00), |h, (base, e)| mix(mix(h ^ key(*base)) ^ *e as u64))
            }
            Node::Function(function, x) => mix(mix(0x4600 ^ function.code()) ^ key(*x)),
            Node::Atan2(y, x) => mix(mix(0x4100 ^ key(*y)) ^ key(*x)),
        }
    }
}
