//! Pairs of factors shared by several products become nodes of their own, the most frequent pair first.
//!
//! A monomial is a coefficient and powers of nodes; a power `x^-2` counts as the factor `1/x` twice. The counts
//! are kept up to date in a heap, so the work is near-linear in the sizes of the monomials, which are small.

use super::super::net::{Linear, Net, NetNode, constant_factors, split_sign};
use super::super::terms::NetId;
use super::super::terms::{Powers, Terms, add_term};
use super::Changes;
use crate::algebra::{ExprId, FastMap, Graph, Key, Rational, spread};
use crate::program::thresholds::{MONOMIAL_FACTORS, MONOMIALS};

/// A factor that pairs are made of, in one word: comparing and hashing pairs is most of the work.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
struct Literal(u32);

#[derive(Clone, Copy, Debug)]
enum Factor {
    Above(NetId),
    Below(NetId),
    Constant(ExprId),
}

const TAG_BIT: u32 = 30;

impl Key for Literal {
    fn hash(&self) -> u32 {
        spread(self.0 as u64)
    }
}

impl Key for Pair {
    fn hash(&self) -> u32 {
        spread(self.0)
    }
}

impl Literal {
    fn new(factor: Factor) -> Self {
        let (tag, id) = match factor {
            Factor::Above(node) => (0, node.0),
            Factor::Below(node) => (1, node.0),
            Factor::Constant(k) => (2, k.0),
        };
        debug_assert!(id >> TAG_BIT == 0, "the graph has more than 2^30 nodes");
        Literal(tag << TAG_BIT | id)
    }

    fn factor(self) -> Factor {
        let id = self.0 & ((1 << TAG_BIT) - 1);
        match self.0 >> TAG_BIT {
            0 => Factor::Above(NetId(id)),
            1 => Factor::Below(NetId(id)),
            _ => Factor::Constant(ExprId(id)),
        }
    }

    fn is_constant(self) -> bool {
        self.0 >> TAG_BIT == 2
    }
}

/// Two factors, the smaller first; twice the same is a square.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
struct Pair(u64);

impl Pair {
    fn new(a: Literal, b: Literal) -> Self {
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        Pair(u64::from(a.0) << 32 | u64::from(b.0))
    }

    fn literals(self) -> (Literal, Literal) {
        (Literal((self.0 >> 32) as u32), Literal(self.0 as u32))
    }
}

/// Powers of factors, in no order that matters; short.
type Monomial = Vec<(Literal, u32)>;

#[derive(Default)]
struct Search {
    monomials: Vec<Monomial>,
    occurrences: FastMap<Literal, Vec<u32>>,
    counts: FastMap<Pair, u32>,
    heap: Heap,
}

/// Counts with their pairs, the largest count first, of equal counts the smallest pair: a binary heap of plain words.
#[derive(Default)]
struct Heap(Vec<u128>);

impl Heap {
    fn push(&mut self, count: u32, pair: Pair) {
        self.0.push((count as u128) << 64 | !pair.0 as u128);
        let words: &mut [u128] = &mut self.0;
        let mut at = words.len() - 1;
        let word = words[at];
        while at > 0 && words[(at - 1) / 2] < word {
            words[at] = words[(at - 1) / 2];
            at = (at - 1) / 2;
        }
        words[at] = word;
    }

    fn pop(&mut self) -> Option<(u32, Pair)> {
        let last = self.0.pop()?;
        let words: &mut [u128] = &mut self.0;
        let mut top = last;
        if !words.is_empty() {
            top = words[0];
            let mut at = 0;
            loop {
                let mut child = 2 * at + 1;
                if child >= words.len() {
                    break;
                }
                if child + 1 < words.len() && words[child] < words[child + 1] {
                    child += 1;
                }
                if words[child] <= last {
                    break;
                }
                words[at] = words[child];
                at = child;
            }
            words[at] = last;
        }
        Some(((top >> 64) as u32, Pair(!(top as u64))))
    }
}

impl Search {
    fn add(&mut self, monomial: Monomial) -> usize {
        let index = self.monomials.len();
        for (literal, _) in &monomial {
            self.occurrences.or_default(*literal).push(index as u32);
        }
        self.monomials.push(monomial);
        index
    }

