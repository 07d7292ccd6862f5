//! Points of the constraint manifold: modulo the prime by elimination, over the reals by projection.
//!
//! What comes in are the functions that vanish on the manifold. Modulo the prime they are solved block by
//! block for symbols that enter them linearly (one of a block's equations may be quadratic): a block's
//! symbols occur in no equation solved before it. Equations for which there is no block are left out: what vanishes where
//! the others hold vanishes on the manifold, and what does not may. A real point is a random point projected by Newton's
//! method onto the manifold.

use super::field::{self, PRIME, add, inverse, mul, neg, sub};
use super::real::{Real, RealPoint, evaluate_in, exponent};
use super::sample::Sample;
use super::table::Table;
use crate::algebra::{
    ExprId, FastMap, Flow, Function, Graph, Multivariate, Node, Role, SignBound, SymbolId, mix,
};
use f256::f256;

/// Equations that are solved together; the unit vectors of a frame need three.
const LARGEST_BLOCK: usize = 3;
/// Sets of symbols that are tried for one set of equations.
const LARGEST_SEARCH: usize = 200;
/// Equations that are tried to be left out, in all; beyond them the first of those that may be is.
const TRIES_WITHOUT: usize = 200;
/// Draws of a whole point before there is none: of eight lengths that are roots of what all have in common, one in 256 has all.
const DRAWS: u64 = 1024;
/// Draws of the symbols of one block before the point has none.
const REDRAWS: u64 = 64;
/// Random points that are projected before there is no real point.
const PROJECTIONS: u64 = 8;
/// The step from one projection to the next: the signs stay, the sizes change.
const STRIDE: u64 = 16;
/// Newton's steps in double precision.
const NEWTON_STEPS: usize = 60;
/// Newton's steps in 237 bits: each doubles the digits.
const POLISH_STEPS: usize = 4;

/// Equations that are solved together for as many symbols.
#[derive(Debug)]
struct Block {
    /// Jointly linear in the symbols.
    linear: Vec<ExprId>,
    /// Jointly quadratic in the symbols.
    quadratic: Option<ExprId>,
    symbols: Vec<SymbolId>,
    /// Symbols that occur in no equation before: they may be drawn again.
    free: Vec<SymbolId>,
}

/// The set where all equations hold.
#[derive(Debug)]
pub(super) struct Manifold {
    /// The blocks in the order of solution; `None` if there are no points.
    blocks: Option<Vec<Block>>,
    equations: Vec<ExprId>,
    /// The equations that hold at points modulo the prime: all of them, or as many as can be solved.
    solved: Vec<ExprId>,
    /// The symbols along which a real point may move, and the equations' derivatives by them, row by row.
    variables: Vec<SymbolId>,
    jacobian: Vec<ExprId>,
    /// Per node: whether a solved symbol occurs, and whether one occurs in a transcendental function.
    occurrence: Vec<u8>,
}

const OCCURS: u8 = 1;
const INSIDE: u8 = 2;

impl Manifold {
    /// The manifold of some equations, whose expressions enter the table.
    pub(super) fn new(graph: &mut Graph, table: &mut Table, equations: &[ExprId]) -> Self {
        let mut equations: Vec<_> = equations.iter().map(|e| without_constant_factors(graph, *e)).collect();
        equations.sort_unstable();
        equations.dedup();
        let variables: Vec<_> = graph
            .symbols_in(&equations)
            .into_iter()
            .filter(|s| matches!(graph.symbol_info(*s).role, Role::Coordinate | Role::Constant))
            .collect();
        let mut jacobian = vec![graph.zero(); equations.len() * variables.len()];
        let occurring: Vec<Vec<SymbolId>> = equations.iter().map(|e| graph.symbols_in(&[*e])).collect();
        for (j, symbol_id) in variables.iter().enumerate() {
            let symbol = graph.symbol_expr(*symbol_id);
            let mut flow = Flow::partial(graph, symbol);
            for (i, equation) in equations.iter().enumerate() {
                if occurring[i].contains(symbol_id) {
                    jacobian[i * variables.len() + j] = flow.of(graph, *equation);
                }
            }
        }
        table.scan(graph);
        let (blocks, kept) = triangular((graph, table), &equations, occurring);
        let solved = kept.into_iter().map(|i| equations[i]).collect();
        let mut manifold =
            Manifold { blocks: Some(blocks), equations, solved, variables, jacobian, occurrence: Vec::new() };
        // An order by which no draw gives a point, as where a length that is promised to be positive would have to vanish, is none: every
        // question would search for a point again.
        if manifold.solved.is_empty() || manifold.sample(graph, table, 0).is_none() {
            manifold.blocks = None;
        }
        manifold
    }

