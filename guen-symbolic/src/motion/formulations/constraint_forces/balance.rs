//! Reactions that do no work: the vectors `y` over the differences with `B^T y = 0`, and a left inverse of `B`.
//!
//! A difference that is a constant times one parameter (the rate of turn of a link, the speed of a cart) gives that
//! parameter; what all others ask of it is its reaction. The parameters that are left fall into blocks of differences
//! that have no parameter in common: a link in a plane has two, and its reaction is along it.
//!
//! Nothing is divided by that could vanish while the mass matrix is regular: constants known to differ from zero, and
//! sums of squares or determinants of a whole block, which vanish only where `B` loses rank.

use std::collections::BTreeSet;

use crate::algebra::{ExprId, Node};
use crate::motion::mass_matrix::sparse::{Columns, Vector};
use crate::motion::thresholds::{BALANCED_CHOICES, BALANCED_COST, BALANCED_PARAMETERS};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

pub(super) struct Balance {
    /// Rows `P_s` with `P B = 1`, over the differences.
    pub(super) inverse: Vec<Vector>,
    /// Columns `N_t` with `N^T B = 0`; with those of `P^T` a basis.
    pub(super) null: Vec<Vector>,
    /// The divisors of the elimination.
    pub(super) divisors: Vec<ExprId>,
}

/// The state of balancing the blocks.
struct Balancing<'a> {
    /// The rows of `B`.
    rows: &'a [Vector],
    /// The difference that gives a parameter.
    pivots: Vec<Option<usize>>,
    inverse: Vec<Vector>,
    null: Vec<Vector>,
    divisors: Vec<ExprId>,
}

/// `None` where a block has no balance that is certain. `coupling` counts the neighbours of each difference in the tree.
pub(super) fn balance(
    bench: &mut Workbench,
    rows: &[Vector],
    parameters: usize,
    coupling: &[usize],
) -> Option<Balance> {
    let mut pivots: Vec<Option<usize>> = vec![None; parameters];
    for (k, row) in rows.iter().enumerate() {
        if let [(s, e)] = row.entries()
            && is_certain(bench, *e)
            && pivots[*s].is_none_or(|other| coupling[k] < coupling[other])
        {
            pivots[*s] = Some(k);
        }
    }
    let mut balancing = Balancing {
        rows,
        inverse: vec![Vector::default(); parameters],
        null: Vec::new(),
        divisors: Vec::new(),
        pivots,
    };
    for s in 0..parameters {
        if let Some(k) = balancing.pivots[s] {
            let reciprocal = bench.graph.powi(balancing.entry(bench, k, s), -1);
            balancing.inverse[s] = Vector::unit(k, reciprocal);
        }
    }
    for (members, unknown) in balancing.blocks() {
        balancing.block(bench, &members, &unknown)?;
    }
    let Balancing { inverse, null, divisors, .. } = balancing;
    inverse.iter().all(|row| row.len() > 0).then_some(Balance { inverse, null, divisors })
}