    /// Counts all pairs once everything is added. A factor of one monomial only is in no pair of two.
    fn count_all(&mut self) {
        let mut shared: Monomial = Vec::new();
        for monomial in &self.monomials {
            if monomial.len() > MONOMIAL_FACTORS {
                continue;
            }
            shared.clear();
            let monomial: &[(Literal, u32)] = monomial;
            let mut index = 0;
            while index < monomial.len() {
                if self.occurrences[&monomial[index].0].len() >= 2 {
                    shared.push(monomial[index]);
                }
                index += 1;
            }
            let shared: &[(Literal, u32)] = &shared;
            index = 0;
            while index < shared.len() {
                let (a, n) = shared[index];
                if n >= 2 {
                    *self.counts.or_default(Pair::new(a, a)) += 1;
                }
                index += 1;
                let mut other = index;
                while other < shared.len() {
                    let b = shared[other].0;
                    if !(a.is_constant() && b.is_constant()) {
                        *self.counts.or_default(Pair::new(a, b)) += 1;
                    }
                    other += 1;
                }
            }
        }
        for (pair, n) in self.counts.iter() {
            if *n >= 2 {
                self.heap.push(*n, *pair);
            }
        }
    }

    /// Counts one more or one less of a pair; pairs that were never counted cannot become frequent by losing some. Those of a factor that
    /// was in one monomial only were not counted either, and a join may put it into a second one: of such a pair fewer are
    /// counted than there are, and more may go than were counted.
    fn change(&mut self, pair: Pair, up: bool) {
        if up {
            let count = self.counts.or_default(pair);
            *count += 1;
            if *count >= 2 {
                self.heap.push(*count, pair);
            }
        } else if let Some(count) = self.counts.get_mut(&pair) {
            *count = count.saturating_sub(1);
        }
    }

    /// Joins pairs for as long as there is one; whether there was any.
    fn run(&mut self, graph: &Graph, net: &mut Net) -> bool {
        let mut joined = false;
        self.count_all();
        while let Some((count, pair)) = self.heap.pop() {
            let current = self.counts.get(&pair).copied().unwrap_or(0);
            if current != count {
                // Counts only fall between pushes: what is left of this pair waits for its turn.
                if current >= 2 && current < count {
                    self.heap.push(current, pair);
                }
                continue;
            }
            self.replace(pair, join(graph, net, pair));
            joined = true;
        }
        joined
    }

    /// Puts the joined factor in the place of the pair wherever the pair occurs.
    fn replace(&mut self, pair: Pair, joined: Literal) {
        let (a, b) = pair.literals();
        let users = self.occurrences
            [if self.occurrences[&a].len() <= self.occurrences[&b].len() { &a } else { &b }]
        .clone();
        for index in users {
            let monomial = &self.monomials[index as usize];
            if monomial.len() > MONOMIAL_FACTORS {
                continue;
            }
            let (na, nb) = (power(monomial, a), power(monomial, b));
            let times = if a == b { na / 2 } else { na.min(nb) };
            if times == 0 {
                continue;
            }
            let mut monomial = core::mem::take(&mut self.monomials[index as usize]);
            let is_new = power(&monomial, joined) == 0;
            let used = if a == b { 2 * times } else { times };
            for (literal, before) in [(a, na), (b, nb)] {
                let after = before - used;
                if before >= 2 && after < 2 {
                    self.change(Pair::new(literal, literal), false);
                }
                if after == 0 {
                    let mut place = 0;
                    while place < monomial.len() {
                        let other = monomial[place].0;
                        if other != literal && !(other.is_constant() && literal.is_constant()) {
                            self.change(Pair::new(literal, other), false);
                        }
                        place += 1;
                    }
                    monomial.retain(|(l, _)| *l != literal);
                } else if let Some(entry) = monomial.iter_mut().find(|(l, _)| *l == literal) {
                    entry.1 = after;
                }
                if a == b {
                    break;
                }
            }
            if is_new {
                let mut place = 0;
                while place < monomial.len() {
                    self.change(Pair::new(joined, monomial[place].0), true);
                    place += 1;
                }
                if times >= 2 {
                    self.change(Pair::new(joined, joined), true);
                }
                monomial.push((joined, times));
                self.occurrences.or_default(joined).push(index);
            } else if let Some(entry) = monomial.iter_mut().find(|(l, _)| *l == joined) {
                if entry.1 < 2 && entry.1 + times >= 2 {
                    self.change(Pair::new(joined, joined), true);
                }
                entry.1 += times;
            }
            self.monomials[index as usize] = monomial;
        }
        // What is left over of the pair, if anything, are odd powers: they cannot be joined again.
        self.counts.insert(pair, 0);
    }
}