    /// Whether an expression is part of a constraint.
    pub(super) fn has(&self, graph: &Graph, e: ExprId) -> bool {
        graph.reachable(&self.equations, |_| false).contains(&e)
    }

    /// Whether points modulo the prime can be found where all constraints hold.
    pub(super) fn is_solved(&self) -> bool {
        self.has_points() && self.solved.len() == self.equations.len()
    }

    /// Whether there are points where some of the constraints hold.
    pub(super) fn has_points(&self) -> bool {
        self.blocks.is_some()
    }

    /// Whether a symbol that the constraints determine occurs in an argument of a transcendental function.
    ///
    /// Such a function may be related to another one, which residues do not see.
    pub(super) fn enters_functions(&mut self, graph: &Graph, e: ExprId) -> bool {
        let blocks = self.blocks.as_deref().unwrap_or_default();
        for index in self.occurrence.len()..=e.index() {
            let id = ExprId(index as u32);
            let mut bits =
                graph.children(id).iter().fold(0, |bits, child| bits | self.occurrence[child.index()]);
            match graph.node(id) {
                Node::Symbol(symbol) if blocks.iter().any(|block| block.symbols.contains(symbol)) => {
                    bits = OCCURS
                }
                Node::Function(Function::Root(_) | Function::Abs | Function::Sign, _) => {}
                // Any values will do for those of a function that nobody knows, and for the branches of a choice.
                Node::Multivariate(function, _) if *function != Multivariate::Atan2 => {}
                Node::Function(..) | Node::Multivariate(..) if bits & OCCURS != 0 => bits |= INSIDE,
                _ => {}
            }
            self.occurrence.push(bits);
        }
        self.occurrence[e.index()] & INSIDE != 0
    }

    /// The point of a number modulo the prime.
    pub(super) fn sample(&self, graph: &Graph, table: &Table, number: u64) -> Option<Sample> {
        let blocks = self.blocks.as_ref()?;
        (0..DRAWS).find_map(|attempt| {
            let seed = mix(mix(number ^ 0x6d61_6e69) ^ attempt);
            let mut fixed = FastMap::default();
            for block in blocks {
                block.solve(graph, table, seed, &mut fixed)?;
            }
            let mut sample = Sample::new(seed);
            sample.fixed = fixed;
            self.solved.iter().all(|e| sample.value(graph, table, *e) == Some(0)).then_some(sample)
        })
    }

    /// The point of a number over the reals.
    pub(super) fn real_point(&self, graph: &Graph, number: u64) -> Option<RealPoint> {
        let roots: Vec<_> = self.equations.iter().chain(&self.jacobian).copied().collect();
        let order = graph.reachable(&roots, |_| false);
        let all = (&roots[..], &order[..]);
        (0..PROJECTIONS).find_map(|attempt| {
            let mut point = RealPoint::new(number + STRIDE * attempt);
            let mut x: Vec<f64> = self.variables.iter().map(|s| point.draw(graph, *s)).collect();
            let time = |s: SymbolId| RealPoint::new(number + STRIDE * attempt).draw(graph, s);
            let mut last = f64::INFINITY;
            for _ in 0..NEWTON_STEPS {
                last = self.project(graph, all, &mut x, &time)?;
                if last < 1e-12 {
                    break;
                }
            }
            let within =
                self.variables.iter().zip(&x).all(|(symbol, x)| match graph.symbol_info(*symbol).bound {
                    SignBound::Positive | SignBound::NonNegative => *x > 1e-3,
                    SignBound::Negative | SignBound::NonPositive => *x < -1e-3,
                    SignBound::Free | SignBound::NonZero => true,
                });
            // NaN is not below either.
            if !within || last.is_nan() || last > 1e-6 {
                return None;
            }
            let mut x: Vec<f256> = x.into_iter().map(f256::from).collect();
            let mut last = f256::ONE;
            for _ in 0..POLISH_STEPS {
                last = self.project(graph, all, &mut x, &|s| f256::from(time(s)))?;
            }
            if exponent(last) > -200.0 {
                return None;
            }
            point.fixed = self.variables.iter().copied().zip(x).collect();
            Some(point)
        })
    }