impl Balancing<'_> {
    fn entry(&self, bench: &Workbench, k: usize, s: usize) -> ExprId {
        self.rows[k].get(s).unwrap_or(bench.graph.zero())
    }

    /// Groups of differences that share a parameter without a pivot, with these parameters.
    fn blocks(&self) -> Vec<(Vec<usize>, Vec<usize>)> {
        let unknown = |k: usize| {
            let entries = self.rows[k].entries().iter();
            entries.map(|(s, _)| *s).filter(|s| self.pivots[*s].is_none()).collect::<Vec<_>>()
        };
        let mut seen = vec![false; self.rows.len()];
        for k in self.pivots.iter().flatten() {
            seen[*k] = true;
        }
        let columns = Columns::new(self.rows);
        let mut blocks = Vec::new();
        for start in 0..self.rows.len() {
            if seen[start] {
                continue;
            }
            seen[start] = true;
            let (mut members, mut parameters) = (vec![start], unknown(start));
            // Until no difference shares a parameter with the block.
            let near = |s: &usize| columns.at(*s).iter().copied();
            let mut joining: BTreeSet<usize> = parameters.iter().flat_map(near).collect();
            while let Some(k) = joining.pop_first() {
                if core::mem::replace(&mut seen[k], true) {
                    continue;
                }
                members.push(k);
                let new: Vec<usize> = unknown(k).into_iter().filter(|s| !parameters.contains(s)).collect();
                joining.extend(new.iter().flat_map(near));
                parameters.extend(new);
            }
            members.sort_unstable();
            blocks.push((members, parameters));
        }
        blocks
    }

    /// Balances one block.
    fn block(&mut self, bench: &mut Workbench, members: &[usize], unknown: &[usize]) -> Option<()> {
        let one = bench.graph.one();
        if unknown.len() > BALANCED_PARAMETERS {
            return None;
        }
        // Differences that are constant multiples of another one: particles on the same link.
        let mut members = members.to_vec();
        members.sort_by_key(|k| (self.rows[*k].len(), *k));
        let mut kept: Vec<usize> = Vec::new();
        for k in members {
            let multiple =
                kept.iter().find_map(|other| Some((*other, self.ratio(bench, k, *other, unknown)?)));
            match multiple {
                Some((other, ratio)) => {
                    let mut y = Vector::unit(k, one);
                    let negative = bench.graph.neg(ratio);
                    y.add(bench, other, negative);
                    self.push_null(bench, y);
                }
                None => kept.push(k),
            }
        }
        match (unknown, &kept[..]) {
            ([], _) => {
                for k in kept {
                    self.push_null(bench, Vector::unit(k, one));
                }
                Some(())
            }
            ([s], _) => self.along(bench, &kept, *s),
            ([_, _], [_, _, _]) => {
                self.across(bench, [kept[0], kept[1], kept[2]], [unknown[0], unknown[1]]);
                Some(())
            }
            _ => self.by_pivots(bench, &kept, unknown),
        }
    }

    /// Balances a single parameter: the reactions across its column.
    fn along(&mut self, bench: &mut Workbench, members: &[usize], s: usize) -> Option<()> {
        let column: Vec<ExprId> = members.iter().map(|k| self.entry(bench, *k, s)).collect();
        if let [b] = column[..] {
            self.divisors.push(b);
            let y = Vector::unit(members[0], bench.graph.powi(b, -1));
            self.inverse[s] = self.extended(bench, y);
            return Some(());
        }
        if let Some(place) = column.iter().position(|b| is_certain(bench, *b)) {
            let pivot = bench.graph.powi(column[place], -1);
            for (k, b) in members.iter().zip(&column) {
                if *k != members[place] {
                    let product = bench.graph.mul(*b, pivot);
                    let mut y = Vector::unit(*k, bench.graph.one());
                    let negative = bench.graph.neg(product);
                    y.add(bench, members[place], negative);
                    self.push_null(bench, y);
                }
            }
            let y = Vector::unit(members[place], pivot);
            self.inverse[s] = self.extended(bench, y);
            return Some(());
        }
        let (i, j, square) = self.pair(bench, &column)?;
        let scale = factor_in_common(bench, &[column[i], column[j]]);
        let divided = |bench: &mut Workbench, e: ExprId| {
            let quotient = bench.graph.div(e, scale);
            bench.tidy(quotient)
        };
        let (across, along) = (bench.graph.neg(column[j]), column[i]);
        let (across, along) = (divided(bench, across), divided(bench, along));
        let mut y = Vector::unit(members[i], across);
        y.add(bench, members[j], along);
        self.push_null(bench, y);
        self.divisors.push(square);
        let mut inverse = Vector::default();
        for place in [i, j] {
            let quotient = bench.graph.div(column[place], square);
            let quotient = bench.tidy(quotient);
            inverse.add(bench, members[place], quotient);
        }
        for (k, b) in members.iter().zip(&column) {
            if *k != members[i] && *k != members[j] {
                let mut y = Vector::unit(*k, bench.graph.one());
                for (index, e) in inverse.entries() {
                    let product = bench.graph.mul(*b, *e);
                    let negative = bench.graph.neg(product);
                    let negative = bench.tidy(negative);
                    y.add(bench, *index, negative);
                }
                self.push_null(bench, y);
            }
        }
        self.inverse[s] = self.extended(bench, inverse);
        Some(())
    }

    /// Two components whose squares have a sum that never vanishes, or all if there are two, with that sum.
    fn pair(&mut self, bench: &mut Workbench, column: &[ExprId]) -> Option<(usize, usize, ExprId)> {
        for j in 1..column.len() {
            for i in 0..j {
                let squares = [column[i], column[j]].map(|b| bench.graph.powi(b, 2));
                let square = bench.graph.sum(squares);
                let square = bench.tidy(square);
                if column.len() == 2 || is_certain(bench, square) {
                    return Some((i, j, square));
                }
            }
        }
        None
    }

    /// Balances a block by as many differences as it has parameters, with the rows `S`; the other rows are multiples of these, `C S`. `C` has
    /// no poles, so that the determinant of `S` vanishes only where the block loses rank.
    ///
    /// A body that turns in space is such a block: `S` are the rows of its spins, and `C S` those of the velocity of its centre relative to the
    /// point that it hangs on.
    fn by_pivots(&mut self, bench: &mut Workbench, members: &[usize], unknown: &[usize]) -> Option<()> {
        let rows: Vec<Vec<ExprId>> =
            members.iter().map(|k| unknown.iter().map(|s| self.entry(bench, *k, *s)).collect()).collect();
        let is_long =
            members.len() > unknown.len() && weighted_cost(&bench.graph, &rows.concat()) > BALANCED_COST;
        if is_long {
            return None;
        }
        let mut choices = subsets(members.len(), unknown.len()).into_iter().take(BALANCED_CHOICES);
        let (chosen, Inverse { rows: inverse, determinant }, followers) = choices.find_map(|chosen| {
            let square: Vec<&[ExprId]> = chosen.iter().map(|place| &rows[*place][..]).collect();
            let inverse = Inverse::of(bench, &square)?;
            let others = (0..members.len()).filter(|place| !chosen.contains(place));
            let followers: Option<Vec<(usize, Vec<ExprId>)>> =
                others.map(|place| Some((place, inverse.multiples(bench, &rows[place])?))).collect();
            Some((chosen, inverse, followers?))
        })?;
        for (place, multiples) in followers {
            let mut y = Vector::unit(members[place], bench.graph.one());
            for (pivot, multiple) in chosen.iter().zip(multiples) {
                let negative = bench.graph.neg(multiple);
                y.add(bench, members[*pivot], negative);
            }
            self.push_null(bench, y);
        }
        self.divisors.push(determinant);
        for (s, row) in unknown.iter().zip(inverse) {
            let mut y = Vector::default();
            for (pivot, e) in chosen.iter().zip(row) {
                y.add(bench, members[*pivot], e);
            }
            self.inverse[*s] = self.extended(bench, y);
        }
        Some(())
    }

    /// Two parameters and three differences: the reaction is along the cross product of the two columns.
    fn across(&mut self, bench: &mut Workbench, members: [usize; 3], unknown: [usize; 2]) {
        let [u, v] = unknown.map(|s| members.map(|k| self.entry(bench, k, s)));
        let dot = |bench: &mut Workbench, a: &[ExprId; 3], b: &[ExprId; 3]| {
            let sum = bench.dot(a, b);
            bench.tidy(sum)
        };
        let (uu, uv, vv) = (dot(bench, &u, &u), dot(bench, &u, &v), dot(bench, &v, &v));
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
            let (a, b) = (bench.graph.mul(u[i], v[j]), bench.graph.mul(u[j], v[i]));
            let component = bench.graph.sub(a, b);
            bench.tidy(component)
        });
        let nonzero: Vec<ExprId> = normal.into_iter().filter(|e| !bench.graph.is_zero(*e)).collect();
        let scale = factor_in_common(bench, &nonzero);
        let mut y = Vector::default();
        for (k, e) in members.into_iter().zip(normal) {
            let quotient = bench.graph.div(e, scale);
            let quotient = bench.tidy(quotient);
            y.add(bench, k, quotient);
        }
        self.push_null(bench, y);
        // P = (B^T B)^-1 B^T
        let (product, square) = (bench.graph.mul(uu, vv), bench.graph.powi(uv, 2));
        let determinant = bench.graph.sub(product, square);
        let determinant = bench.tidy(determinant);
        self.divisors.push(determinant);
        for (s, [a, b]) in unknown.into_iter().zip([[vv, uv], [uv, uu]]) {
            let first = s == unknown[0];
            let mut y = Vector::default();
            for (place, k) in members.into_iter().enumerate() {
                let (x, z) = (bench.graph.mul(a, u[place]), bench.graph.mul(b, v[place]));
                let row = if first { bench.graph.sub(x, z) } else { bench.graph.sub(z, x) };
                let quotient = bench.graph.div(row, determinant);
                let quotient = bench.tidy(quotient);
                y.add(bench, k, quotient);
            }
            self.inverse[s] = self.extended(bench, y);
        }
    }

    /// The constant by which one difference exceeds another in some parameters, if there is one.
    fn ratio(&self, bench: &mut Workbench, k: usize, other: usize, unknown: &[usize]) -> Option<ExprId> {
        let mut found = None;
        for s in unknown {
            let (a, b) = (self.entry(bench, k, *s), self.entry(bench, other, *s));
            if bench.graph.is_zero(a) != bench.graph.is_zero(b) {
                return None;
            }
            if bench.graph.is_zero(a) {
                continue;
            }
            let ratio = bench.graph.div(a, b);
            let ratio = bench.tidy(ratio);
            if !bench.graph.roles(ratio).is_constant() || found.is_some_and(|known| known != ratio) {
                return None;
            }
            found = Some(ratio);
        }
        found.filter(|ratio| divides_safely(bench, *ratio))
    }

    /// A vector over the differences without pivots, with the reactions that balance the parameters that have one.
    fn extended(&self, bench: &mut Workbench, y: Vector) -> Vector {
        let mut whole = y.clone();
        for (j, e) in y.entries() {
            for (s, b) in self.rows[*j].entries() {
                let Some(k) = self.pivots[*s] else { continue };
                let pivot = self.entry(bench, k, *s);
                let part = bench.graph.product(&[(*e, 1), (*b, 1), (pivot, -1)]);
                let part = bench.graph.neg(part);
                let part = bench.tidy(part);
                whole.add(bench, k, part);
            }
        }
        whole
    }

    fn push_null(&mut self, bench: &mut Workbench, y: Vector) {
        let whole = self.extended(bench, y);
        self.null.push(whole);
    }
}