/// The power of a factor in a monomial, zero if it does not occur.
fn power(monomial: &[(Literal, u32)], literal: Literal) -> u32 {
    let mut index = 0;
    while index < monomial.len() {
        if monomial[index].0.0 == literal.0 {
            return monomial[index].1;
        }
        index += 1;
    }
    0
}

/// The factor that stands for a pair.
fn join(graph: &Graph, net: &mut Net, pair: Pair) -> Literal {
    use Factor::{Above, Below, Constant};
    let mut product = |a: (NetId, i32), b: (NetId, i32)| {
        let mut factors = Powers::from_sorted(vec![a]);
        *factors.or_insert(b.0, 0) += b.1;
        net.plain_product(factors)
    };
    let (a, b) = pair.literals();
    Literal::new(match (a.factor(), b.factor()) {
        (Below(a), Below(b)) => Below(product((a, 1), (b, 1))),
        (Above(a), Above(b)) => Above(product((a, 1), (b, 1))),
        (Above(a), Below(b)) | (Below(b), Above(a)) => Above(product((a, 1), (b, -1))),
        (Above(a), Constant(k)) | (Constant(k), Above(a)) => {
            Above(net.intern(NetNode::Sum(Linear { constant: graph.zero(), terms: vec![(a, k)] })))
        }
        (Below(a), Constant(k)) | (Constant(k), Below(a)) => {
            let reciprocal = net.plain_product(Powers::from_sorted(vec![(a, -1)]));
            Above(net.intern(NetNode::Sum(Linear { constant: graph.zero(), terms: vec![(reciprocal, k)] })))
        }
        (Constant(_), Constant(_)) => unreachable!("constants are not paired with each other"),
    })
}

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId], split_constants: bool) -> Changes {
    let (nodes, _) = net.reachable(roots);
    let mut changes = Changes::default();
    let mut search = Search::default();
    // Each coefficient (without its sign) and node once, with its index among the monomials.
    let mut known: FastMap<(ExprId, NetId), usize> = FastMap::default();
    let one = graph.one();
    let mut places: Vec<(NetId, Vec<(bool, usize)>)> = Vec::new();
    let mut inner_products: Vec<(NetId, usize)> = Vec::new();
    // Products that occur as whole values, not only as a term with a coefficient.
    let mut whole: Vec<NetId> = roots.to_vec();
    for id in &nodes {
        if let NetNode::Sum(linear) = net.node(*id) {
            let terms = linear.terms.clone();
            let mut place = Vec::with_capacity(terms.len());
            for (node, k) in terms {
                let (negative, k) = split_sign(graph, k);
                place.push((
                    negative,
                    monomial(graph, net, &mut search, &mut known, k, node, split_constants),
                ));
            }
            places.push((*id, place));
        } else {
            net.children(*id, |child| whole.push(child));
        }
    }
    // In the order of their numbers, each once.
    let mut is_whole = net.marks();
    whole.into_iter().for_each(|id| is_whole.set(id, 1));
    for id in nodes {
        if is_whole.get(id) != 0 && matches!(net.node(id), NetNode::Product(_)) {
            let index = monomial(graph, net, &mut search, &mut known, one, id, split_constants);
            inner_products.push((id, index));
        }
    }
    if search.monomials.len() > MONOMIALS {
        return changes;
    }
    if !search.run(graph, net) {
        return changes;
    }
    let minus = graph.number(-1);
    for (id, place) in places {
        let NetNode::Sum(linear) = net.node(id) else { continue };
        let constant = linear.constant;
        let mut collected = Terms::with_capacity(place.len());
        for (negative, index) in place {
            let (k, node) = finish(graph, net, &search.monomials[index]);
            let k = if negative { graph.mul(k, minus) } else { k };
            add_term(graph, &mut collected, node, k);
        }
        let terms = collected.into_entries();
        let unchanged = matches!(net.node(id), NetNode::Sum(linear) if linear.terms == terms);
        if !unchanged && terms != [(id, one)] {
            changes.insert(id, NetNode::Sum(Linear { constant, terms }));
        }
    }
    for (id, index) in inner_products {
        let (_, node) = finish(graph, net, &search.monomials[index]);
        if node != id {
            changes.insert(id, NetNode::Product(vec![(node, 1)]));
        }
    }
    changes
}