    /// Makes one step `x -= J^T (J J^T)^-1 f`; returns the largest component of the step. Given `f` and `J` with all that they are made of.
    fn project<R: Real + PartialOrd>(
        &self,
        graph: &Graph,
        (roots, order): (&[ExprId], &[ExprId]),
        x: &mut [R],
        others: &dyn Fn(SymbolId) -> R,
    ) -> Option<R> {
        let value = |symbol| match self.variables.iter().position(|s| *s == symbol) {
            Some(i) => x[i],
            None => others(symbol),
        };
        let values = evaluate_in(graph, order, roots, &value);
        let (f, jacobian) = values.split_at(self.equations.len());
        let rows: Vec<&[R]> = jacobian.chunks(self.variables.len().max(1)).collect();
        let zero = R::rational(&crate::algebra::Rational::ZERO);
        // Each equation is about few of the variables.
        let sparse: Vec<Vec<usize>> =
            rows.iter().map(|row| (0..row.len()).filter(|j| row[*j] != zero).collect()).collect();
        let dot = |i: usize, k: usize| sparse[i].iter().fold(zero, |sum, j| sum + rows[i][*j] * rows[k][*j]);
        let row = |(i, f): (usize, &R)| (0..rows.len()).map(|k| dot(i, k)).chain([*f]).collect();
        let system = f.iter().enumerate().map(row).collect();
        let multipliers = solve_dense(system)?;
        let mut largest = zero;
        for (j, x) in x.iter_mut().enumerate() {
            let step = rows.iter().zip(&multipliers).fold(zero, |sum, (row, m)| sum + row[j] * *m);
            *x = *x - step;
            let size = step.of(Function::Abs);
            if size.partial_cmp(&largest) != Some(core::cmp::Ordering::Less) {
                largest = size;
            }
        }
        Some(largest)
    }
}

/// An equation without the constants that it is a multiple of: it would be solved by making one of them zero, and says nothing there.
fn without_constant_factors(graph: &mut Graph, e: ExprId) -> ExprId {
    let (_, own) = graph.split_coefficient(e);
    match graph.node(own).clone() {
        Node::Kept(inside) => without_constant_factors(graph, inside),
        Node::Product(factors) => {
            let others: Vec<_> =
                factors.into_iter().filter(|(base, _)| !graph.roles(*base).is_constant()).collect();
            match others[..] {
                [] => e,
                [(base, 1)] => without_constant_factors(graph, base),
                _ => graph.product(&others),
            }
        }
        Node::Sum { constant, terms } if constant.is_zero() => {
            let mut common: Option<Vec<(ExprId, i32)>> = None;
            for (term, _) in &terms {
                let alone = [(*term, 1)];
                let factors = if graph.factors(*term).is_empty() { &alone } else { graph.factors(*term) };
                let constants = || factors.iter().filter(|(base, _)| graph.roles(*base).is_constant());
                common = Some(match common {
                    None => constants().copied().collect(),
                    Some(common) => common
                        .into_iter()
                        .filter_map(|(base, k)| {
                            let (_, other) = constants().find(|(b, _)| *b == base)?;
                            ((k > 0) == (*other > 0))
                                .then(|| (base, if k > 0 { k.min(*other) } else { k.max(*other) }))
                        })
                        .collect(),
                });
            }
            let common = common.unwrap_or_default();
            if common.is_empty() {
                return e;
            }
            let divisor = graph.product(&common);
            let terms: Vec<_> = terms
                .iter()
                .map(|(term, coefficient)| (graph.div(*term, divisor), coefficient.clone()))
                .collect();
            graph.linear(&terms)
        }
        _ => e,
    }
}