/// The inverse of a small matrix.
struct Inverse {
    rows: Vec<Vec<ExprId>>,
    determinant: ExprId,
}

impl Inverse {
    /// `None` of a singular matrix.
    fn of(bench: &mut Workbench, matrix: &[&[ExprId]]) -> Option<Self> {
        let all: Vec<usize> = (0..matrix.len()).collect();
        let determinant = determinant(bench, matrix, (&all, &all));
        let determinant = bench.tidy(determinant);
        if bench.vanishes(determinant) {
            return None;
        }
        let without = |place: usize| all.iter().copied().filter(|i| *i != place).collect::<Vec<_>>();
        let entry = |bench: &mut Workbench, s: usize, i: usize| {
            let minor = self::determinant(bench, matrix, (&without(i), &without(s)));
            let quotient = bench.graph.div(minor, determinant);
            let quotient = if (s + i).is_multiple_of(2) { quotient } else { bench.graph.neg(quotient) };
            bench.tidy(quotient)
        };
        let rows = all.iter().map(|s| all.iter().map(|i| entry(bench, *s, *i)).collect::<Vec<_>>()).collect();
        Some(Self { rows, determinant })
    }

    /// The multiples of the matrix's rows that another row is the sum of; `None` where one is divided by what may vanish.
    fn multiples(&self, bench: &mut Workbench, row: &[ExprId]) -> Option<Vec<ExprId>> {
        (0..row.len())
            .map(|i| {
                let column: Vec<ExprId> = self.rows.iter().map(|row| row[i]).collect();
                let multiple = bench.dot(row, &column);
                let multiple = bench.tidy(multiple);
                divides_safely(bench, multiple).then_some(multiple)
            })
            .collect()
    }
}