fn monomial(
    graph: &mut Graph,
    net: &Net,
    search: &mut Search,
    known: &mut FastMap<(ExprId, NetId), usize>,
    k: ExprId,
    node: NetId,
    split_constants: bool,
) -> usize {
    if let Some(index) = known.get(&(k, node)) {
        return *index;
    }
    let mut literals = Monomial::new();
    let single = [(node, 1)];
    let factors: &[(NetId, i32)] = match net.node(node) {
        NetNode::Product(factors) => factors,
        _ => &single,
    };
    for (node, e) in factors {
        let factor = if *e > 0 { Factor::Above(*node) } else { Factor::Below(*node) };
        literals.push((Literal::new(factor), e.unsigned_abs()));
    }
    let mut constants = Vec::new();
    if k != graph.one() {
        if split_constants {
            let (number, powers) = constant_factors(graph, k);
            for (base, e) in powers {
                let power = graph.powi(base, e);
                constants.push(power);
            }
            if number != Rational::ONE {
                let number = graph.number(number);
                constants.push(number);
            }
        } else {
            constants.push(k);
        }
    }
    literals.extend(constants.into_iter().map(|k| (Literal::new(Factor::Constant(k)), 1)));
    let index = search.add(literals);
    known.insert((k, node), index);
    index
}

/// Returns the rest of a monomial, as a coefficient and a node.
fn finish(graph: &mut Graph, net: &mut Net, monomial: &[(Literal, u32)]) -> (ExprId, NetId) {
    let mut constants = Vec::new();
    let mut factors = Powers::with_capacity(monomial.len());
    for (literal, n) in monomial {
        match literal.factor() {
            Factor::Above(node) => *factors.or_insert(node, 0) += *n as i32,
            Factor::Below(node) => *factors.or_insert(node, 0) -= *n as i32,
            Factor::Constant(k) => constants.push((k, 1)),
        }
    }
    let k = match constants[..] {
        [] => graph.one(),
        [(k, 1)] => k,
        _ => graph.product(&constants),
    };
    (k, net.plain_product(factors))
}

#[cfg(test)]
mod tests {
    use super::{Factor, Literal, Monomial, Net, NetNode, Powers, Search};
    use crate::algebra::{Graph, Role};

    /// A pair may be joined into a node that is a factor already, of one monomial only.
    #[test]
    fn products_that_are_factors() {
        let mut word = 1_u64;
        let mut below = |n: usize| {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (word >> 33) as usize % n
        };
        let mut joined = 0;
        for _ in 0..3_000 {
            let mut graph = Graph::new();
            let mut net = Net::default();
            let mut factors = Vec::new();
            for name in ["a", "b", "c", "d", "e"] {
                let symbol = graph.symbol(name, Role::Coordinate);
                factors.push(net.intern(NetNode::Atom(symbol)));
            }
            for (i, j) in [(0, 1), (1, 2), (0, 2), (3, 4)] {
                let product = Powers::from_sorted(vec![(factors[i], 1), (factors[j], 1)]);
                factors.push(net.plain_product(product));
            }
            let mut search = Search::default();
            for _ in 0..3 + below(5) {
                let mut monomial = Monomial::new();
                for _ in 0..1 + below(5) {
                    let literal = Literal::new(Factor::Above(factors[below(factors.len())]));
                    match monomial.iter_mut().find(|(known, _)| *known == literal) {
                        Some((_, power)) => *power += 1,
                        None => monomial.push((literal, 1)),
                    }
                }
                search.add(monomial);
            }
            joined += usize::from(search.run(&graph, &mut net));
        }
        assert!(joined > 1_000, "{joined}");
    }
}