/// Solves a small system given with its right side as last column; `None` if it is singular.
pub(super) fn solve_dense<R: Real + PartialOrd>(mut rows: Vec<Vec<R>>) -> Option<Vec<R>> {
    let n = rows.len();
    let zero = R::rational(&crate::algebra::Rational::ZERO);
    for column in 0..n {
        let mut best = column;
        for i in column..n {
            if rows[i][column].of(Function::Abs) > rows[best][column].of(Function::Abs) {
                best = i;
            }
        }
        rows.swap(column, best);
        let (above, below) = rows.split_at_mut(column + 1);
        let pivot_row = &above[column];
        if pivot_row[column].of(Function::Abs).partial_cmp(&zero) != Some(core::cmp::Ordering::Greater) {
            return None;
        }
        // Most of a row is zero, and stays so.
        let filled: Vec<usize> = (column..=n).filter(|j| pivot_row[*j] != zero).collect();
        for row in below.iter_mut().filter(|row| row[column] != zero) {
            let factor = row[column] / pivot_row[column];
            for j in &filled {
                row[*j] = row[*j] - factor * pivot_row[*j];
            }
        }
    }
    let mut found = vec![zero; n];
    for i in (0..n).rev() {
        let known = (i + 1..n).filter(|j| rows[i][*j] != zero);
        let rest = known.fold(rows[i][n], |rest, j| rest - rows[i][j] * found[j]);
        found[i] = rest / rows[i][i];
    }
    Some(found)
}

/// The residues of equations where the block's symbols have the given values.
type Evaluation<'a> = dyn Fn(&[ExprId], &[u64]) -> Option<Vec<u64>> + 'a;

impl Block {
    /// Adds the block's symbols to those that are fixed; `None` if this draw has no solution.
    fn solve(
        &self,
        graph: &Graph,
        table: &Table,
        seed: u64,
        fixed: &mut FastMap<SymbolId, u64>,
    ) -> Option<()> {
        for attempt in 0..REDRAWS {
            if attempt > 0 {
                if self.free.is_empty() {
                    return None;
                }
                let other = Sample::new(mix(seed ^ attempt));
                fixed.extend(self.free.iter().map(|s| (*s, other.symbol(graph, *s))));
            }
            for solution in self.solutions(graph, table, seed, fixed) {
                let info = |symbol: &SymbolId| graph.symbol_info(*symbol);
                // A constant that the equations make zero is on a branch of the manifold that only such constants have.
                let is_lost =
                    |(symbol, value): (&SymbolId, &u64)| *value == 0 && info(symbol).role == Role::Constant;
                if self.symbols.iter().zip(&solution).any(is_lost) {
                    return None;
                }
                let allowed =
                    self.symbols.iter().zip(&solution).all(|(symbol, value)| match info(symbol).bound {
                        SignBound::Free | SignBound::NonZero => true,
                        SignBound::Positive | SignBound::NonNegative => field::is_residue(*value),
                        SignBound::Negative | SignBound::NonPositive => field::is_residue(neg(*value)),
                    });
                if allowed {
                    fixed.extend(self.symbols.iter().copied().zip(solution));
                    return Some(());
                }
            }
        }
        None
    }

    fn solutions(
        &self,
        graph: &Graph,
        table: &Table,
        seed: u64,
        fixed: &FastMap<SymbolId, u64>,
    ) -> Vec<Vec<u64>> {
        let at =
            |equations: &[ExprId], values: &[u64]| self.at(graph, table, (seed, fixed), equations, values);
        self.line(&at)
            .and_then(|(start, direction)| self.on_line(&at, start, direction, seed))
            .unwrap_or_default()
    }

    /// Whether the linear equations determine the symbols up to one direction for a quadratic one: at one of two points.
    fn is_regular(&self, graph: &Graph, table: &Table) -> bool {
        let nothing = FastMap::default();
        (0..2).any(|seed| {
            self.line(&|equations, values| self.at(graph, table, (seed, &nothing), equations, values))
                .is_some()
        })
    }

    /// The residues of equations where the block's symbols have these values, and others those that are fixed or drawn.
    fn at(
        &self,
        graph: &Graph,
        table: &Table,
        (seed, fixed): (u64, &FastMap<SymbolId, u64>),
        equations: &[ExprId],
        values: &[u64],
    ) -> Option<Vec<u64>> {
        let mut sample = Sample::new(seed);
        sample.fixed = fixed.clone();
        sample.fixed.extend(self.symbols.iter().copied().zip(values.iter().copied()));
        equations.iter().map(|e| sample.value(graph, table, *e)).collect()
    }