/// The determinant of some rows and columns, by the first row.
fn determinant(bench: &mut Workbench, matrix: &[&[ExprId]], (rows, columns): (&[usize], &[usize])) -> ExprId {
    let [first, others @ ..] = rows else { return bench.graph.one() };
    let terms: Vec<ExprId> = (0..columns.len())
        .map(|place| {
            let without: Vec<usize> = [&columns[..place], &columns[place + 1..]].concat();
            let minor = determinant(bench, matrix, (others, &without));
            let term = bench.graph.mul(matrix[*first][columns[place]], minor);
            if place.is_multiple_of(2) { term } else { bench.graph.neg(term) }
        })
        .collect();
    bench.graph.sum(terms)
}

/// The subsets of so many of the first numbers, in lexicographic order.
fn subsets(count: usize, size: usize) -> Vec<Vec<usize>> {
    match (count, size) {
        (_, 0) => vec![Vec::new()],
        (0, _) => Vec::new(),
        _ => {
            let mut found = subsets(count - 1, size);
            let mut with_last = subsets(count - 1, size - 1);
            with_last.iter_mut().for_each(|subset| subset.push(count - 1));
            found.append(&mut with_last);
            found
        }
    }
}

/// A constant that is known to differ from zero.
fn is_certain(bench: &Workbench, e: ExprId) -> bool {
    bench.graph.roles(e).is_constant() && bench.graph.manifestly_nonzero(e)
}

