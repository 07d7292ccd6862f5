//! Expressions as the optimiser sees them: sums and products whose coefficients are constants of the system.
//!
//! What comes in are expressions of the graph; what goes out is a net of sums `k_0 + sum k_i n_i`, products
//! `product n_i^e_i` and functions. The coefficients `k` are whole expressions of physical constants, which the
//! graph computes with exactly; in a program each is one prepared value. Nothing is flattened or expanded
//! once it is here, so that what a pass shares stays shared.

use super::marks::{Marks, Tables};
use super::passes::angles::{Angle, Angles};
use super::terms::{NetId, Powers};
use crate::algebra::{
    ExprId, FastMap, Function, Graph, Multivariate, Node, Rational, SortedMap, mix, spread,
};

/// A node of a net.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum NetNode {
    /// A symbol of the state, or whatever else is an atom.
    Atom(ExprId),
    /// A constant where a node is needed: an output, an argument.
    Constant(ExprId),
    /// `constant + sum coefficient * node`; the coefficients are not zero.
    Sum(Linear),
    /// `product node^exponent`; exponents are not zero.
    Product(Vec<(NetId, i32)>),
    /// An elementary function.
    Call(Function, NetId),
    /// A function of several arguments.
    Apply(Multivariate, Box<[NetId]>),
}

impl NetNode {
    fn hash(&self) -> u32 {
        let mut hash;
        match self {
            NetNode::Atom(e) => hash = mix(0x4100 ^ (e.0 as u64) << 16),
            NetNode::Constant(e) => hash = mix(0x4300 ^ (e.0 as u64) << 16),
            NetNode::Sum(linear) => {
                hash = mix(0x5300 ^ (linear.constant.0 as u64) << 16);
                let terms: &[(NetId, ExprId)] = &linear.terms;
                let mut index = 0;
                while index < terms.len() {
                    let (node, k) = terms[index];
                    hash = mix(hash ^ ((node.0 as u64) << 32 | k.0 as u64));
                    index += 1;
                }
            }
            NetNode::Product(factors) => {
                hash = 0x5000;
                let factors: &[(NetId, i32)] = factors;
                let mut index = 0;
                while index < factors.len() {
                    let (node, e) = factors[index];
                    hash = mix(hash ^ ((node.0 as u64) << 32 | e as u32 as u64));
                    index += 1;
                }
            }
            NetNode::Call(function, x) => hash = mix(function.code() << 32 ^ x.0 as u64),
            NetNode::Apply(function, arguments) => {
                hash = function.code() ^ 1 << 63;
                for argument in arguments {
                    hash = mix(hash ^ argument.0 as u64);
                }
            }
        }
        spread(hash)
    }

    /// The nodes directly below.
    pub(super) fn children(&self, mut visit: impl FnMut(NetId)) {
        match self {
            NetNode::Atom(_) | NetNode::Constant(_) => {}
            NetNode::Sum(linear) => {
                let terms: &[(NetId, ExprId)] = &linear.terms;
                let mut index = 0;
                while index < terms.len() {
                    visit(terms[index].0);
                    index += 1;
                }
            }
            NetNode::Product(factors) => {
                let factors: &[(NetId, i32)] = factors;
                let mut index = 0;
                while index < factors.len() {
                    visit(factors[index].0);
                    index += 1;
                }
            }
            NetNode::Call(_, x) => visit(*x),
            NetNode::Apply(_, arguments) => arguments.iter().for_each(|argument| visit(*argument)),
        }
    }
}

/// `constant + sum coefficient * node`, ordered by node.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Linear {
    pub(super) constant: ExprId,
    pub(super) terms: Vec<(NetId, ExprId)>,
}

/// An expression as a constant, or as a constant times a node.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Scaled {
    Constant(ExprId),
    Times(ExprId, NetId),
}

/// A hash-consed table of nodes.
#[derive(Default)]
pub(super) struct Net {
    nodes: Vec<NetNode>,
    hashes: Vec<u32>,
    /// Slots with one more than the number of a node, zero for none; a power of two of them.
    slots: Vec<u32>,
    tables: Tables,
}

