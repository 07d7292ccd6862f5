//! Pairs of terms that several sums have in the same ratio become sums of their own, the best pair first.
//!
//! `k a + k r b + ..` and `q a + q r b + ..` share `z = a + r b`. The ratio must be one in which nothing new is
//! divided by: a constant that is not known to differ from zero never becomes a denominator.

use super::super::net::{Linear, Net, NetNode, constant_factors};
use super::super::terms::NetId;
use super::super::terms::{Terms, nonzero};
use super::{Changes, is_unit};
use crate::algebra::{ExprId, FastMap, Graph};
use crate::program::thresholds::{SUM_PAIRS, SUM_TERMS};

struct Row {
    id: NetId,
    constant: ExprId,
    terms: Terms,
}

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId]) -> Changes {
    let (nodes, _) = net.reachable(roots);
    let mut rows: Vec<Row> = Vec::new();
    for id in nodes {
        if let NetNode::Sum(linear) = net.node(id)
            && linear.terms.len() >= 2
        {
            rows.push(Row { id, constant: linear.constant, terms: Terms::from_sorted(linear.terms.clone()) });
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
        let mut used = vec![false; rows.len()];
        let mut progress = false;
        for shared in found {
            let users: Vec<usize> = shared.users.iter().copied().filter(|row| !used[*row]).collect();
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
                used[row] = true;
                touched[row] = true;
                progress = true;
                let k = rows[row].terms.remove(a).expect("the pair is in the row");
                rows[row].terms.remove(b);
                let slot = rows[row].terms.or_insert(z, zero);
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
            let terms = nonzero(graph, row.terms);
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

/// A row with a pair, and its coefficients of the pair.
type User = (usize, ExprId, ExprId);

/// Pairs worth taking, the best first.
fn shared_pairs(graph: &mut Graph, rows: &[Row], known: &mut Ratios) -> Vec<Shared> {
    let mut occurrences: FastMap<NetId, u32> = FastMap::default();
    for row in rows {
        let terms = row.terms.entries();
        let mut index = 0;
        while index < terms.len() {
            *occurrences.or_default(terms[index].0) += 1;
            index += 1;
        }
    }
    // Most pairs have one user: others follow in a list.
    let mut pairs: FastMap<(NetId, NetId), (User, Vec<User>)> = FastMap::default();
    'rows: for (index, row) in rows.iter().enumerate() {
        let mut shared: Vec<(NetId, ExprId)> = Vec::new();
        for term in row.terms.entries() {
            if occurrences[&term.0] >= 2 {
                shared.push(*term);
            }
        }
        if shared.len() > SUM_TERMS {
            continue;
        }
        let shared: &[(NetId, ExprId)] = &shared;
        let mut i = 0;
        while i < shared.len() {
            let (a, ka) = shared[i];
            i += 1;
            let mut k = i;
            while k < shared.len() {
                let (b, kb) = shared[k];
                let user = (index, ka, kb);
                let (first, more) = pairs.or_insert_with((a, b), || (user, Vec::new()));
                if first.0 != index {
                    more.push(user);
                }
                if pairs.len() > SUM_PAIRS {
                    break 'rows;
                }
                k += 1;
            }
        }
    }
    let mut found = Vec::new();
    for (pair, (first, more)) in pairs.into_pairs() {
        if more.is_empty() {
            continue;
        }
        // By ratio b/a; where that is not safe, the pair is left alone in this row.
        let mut ratios: Vec<(ExprId, Vec<User>)> = Vec::new();
        for user in [first].into_iter().chain(more) {
            let ratio = known.ratio(graph, user.2, user.1);
            match ratios.iter_mut().find(|(known, _)| *known == ratio) {
                Some((_, users)) => users.push(user),
                None => ratios.push((ratio, vec![user])),
            }
        }
        for (ratio, users) in ratios {
            if users.len() < 2 {
                continue;
            }
            let (mut pair, mut ratio, mut turned) = (pair, ratio, false);
            if !known.is_safe(graph, ratio, &rows[users[0].0]) {
                let inverse = graph.powi(ratio, -1);
                if !known.is_safe(graph, inverse, &rows[users[0].0]) {
                    continue;
                }
                (pair, ratio, turned) = ((pair.1, pair.0), inverse, true);
            }
            let mut gain = -1 - i64::from(!is_unit(graph, ratio));
            for (_, ka, kb) in &users {
                // One addition and the multiplication by the coefficient of b.
                gain += 1 + i64::from(!is_unit(graph, if turned { *ka } else { *kb }));
            }
            if gain > 0 {
                found.push(Shared {
                    gain,
                    pair,
                    ratio,
                    users: users.into_iter().map(|user| user.0).collect(),
                });
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

    /// Returns the divisors of a constant that are not known to differ from zero.
    fn denominators(&mut self, graph: &mut Graph, constant: ExprId) -> &[ExprId] {
        self.denominators.or_insert_with(constant, || {
            let (_, factors) = constant_factors(graph, constant);
            let doubtful = factors.into_iter().filter(|(_, e)| *e < 0).map(|(base, _)| base);
            doubtful.filter(|base| !graph.manifestly_nonzero(*base)).collect()
        })
    }

    /// Whether everything that the ratio divides by is divided by in this row already, or known to differ from zero.
    fn is_safe(&mut self, graph: &mut Graph, ratio: ExprId, row: &Row) -> bool {
        let doubtful = self.denominators(graph, ratio);
        if doubtful.is_empty() {
            return true;
        }
        let doubtful = doubtful.to_vec();
        doubtful
            .iter()
            .all(|base| row.terms.entries().iter().any(|(_, k)| self.denominators(graph, *k).contains(base)))
    }
}