    /// The solutions of the linear equations: a start, and a direction if one is left.
    fn line(&self, at: &Evaluation) -> Option<(Vec<u64>, Option<Vec<u64>>)> {
        let n = self.symbols.len();
        let origin = at(&self.linear, &vec![0; n])?;
        let mut rows = vec![vec![0; n]; self.linear.len()];
        for j in 0..n {
            let mut unit = vec![0; n];
            unit[j] = 1;
            for (i, value) in at(&self.linear, &unit)?.into_iter().enumerate() {
                rows[i][j] = sub(value, origin[i]);
            }
        }
        let right: Vec<u64> = origin.into_iter().map(neg).collect();
        let start = if rows.is_empty() { vec![0; n] } else { field::solve(&rows, &right)? };
        let mut kernel = field::kernel(&rows, n);
        let expected = usize::from(self.quadratic.is_some());
        (kernel.len() == expected).then(|| (start, kernel.pop()))
    }

    /// The points of the line that solve the quadratic equation, in an order that depends on the draw.
    fn on_line(
        &self,
        at: &Evaluation,
        start: Vec<u64>,
        direction: Option<Vec<u64>>,
        seed: u64,
    ) -> Option<Vec<Vec<u64>>> {
        let (Some(direction), Some(quadratic)) = (direction, self.quadratic) else {
            return Some(vec![start]);
        };
        let point =
            |t: u64| -> Vec<u64> { start.iter().zip(&direction).map(|(s, d)| add(*s, mul(t, *d))).collect() };
        let value = |t: u64| Some(at(&[quadratic], &point(t))?[0]);
        let (middle, right, left) = (value(0)?, value(1)?, value(PRIME - 1)?);
        let half = PRIME.div_ceil(2);
        // a t^2 + b t + middle
        let a = sub(mul(add(right, left), half), middle);
        let b = mul(sub(right, left), half);
        if a == 0 {
            return Some(vec![point(neg(mul(middle, inverse(b)?)))]);
        }
        let root = field::sqrt(sub(mul(b, b), mul(4, mul(a, middle))))?;
        let scale = inverse(add(a, a))?;
        let (plus, minus) = (mul(sub(root, b), scale), mul(neg(add(root, b)), scale));
        let roots = if mix(seed) & 1 == 0 { [plus, minus] } else { [minus, plus] };
        Some(roots.into_iter().map(point).collect())
    }
}

/// The joint degree of an expression in some symbols; `None` above two, in denominators and in functions.
fn degree(graph: &Graph, e: ExprId, symbols: &[SymbolId]) -> Option<u32> {
    let mut degrees: FastMap<ExprId, Option<u32>> = FastMap::default();
    for id in graph.reachable(&[e], |_| false) {
        let degree = match graph.node(id) {
            Node::Symbol(symbol) => Some(u32::from(symbols.contains(symbol))),
            Node::Sum { terms, .. } => {
                terms.iter().try_fold(0, |degree: u32, (term, _)| Some(degree.max(degrees[term]?)))
            }
            Node::Product(factors) => {
                factors.iter().try_fold(0, |degree: u32, (base, e)| match degrees[base]? {
                    0 => Some(degree),
                    own => Some(degree + own * u32::try_from(*e).ok()?),
                })
            }
            Node::Kept(x) => degrees[x],
            _ => {
                graph.children(id).iter().try_fold(0, |_, child| degrees[child].filter(|degree| *degree == 0))
            }
        };
        degrees.insert(id, degree.filter(|degree| *degree <= 2));
    }
    degrees[&e]
}