impl Net {
    pub(super) fn node(&self, id: NetId) -> &NetNode {
        &self.nodes[id.0 as usize]
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// A number for each node that there is, zero at first.
    pub(super) fn marks(&self) -> Marks {
        self.tables.marks(self.nodes.len())
    }

    pub(super) fn intern(&mut self, node: NetNode) -> NetId {
        if self.slots.len() <= 2 * self.nodes.len() {
            self.grow();
        }
        let hash = node.hash();
        let (slots, hashes): (&mut [u32], &[u32]) = (&mut self.slots, &self.hashes);
        let mask = slots.len() - 1;
        let mut at = hash as usize & mask;
        while slots[at] != 0 {
            let found = slots[at] - 1;
            if hashes[found as usize] == hash && self.nodes[found as usize] == node {
                return NetId(found);
            }
            at = (at + 1) & mask;
        }
        let id = self.nodes.len() as u32;
        slots[at] = id + 1;
        self.nodes.push(node);
        self.hashes.push(hash);
        NetId(id)
    }

    fn grow(&mut self) {
        const FEWEST_SLOTS: usize = 256;
        let mut table = vec![0_u32; (4 * self.nodes.len()).next_power_of_two().max(FEWEST_SLOTS)];
        let (slots, hashes): (&mut [u32], &[u32]) = (&mut table, &self.hashes);
        let mask = slots.len() - 1;
        let mut index = 0;
        while index < hashes.len() {
            let mut at = hashes[index] as usize & mask;
            while slots[at] != 0 {
                at = (at + 1) & mask;
            }
            index += 1;
            slots[at] = index as u32;
        }
        self.slots = table;
    }

    /// `product node^exponent`; products among the nodes are opened.
    pub(super) fn product(&mut self, factors: &[(NetId, i32)]) -> NetId {
        let mut collected: Powers = SortedMap::with_capacity(factors.len() + 4);
        let mut next = 0;
        while next < factors.len() {
            let (node, e) = factors[next];
            next += 1;
            match self.node(node) {
                NetNode::Product(inner) => {
                    let inner: &[(NetId, i32)] = inner;
                    let mut index = 0;
                    while index < inner.len() {
                        let (node, k) = inner[index];
                        *collected.or_insert(node, 0) += k * e;
                        index += 1;
                    }
                }
                _ => *collected.or_insert(node, 0) += e,
            }
        }
        self.plain_product(collected)
    }

    /// Returns a product in which products among the nodes are kept as they are.
    pub(super) fn plain_product(&mut self, collected: Powers) -> NetId {
        let mut factors = collected.into_entries();
        let mut index = 0;
        while index < factors.len() {
            if factors[index].1 == 0 {
                factors.remove(index);
            } else {
                index += 1;
            }
        }
        match factors[..] {
            [(node, 1)] => node,
            _ => self.intern(NetNode::Product(factors)),
        }
    }

    /// A constant times a node, as a node.
    pub(super) fn scaled(&mut self, graph: &Graph, scaled: Scaled) -> NetId {
        match scaled {
            Scaled::Constant(k) => self.intern(NetNode::Constant(k)),
            Scaled::Times(k, node) if k == graph.one() => node,
            Scaled::Times(k, node) => {
                self.intern(NetNode::Sum(Linear { constant: graph.zero(), terms: vec![(node, k)] }))
            }
        }
    }

    /// A sum from terms that may repeat; coefficients that are zero drop out.
    pub(super) fn linear(
        &mut self,
        graph: &mut Graph,
        constants: &[(ExprId, Rational)],
        collected: &[(NetId, Vec<(ExprId, Rational)>)],
    ) -> Scaled {
        let constant = graph.linear(constants);
        let mut terms = Vec::with_capacity(collected.len());
        let mut index = 0;
        while index < collected.len() {
            let (node, coefficients) = &collected[index];
            let k = graph.linear(coefficients);
            if !graph.is_zero(k) {
                terms.push((*node, k));
            }
            index += 1;
        }
        self.primitive(graph, Linear { constant, terms })
    }

    /// A sum as a constant times a sum whose coefficients have no factor in common.
    pub(super) fn primitive(&mut self, graph: &mut Graph, mut linear: Linear) -> Scaled {
        let zero = graph.zero();
        match linear.terms[..] {
            [] => return Scaled::Constant(linear.constant),
            [(node, k)] if linear.constant == zero => return Scaled::Times(k, node),
            _ => {}
        }
        let mut coefficients: Vec<ExprId> = linear.terms.iter().map(|(_, k)| *k).collect();
        if linear.constant != zero {
            coefficients.push(linear.constant);
        }
        let content = common_factor(graph, &coefficients);
        if content != graph.one() {
            for (_, k) in &mut linear.terms {
                *k = graph.div(*k, content);
            }
            if linear.constant != zero {
                linear.constant = graph.div(linear.constant, content);
            }
        }
        Scaled::Times(content, self.intern(NetNode::Sum(linear)))
    }

    /// A sum as it is, except that `1 * node` is the node and nothing at all a constant.
    pub(super) fn sum(&mut self, graph: &Graph, linear: Linear) -> NetId {
        match linear.terms[..] {
            [] => self.intern(NetNode::Constant(linear.constant)),
            [(node, k)] if graph.is_zero(linear.constant) && k == graph.one() => node,
            _ => self.intern(NetNode::Sum(linear)),
        }
    }

    pub(super) fn children(&self, id: NetId, visit: impl FnMut(NetId)) {
        self.node(id).children(visit);
    }

    /// Everything below the roots, children first, and how many parents (or roots) use each node.
    pub(super) fn reachable(&self, roots: &[NetId]) -> (Vec<NetId>, Marks) {
        /// A share of the nodes below which those that are met are sorted, rather than all looked at.
        const SPARSE: usize = 16;
        let nodes: &[NetNode] = &self.nodes;
        let mut uses = self.marks();
        for root in roots {
            uses.set(*root, uses.get(*root) + 1);
        }
        let mut next = 0;
        while next < uses.written().len() {
            let index = uses.written()[next].0 as usize;
            nodes[index].children(|child| uses.set(child, uses.get(child) + 1));
            next += 1;
        }
        // Children are older than their parents.
        let mut found: Vec<NetId>;
        if SPARSE * uses.written().len() < nodes.len() {
            found = uses.written().to_vec();
            found.sort_unstable();
        } else {
            found = Vec::with_capacity(uses.written().len());
            for index in 0..nodes.len() as u32 {
                if uses.get(NetId(index)) > 0 {
                    found.push(NetId(index));
                }
            }
        }
        (found, uses)
    }
}

/// The constant without its sign, and whether it had one.
pub(super) fn split_sign(graph: &mut Graph, k: ExprId) -> (bool, ExprId) {
    let negative = match graph.node(k) {
        Node::Number(value) if value.is_minus_one() => return (true, graph.one()),
        Node::Number(value) => value.is_negative(),
        Node::Sum { constant, terms }
            if terms.len() == 1 && constant.is_zero() && terms[0].1.is_minus_one() =>
        {
            return (true, terms[0].0);
        }
        Node::Sum { terms, .. } => terms[0].1.is_negative(),
        _ => false,
    };
    if negative { (true, graph.neg(k)) } else { (false, k) }
}

/// A constant as a number times powers.
pub(super) fn constant_factors(graph: &mut Graph, k: ExprId) -> (Rational, Vec<(ExprId, i32)>) {
    if let Some(value) = graph.as_number(k) {
        return (value.clone(), Vec::new());
    }
    let (content, primitive) = graph.split_content(k);
    match graph.node(primitive) {
        Node::Product(factors) => (content, factors.to_vec()),
        _ => (content, vec![(primitive, 1)]),
    }
}

/// Returns the common factor of constants in their written form, above or below, with the sign of the first. No
/// division by something that may vanish is ever introduced: only written factors are taken out.
fn common_factor(graph: &mut Graph, constants: &[ExprId]) -> ExprId {
    let (mut content, mut common) = constant_factors(graph, constants[0]);
    let negative = content.is_negative();
    content = content.abs();
    for k in &constants[1..] {
        let (c, factors) = constant_factors(graph, *k);
        content = content.content_gcd(&c);
        for (base, e) in &mut common {
            let other = factors.iter().find(|(b, _)| b == base).map_or(0, |(_, e)| *e);
            *e = if (*e > 0) != (other > 0) {
                0
            } else if *e > 0 {
                (*e).min(other)
            } else {
                (*e).max(other)
            };
        }
    }
    let number = graph.number(if negative { -content } else { content });
    let product = graph.product(&common);
    graph.mul(number, product)
}

/// The expressions that count as coefficients.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Field {
    /// Everything that depends on physical constants alone: for functions of the state.
    Constants,
    /// Numbers only: for `prepare` itself.
    Numbers,
}

