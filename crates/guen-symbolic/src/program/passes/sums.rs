//! Pairs of terms that several sums have in the same ratio become sums of their own, the best pair first.
//!
//! `k a + k r b + ..` and `q a + q r b + ..` share `z = a + r b`. The ratio must be one in which nothing new is
//! divided by: a constant that is not known to differ from zero never becomes a denominator.

use std::collections::{BTreeMap, BTreeSet};

use super::super::net::{Linear, Net, NetId, NetNode, constant_factors};
use super::{Changes, is_unit};
use crate::algebra::{ExprId, FastMap, Graph};

/// Sums with more terms that occur elsewhere take no part: pairs grow with the square.
const LONGEST_SUM: usize = 40;
/// The number of pairs that is looked at.
const LARGEST_PROBLEM: usize = 6_000;

struct Row {
    id: NetId,
    constant: ExprId,
    terms: BTreeMap<NetId, ExprId>,
}

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId]) -> Changes {
    let (nodes, _) = net.reachable(roots);
    let mut rows: Vec<Row> = Vec::new();
    for id in nodes {
        if let NetNode::Sum(linear) = net.node(id)
            && linear.terms.len() >= 2
        {
            rows.push(Row { id, constant: linear.constant, terms: linear.terms.iter().copied().collect() });
        }
    }
    let mut touched = vec![false; rows.len()];
    let mut ratios = Ratios::default();
    // Every round takes all pairs that do not overlap; few rounds find anything.
    for _ in 0..8 {
        let found = shared_pairs(graph, &rows, &mut ratios);
        if found.is_empty() {
            break;
        }
        let mut used: BTreeSet<usize> = BTreeSet::new();
        let mut progress = false;
        for shared in found {
            let users: Vec<usize> = shared.users.iter().copied().filter(|row| !used.contains(row)).collect();
            if users.len() < 2 {
                continue;
            }
            let (a, b) = shared.pair;
            let zero = graph.zero();
            let one = graph.one();
            let mut terms = vec![(a, one), (b, shared.ratio)];
            terms.sort_unstable();
            let z = net.intern(NetNode::Sum(Linear { constant: zero, terms }));
            for row in users {
                if rows[row].id == z {
                    continue;
                }
                used.insert(row);
                touched[row] = true;
                progress = true;
                let k = rows[row].terms.remove(&a).expect("the pair is in the row");
                rows[row].terms.remove(&b);
                let slot = rows[row].terms.entry(z).or_insert(zero);
                *slot = graph.add(*slot, k);
            }
        }
        if !progress {
            break;
        }
    }
    let mut changes = Changes::default();
    for (row, touched) in rows.into_iter().zip(touched) {
        if touched {
            let terms = row.terms.into_iter().filter(|(_, k)| !graph.is_zero(*k)).collect();
            changes.insert(row.id, NetNode::Sum(Linear { constant: row.constant, terms }));
        }
    }
    changes
}

struct Shared {
    gain: i64,
    pair: (NetId, NetId),
    ratio: ExprId,
    users: Vec<usize>,
}

/// Pairs worth taking, the best first.
fn shared_pairs(graph: &mut Graph, rows: &[Row], known: &mut Ratios) -> Vec<Shared> {
    let mut occurrences: FastMap<NetId, u32> = FastMap::default();
    for row in rows {
        for node in row.terms.keys() {
            *occurrences.or_default(*node) += 1;
        }
    }
    let mut pairs: FastMap<(NetId, NetId), Vec<usize>> = FastMap::default();
    let mut order: Vec<(NetId, NetId)> = Vec::new();
    'rows: for (index, row) in rows.iter().enumerate() {
        let shared: Vec<NetId> = row.terms.keys().copied().filter(|node| occurrences[node] >= 2).collect();
        if shared.len() > LONGEST_SUM {
            continue;
        }
        for (i, a) in shared.iter().enumerate() {
            for b in &shared[i + 1..] {
                let users = pairs.or_default((*a, *b));
                if users.is_empty() {
                    order.push((*a, *b));
                }
                users.push(index);
                if order.len() > LARGEST_PROBLEM {
                    break 'rows;
                }
            }
        }
    }
    let mut found = Vec::new();
    for pair in order {
        let users = &pairs[&pair];
        if users.len() < 2 {
            continue;
        }
        // By ratio b/a; where that is not safe, the pair is left alone in this row.
        let mut ratios: Vec<(ExprId, Vec<usize>)> = Vec::new();
        for row in users {
            let (ka, kb) = (rows[*row].terms[&pair.0], rows[*row].terms[&pair.1]);
            let ratio = known.ratio(graph, kb, ka);
            match ratios.iter_mut().find(|(known, _)| *known == ratio) {
                Some((_, users)) => users.push(*row),
                None => ratios.push((ratio, vec![*row])),
            }
        }
        for (ratio, users) in ratios {
            if users.len() < 2 {
                continue;
            }
            let (mut pair, mut ratio) = (pair, ratio);
            if !known.is_safe(graph, ratio, &rows[users[0]]) {
                let turned = graph.powi(ratio, -1);
                if !known.is_safe(graph, turned, &rows[users[0]]) {
                    continue;
                }
                (pair, ratio) = ((pair.1, pair.0), turned);
            }
            let mut gain = -1 - i64::from(!is_unit(graph, ratio));
            for row in &users {
                // One addition and the multiplication by the coefficient of b.
                gain += 1 + i64::from(!is_unit(graph, rows[*row].terms[&pair.1]));
            }
            if gain > 0 {
                found.push(Shared { gain, pair, ratio, users });
            }
        }
    }
    found.sort_by(|x, y| y.gain.cmp(&x.gain).then(x.pair.cmp(&y.pair)));
    found
}

/// Ratios and denominators of coefficients: every round asks for most of them again.
#[derive(Default)]
struct Ratios {
    quotients: FastMap<(ExprId, ExprId), ExprId>,
    denominators: FastMap<ExprId, Vec<ExprId>>,
}

impl Ratios {
    /// `b / a`.
    fn ratio(&mut self, graph: &mut Graph, b: ExprId, a: ExprId) -> ExprId {
        if a == b {
            return graph.one();
        }
        *self.quotients.or_insert_with((b, a), || graph.div(b, a))
    }

    /// What a constant divides by and is not known to differ from zero.
    fn denominators(&mut self, graph: &mut Graph, constant: ExprId) -> &[ExprId] {
        self.denominators.or_insert_with(constant, || {
            let (_, factors) = constant_factors(graph, constant);
            let doubtful = factors.into_iter().filter(|(_, e)| *e < 0).map(|(base, _)| base);
            doubtful.filter(|base| !graph.manifestly_nonzero(*base)).collect()
        })
    }

    /// Whether everything that the ratio divides by is divided by in this row already, or known to differ from zero.
    fn is_safe(&mut self, graph: &mut Graph, ratio: ExprId, row: &Row) -> bool {
        let doubtful = self.denominators(graph, ratio).to_vec();
        doubtful.iter().all(|base| row.terms.values().any(|k| self.denominators(graph, *k).contains(base)))
    }
}