/// An order in which the equations can be solved, found from its end: what is solved last disturbs nothing. Equations that are in the way
/// are left out; returned are the blocks, and which equations they have.
fn triangular(
    (graph, table): (&Graph, &Table),
    equations: &[ExprId],
    occurring: Vec<Vec<SymbolId>>,
) -> (Vec<Block>, Vec<usize>) {
    let polynomial = occurring.iter().zip(equations).map(|(symbols, e)| {
        let is_polynomial = |symbol: &SymbolId| degree(graph, *e, &[*symbol]).is_some();
        symbols.iter().copied().filter(is_polynomial).collect()
    });
    let polynomial: Vec<Vec<SymbolId>> = polynomial.collect();
    let mut remaining: Vec<usize> = (0..equations.len()).collect();
    let mut kept = Vec::new();
    let mut blocks = Vec::new();
    let last = |remaining: &[usize]| {
        (1..=LARGEST_BLOCK.min(remaining.len())).find_map(|size| {
            // A single equation should be linear if any is.
            [false, true].into_iter().find_map(|quadratic| {
                subsets(remaining, size).into_iter().find_map(|chosen| {
                    let occurrence = [&occurring[..], &polynomial];
                    last_block((graph, table), equations, occurrence, remaining, &chosen, quadratic)
                        .map(|block| (chosen, block))
                })
            })
        })
    };
    // No block has an equation in which nothing is a polynomial.
    remaining.retain(|i| !polynomial[*i].is_empty());
    let mut tries = TRIES_WITHOUT;
    while !remaining.is_empty() {
        let Some((chosen, mut block)) = last(&remaining) else {
            // Without one equation there may be a way. Lengths stay: squares of few symbols.
            let has_squares =
                |i: &usize| occurring[*i].iter().any(|s| degree(graph, equations[*i], &[*s]) == Some(2));
            let mut order = remaining.clone();
            order.reverse();
            order.sort_by_key(|i| (core::cmp::Reverse(occurring[*i].len()), has_squares(i)));
            let out = order.iter().copied().take(tries).find(|out| {
                tries -= 1;
                let others: Vec<usize> = remaining.iter().copied().filter(|i| i != out).collect();
                last(&others).is_some()
            });
            let out = out.unwrap_or(order[0]);
            remaining.retain(|i| *i != out);
            continue;
        };
        remaining.retain(|i| !chosen.contains(i));
        let mut free: Vec<SymbolId> = chosen.iter().flat_map(|i| occurring[*i].iter().copied()).collect();
        free.sort_unstable();
        free.dedup();
        free.retain(|s| !block.symbols.contains(s) && !remaining.iter().any(|i| occurring[*i].contains(s)));
        block.free = free;
        blocks.push(block);
        kept.extend(chosen);
    }
    // What a later block may draw again is fixed by the blocks before it only through their own equations.
    blocks.reverse();
    (blocks, kept)
}

/// The chosen equations as a block whose symbols occur in no other remaining equation; given which symbols occur in each, and in which
/// it is a polynomial of at most second degree.
fn last_block(
    (graph, table): (&Graph, &Table),
    equations: &[ExprId],
    [occurring, polynomial]: [&[Vec<SymbolId>]; 2],
    remaining: &[usize],
    chosen: &[usize],
    quadratic: bool,
) -> Option<Block> {
    let mut candidates: Vec<SymbolId> = chosen.iter().flat_map(|i| occurring[*i].iter().copied()).collect();
    candidates.sort_unstable();
    candidates.dedup();
    candidates.retain(|symbol| {
        matches!(graph.symbol_info(*symbol).role, Role::Coordinate | Role::Constant)
            && remaining.iter().all(|i| chosen.contains(i) || !occurring[*i].contains(symbol))
            && chosen.iter().all(|i| !occurring[*i].contains(symbol) || polynomial[*i].contains(symbol))
    });
    candidates.sort_by_key(|symbol| (graph.symbol_info(*symbol).role != Role::Coordinate, *symbol));
    let highest = if quadratic { 2 } else { 1 };
    subsets(&candidates, chosen.len()).into_iter().find_map(|symbols| {
        let mut block = Block { linear: Vec::new(), quadratic: None, symbols, free: Vec::new() };
        for i in chosen {
            match degree(graph, equations[*i], &block.symbols)? {
                1 => block.linear.push(equations[*i]),
                2 if highest == 2 && block.quadratic.is_none() => block.quadratic = Some(equations[*i]),
                _ => return None,
            }
        }
        block.is_regular(graph, table).then_some(block)
    })
}

/// The subsets of a size, in lexicographic order; not more than are worth a try.
fn subsets<T: Copy>(items: &[T], size: usize) -> Vec<Vec<T>> {
    let mut found = Vec::new();
    if size > items.len() {
        return found;
    }
    let mut indices: Vec<usize> = (0..size).collect();
    loop {
        found.push(indices.iter().map(|i| items[*i]).collect());
        if found.len() == LARGEST_SEARCH {
            return found;
        }
        let Some(k) = (0..size).rev().find(|&k| indices[k] < items.len() - size + k) else { return found };
        indices[k] += 1;
        for j in k + 1..size {
            indices[j] = indices[j - 1] + 1;
        }
    }
}