impl Field {
    pub(super) fn contains(self, graph: &Graph, id: ExprId) -> bool {
        match self {
            Field::Constants => graph.roles(id).is_constant(),
            Field::Numbers => graph.as_number(id).is_some(),
        }
    }
}

/// Turns expressions into nodes.
pub(super) struct Conversion<'a> {
    graph: &'a mut Graph,
    net: &'a mut Net,
    field: Field,
    done: FastMap<ExprId, Scaled>,
    uses: FastMap<ExprId, u32>,
    angles: Angles,
}

impl<'a> Conversion<'a> {
    pub(super) fn roots(
        graph: &'a mut Graph,
        net: &'a mut Net,
        field: Field,
        roots: &[ExprId],
    ) -> Vec<NetId> {
        let pending = graph.reachable(roots, |id| field.contains(graph, id));
        let mut uses: FastMap<ExprId, u32> = FastMap::default();
        for id in pending.iter().flat_map(|id| graph.children(*id)).chain(roots.iter().copied()) {
            *uses.or_default(id) += 1;
        }
        let angles = match field {
            Field::Constants => Angles::of(graph, &pending),
            Field::Numbers => Angles::default(),
        };
        let mut conversion = Conversion { graph, net, field, done: FastMap::default(), uses, angles };
        for id in pending {
            let scaled = conversion.step(id);
            conversion.done.insert(id, scaled);
        }
        roots
            .iter()
            .map(|root| {
                let scaled = conversion.known(*root);
                conversion.net.scaled(conversion.graph, scaled)
            })
            .collect()
    }