/// Whether an expression divides by nothing but what is known to differ from zero.
fn divides_safely(bench: &Workbench, e: ExprId) -> bool {
    divides_as(bench, e, bench.graph.one())
}

/// Whether an expression divides by nothing but what another one divides by, or is known to differ from zero.
pub(super) fn divides_as(bench: &Workbench, e: ExprId, other: ExprId) -> bool {
    let doubtful = |base: &ExprId| !bench.graph.manifestly_nonzero(*base);
    // Most are seen at once: the sums below a force of a long family are as long as it.
    let own = |e: ExprId| {
        let factors = bench.graph.factors(e).iter().filter(|(_, exponent)| *exponent < 0);
        factors.map(|(base, _)| *base).collect::<Vec<_>>()
    };
    let (of_other, of_ratio) = (own(bench.graph.monomial(other)), own(bench.graph.monomial(e)));
    if of_ratio.iter().any(|base| doubtful(base) && !of_other.contains(base)) {
        return false;
    }
    let divided: Vec<ExprId> = bench.graph.divisors(&[e]).into_iter().filter(doubtful).collect();
    if divided.is_empty() {
        return true;
    }
    let known = bench.graph.divisors(&[other]);
    divided.iter().all(|base| known.contains(base))
}

/// Returns a common factor of products that none of them loses by division. Constants that might vanish are left.
fn factor_in_common(bench: &mut Workbench, es: &[ExprId]) -> ExprId {
    let graph = &mut bench.graph;
    let mut common: Option<Vec<(ExprId, i32)>> = None;
    for e in es {
        let (_, monomial) = graph.split_coefficient(*e);
        let factors: Vec<(ExprId, i32)> = match graph.node(monomial) {
            Node::Product(factors) => factors.to_vec(),
            _ => vec![(monomial, 1)],
        };
        common = Some(match common {
            None => factors.into_iter().filter(|(_, k)| *k > 0).collect(),
            Some(known) => {
                let power = |base: ExprId| factors.iter().find(|(b, _)| *b == base).map_or(0, |(_, k)| *k);
                known
                    .into_iter()
                    .map(|(base, k)| (base, k.min(power(base))))
                    .filter(|(_, k)| *k > 0)
                    .collect()
            }
        });
    }
    let common = common.unwrap_or_default();
    let common: Vec<_> = common
        .into_iter()
        .filter(|(base, _)| !graph.roles(*base).is_constant() || graph.manifestly_nonzero(*base))
        .collect();
    graph.product(&common)
}