    fn known(&self, id: ExprId) -> Scaled {
        self.done.get(&id).copied().unwrap_or(Scaled::Constant(id))
    }

    fn node_of(&mut self, id: ExprId) -> NetId {
        let scaled = self.known(id);
        self.net.scaled(self.graph, scaled)
    }

    fn step(&mut self, id: ExprId) -> Scaled {
        let one = self.graph.one();
        match self.graph.node(id).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => {
                Scaled::Times(one, self.net.intern(NetNode::Atom(id)))
            }
            Node::Sum { constant, terms } => {
                let mut constants = vec![(one, constant)];
                let mut collected: SortedMap<NetId, Vec<(ExprId, Rational)>> = SortedMap::default();
                for (term, c) in terms.iter() {
                    match self.known(*term) {
                        Scaled::Constant(k) => constants.push((k, c.clone())),
                        Scaled::Times(k, node) => match self.net.node(node) {
                            // A sum that nothing else uses is part of this one.
                            NetNode::Sum(inner) if self.uses.get(term) == Some(&1) => {
                                let inner = inner.clone();
                                constants.push((self.graph.mul(k, inner.constant), c.clone()));
                                for (node, coefficient) in inner.terms {
                                    let k = self.graph.mul(k, coefficient);
                                    collected.or_insert(node, Vec::new()).push((k, c.clone()));
                                }
                            }
                            _ => collected.or_insert(node, Vec::new()).push((k, c.clone())),
                        },
                    }
                }
                self.net.linear(self.graph, &constants, collected.entries())
            }
            Node::Product(factors) => {
                let mut constants = Vec::new();
                let mut rest = Vec::new();
                for (base, e) in factors.iter() {
                    match self.known(*base) {
                        Scaled::Constant(k) => constants.push((k, *e)),
                        Scaled::Times(k, node) => {
                            constants.push((k, *e));
                            rest.push((node, *e));
                        }
                    }
                }
                let k = self.graph.product(&constants);
                Scaled::Times(k, self.net.product(&rest))
            }
            Node::Function(function @ (Function::Sin | Function::Cos), x) => match self.angles.get(x) {
                Some(angle) => {
                    let angle = angle.clone();
                    self.angle(function, &angle)
                }
                None => self.call(function, x),
            },
            Node::Function(function, x) => self.call(function, x),
            Node::Kept(x) => self.known(x),
            Node::Multivariate(function, arguments) => {
                let arguments = arguments.iter().map(|x| self.node_of(*x)).collect();
                Scaled::Times(one, self.net.intern(NetNode::Apply(function, arguments)))
            }
        }
    }

    fn call(&mut self, function: Function, x: ExprId) -> Scaled {
        let x = self.node_of(x);
        Scaled::Times(self.graph.one(), self.net.intern(NetNode::Call(function, x)))
    }

    /// Sine or cosine of a sum of multiples of base angles, by rotating one base angle after the other.
    fn angle(&mut self, function: Function, angle: &Angle) -> Scaled {
        let mut turned: Option<(NetId, NetId)> = None;
        for (base, multiple) in angle {
            let base = self.base_angle(*base);
            let sine = self.net.intern(NetNode::Call(Function::Sin, base));
            let cosine = self.net.intern(NetNode::Call(Function::Cos, base));
            let single = (sine, cosine);
            let mut part = single;
            for _ in 1..multiple.unsigned_abs() {
                part = self.rotate(part, single, false);
            }
            turned = Some(match turned {
                None if *multiple < 0 => (self.negated(part.0), part.1),
                None => part,
                Some(turned) => self.rotate(turned, part, *multiple < 0),
            });
        }
        let pair = turned.expect("an angle has at least one part");
        Scaled::Times(self.graph.one(), if function == Function::Sin { pair.0 } else { pair.1 })
    }

    fn base_angle(&mut self, base: ExprId) -> NetId {
        // Multiples such as theta/2 need not occur anywhere else.
        if self.field.contains(self.graph, base) || self.done.contains_key(&base) {
            return self.node_of(base);
        }
        let scaled = self.step(base);
        self.net.scaled(self.graph, scaled)
    }

    fn negated(&mut self, node: NetId) -> NetId {
        let minus = self.graph.number(-1);
        self.net.scaled(self.graph, Scaled::Times(minus, node))
    }

    /// `sin, cos (a + b)` or `(a - b)`.
    fn rotate(&mut self, a: (NetId, NetId), b: (NetId, NetId), backwards: bool) -> (NetId, NetId) {
        let (one, zero) = (self.graph.one(), self.graph.zero());
        let minus = self.graph.number(-1);
        let (plus, minus) = if backwards { (minus, one) } else { (one, minus) };
        let (ss, cc) = (self.net.product(&[(a.0, 1), (b.0, 1)]), self.net.product(&[(a.1, 1), (b.1, 1)]));
        let (sc, cs) = (self.net.product(&[(a.0, 1), (b.1, 1)]), self.net.product(&[(a.1, 1), (b.0, 1)]));
        let mut sum = |x: NetId, k: ExprId, y: NetId| {
            let mut terms = vec![(x, one), (y, k)];
            if x == y {
                terms = vec![(x, self.graph.add(one, k))];
            }
            terms.sort_unstable();
            self.net.intern(NetNode::Sum(Linear { constant: zero, terms }))
        };
        (sum(sc, plus, cs), sum(cc, minus, ss))
    }
}
