//! Formulation "constraint forces": the reactions between velocity forms are the unknowns.
//!
//! In a chain each mass feels its two links only, but in the mass matrix `M = U^T D U` of the parameters every link meets
//! every other: the forms `u = U eta` of the particles are long sums. As differences from each other, `S u = B eta` with
//! the tree `S` of `tree`, they are short, and the equations
//!
//! ```text
//! U^T D u' = g,   u' = U eta' + D(u)
//! ```
//!
//! are, with the reactions `lambda` of the differences,
//!
//! ```text
//! D u' = S^T lambda,   S u' = B eta' + c,   B^T lambda = g,
//! ```
//!
//! all of them sparse. The rates `u'` go first, for the masses are positive: `K = S D^-1 S^T`, `B eta' = K lambda - c`.
//! Then `lambda = lambda_c + P^T g + N sigma` with `B^T N = 0` and `P B = 1` of `balance`, which leaves the unknowns `sigma`,
//!
//! ```text
//! N^T K N sigma = N^T (c - K (lambda_c + P^T g)),   eta' = P (K lambda - c).
//! ```
//!
//! `N^T K N` is positive definite wherever the mass matrix is regular, so that its elimination needs no licence for a
//! pivot and may go in the order of least fill; for a chain it is tridiagonal. `lambda_c` is constant and takes forces
//! like weight out of `g` where they are constant along a difference: at rest the constraint forces are known.

mod balance;
mod pattern;
mod system;
mod tree;

use crate::algebra::{ExprId, Rational};
use crate::motion::Frame;
use crate::motion::coordinates::relative_angles::RelativeAngles;
use crate::motion::definition::projection::Squares;
use crate::motion::mass_matrix::sparse::{Columns, Vector};
use crate::motion::thresholds::DENSE_COST;
use crate::workbench::Workbench;
use balance::{Balance, balance};
use pattern::Pattern;
use system::{System, spread, summands, terms, terms_with_whole_factors, with_whole_factors};

pub(super) use tree::{Differences, Edge};

/// The accelerations by constraint forces.
pub(super) struct ByConstraintForces {
    /// `eta_1'..eta_l'`.
    pub(super) accelerations: Vec<ExprId>,
    /// The divisors of the elimination: they vanish only where the mass matrix is singular.
    pub(super) divisors: Vec<ExprId>,
    /// Whether the mass matrix would cost much more, judged by the patterns of both.
    pub(super) is_clear: bool,
}

/// The tree of the forms.
struct Tree<'a> {
    edges: &'a [Option<Edge>],
    /// The forms that are taken relative to each form, with their multiples.
    children: Vec<Vec<(usize, &'a Rational)>>,
    /// `1/m_k`.
    weights: &'a [ExprId],
}

impl<'a> Tree<'a> {
    fn new(edges: &'a [Option<Edge>], weights: &'a [ExprId]) -> Self {
        let mut children: Vec<Vec<(usize, &Rational)>> = vec![Vec::new(); edges.len()];
        for (child, edge) in edges.iter().enumerate() {
            if let Some(Edge { parent, multiple }) = edge {
                children[*parent].push((child, multiple));
            }
        }
        Tree { edges, children, weights }
    }

    /// `S^T y`.
    fn of(&self, bench: &mut Workbench, y: &Vector) -> Vector {
        let mut image = Vector::default();
        for (k, e) in y.entries() {
            image.add(bench, *k, *e);
            if let Some(Edge { parent, multiple }) = &self.edges[*k] {
                let part = bench.graph.scale(*e, &-multiple.clone());
                image.add(bench, *parent, part);
            }
        }
        image
    }

    /// `K y` for `z = S^T y`: the differences of the rates.
    fn rates(&self, bench: &mut Workbench, z: &Vector) -> Vector {
        let mut found = Vector::default();
        for (k, e) in z.entries() {
            let rate = bench.graph.mul(*e, self.weights[*k]);
            let rate = bench.tidy(rate);
            found.add(bench, *k, rate);
            for (child, multiple) in &self.children[*k] {
                let part = bench.graph.scale(rate, &-(*multiple).clone());
                found.add(bench, *child, part);
            }
        }
        found
    }
}

/// Estimates the cost of solving a mass matrix, from its pattern.
pub(super) fn dense_cost(bench: &Workbench, mass: &[Vec<ExprId>]) -> usize {
    pattern::of_mass(bench, mass).cost()
}

/// Solves by constraint forces between forms whose squares are the energy: see [`solve`].
pub(super) fn solve_squares(
    bench: &mut Workbench,
    frame: &mut Frame,
    squares: &Squares,
    theirs: usize,
    etas: &[ExprId],
    forces: &[ExprId],
) -> Option<ByConstraintForces> {
    if theirs < DENSE_COST {
        return None;
    }
    let differences = Differences::of_squares(bench, squares)?;
    solve(bench, frame, differences, theirs, etas, forces)
}

/// Solves by constraint forces, where that is possible and promises to be cheaper than the mass matrix, of which the cost is
/// estimated. `etas` and `forces` are those of the frame, the forces without `T` and `U`.
pub(super) fn solve(
    bench: &mut Workbench,
    frame: &mut Frame,
    Differences { masses, edges, rows, drifts, rest }: Differences,
    theirs: usize,
    etas: &[ExprId],
    forces: &[ExprId],
) -> Option<ByConstraintForces> {
    let l = etas.len();
    let mut coupling: Vec<usize> = edges.iter().map(|edge| usize::from(edge.is_some())).collect();
    edges.iter().flatten().for_each(|edge| coupling[edge.parent] += 1);
    let Balance { inverse, null, divisors } = balance(bench, &rows, l, &coupling)?;
    let weights: Vec<ExprId> = masses.iter().map(|mass| bench.graph.powi(*mass, -1)).collect();
    let tree = Tree::new(&edges, &weights);
    let across: Vec<Vector> = null.iter().map(|y| tree.of(bench, y)).collect();
    let along: Vec<Vector> = inverse.iter().map(|y| tree.of(bench, y)).collect();
    let sparse = Pattern::of_products(&across, &along);
    let ours = sparse.cost();
    // An estimate: a solution that it finds a little more expensive may be cheaper.
    if 4 * ours > 5 * theirs {
        return None;
    }

    // Forces, and differences of the accelerations at eta' = 0.
    let mut rest: Vec<Vec<ExprId>> = (0..l)
        .map(|s| {
            let e = bench.graph.add(rest[s], forces[s]);
            // A limit on the work for an expression would make the members of a long family different.
            if bench.graph.nests_sums() {
                return terms_with_whole_factors(bench, e);
            }
            let e = with_whole_factors(bench, e);
            let found = terms(bench, e, etas);
            spread(bench, found)
        })
        .collect();
    let constant = constant_reactions(bench, &rows, &inverse, &mut rest);
    let constant = tree.of(bench, &constant);
    let known = tree.rates(bench, &constant);
    let accelerations: Vec<Vec<ExprId>> = (0..rows.len())
        .map(|k| {
            let mut parts = vec![frame.motion.of(&mut bench.graph, drifts[k])];
            for (s, e) in rows[k].entries() {
                let rate = frame.motion.of(&mut bench.graph, *e);
                parts.push(bench.graph.mul(rate, etas[*s]));
            }
            if let Some(e) = known.get(k) {
                parts.push(bench.graph.neg(e));
            }
            parts
        })
        .collect();
    let rest: Vec<ExprId> = rest.into_iter().map(|terms| bench.graph.sum(terms)).collect();

    // N^T K N sigma = N^T c - N^T K P^T g
    let count = null.len();
    let (columns, rests) = (Columns::new(&across), Columns::new(&along));
    let mut matrix = vec![Vector::default(); count];
    for s in 0..count {
        for t in columns.meeting(&across[s]).into_iter().filter(|t| *t <= s) {
            let entry = across[s].dot(bench, &across[t], &weights);
            matrix[s].set(&bench.graph, t, entry);
            matrix[t].set(&bench.graph, s, entry);
        }
    }
    let mut right: Vec<Vec<ExprId>> = Vec::new();
    for (y, own) in null.iter().zip(&across) {
        let sum = weighted(bench, y, &accelerations);
        let mut parts = terms(bench, sum, etas);
        push_products(bench, &mut parts, own, (&along, &rests), &weights, &rest, true);
        right.push(parts);
    }
    // eta' = P K N sigma + P K P^T g - P c
    let mut coupled: Vec<Vec<(usize, ExprId)>> = Vec::new();
    let mut direct: Vec<Vec<ExprId>> = Vec::new();
    for (y, own) in inverse.iter().zip(&along) {
        let meeting = columns.meeting(own).into_iter();
        coupled.push(meeting.map(|t| (t, own.dot(bench, &across[t], &weights))).collect());
        let sum = weighted(bench, y, &accelerations);
        let mut parts = terms(bench, sum, etas);
        for e in &mut parts {
            *e = bench.graph.neg(*e);
        }
        push_products(bench, &mut parts, own, (&along, &rests), &weights, &rest, false);
        direct.push(parts);
    }
    let mut system = System { matrix, right, coupled, direct };
    let between = RelativeAngles::new(bench, &system.entries());
    if !between.is_empty() {
        // Only neighbours meet: in the angles between them the entries are short.
        let other = system.rewritten(bench, &between, etas);
        if other.cost(bench, &frame.velocities) < system.cost(bench, &frame.velocities) {
            system = other;
        }
    }
    let accelerations = system.solved(bench)?;
    Some(ByConstraintForces { accelerations, divisors, is_clear: 2 * ours <= theirs })
}

/// `sum_k y_k (sum of parts_k)`.
fn weighted(bench: &mut Workbench, y: &Vector, parts: &[Vec<ExprId>]) -> ExprId {
    let mut all = Vec::new();
    for (k, e) in y.entries() {
        for part in &parts[*k] {
            all.push(bench.graph.mul(*e, *part));
        }
    }
    bench.graph.sum(all)
}

/// Adds the terms of `own^T D^-1 S^T P^T g`, or of its negative.
fn push_products(
    bench: &mut Workbench,
    parts: &mut Vec<ExprId>,
    own: &Vector,
    (along, columns): (&[Vector], &Columns),
    weights: &[ExprId],
    rest: &[ExprId],
    negative: bool,
) {
    for s in columns.meeting(own) {
        if !bench.graph.is_zero(rest[s]) {
            let factor = own.dot(bench, &along[s], weights);
            let factor = if negative { bench.graph.neg(factor) } else { factor };
            parts.push(bench.graph.mul(factor, rest[s]));
        }
    }
}

/// Reactions that are constant and take terms out of the forces: `g - B^T lambda_c` is what is left, and rather of those
/// parameters that have a difference of their own.
fn constant_reactions(
    bench: &mut Workbench,
    rows: &[Vector],
    inverse: &[Vector],
    rest: &mut [Vec<ExprId>],
) -> Vector {
    let mut found = Vector::default();
    for (k, row) in rows.iter().enumerate() {
        let dearness = |lists: &[(usize, Vec<ExprId>)]| -> usize {
            lists.iter().map(|(s, terms)| terms.len() * inverse[*s].len()).sum()
        };
        let own: Vec<(usize, Vec<ExprId>)> =
            row.entries().iter().map(|(s, _)| (*s, rest[*s].clone())).collect();
        let mut best = (dearness(&own), None);
        for (s, b) in row.entries() {
            let is_its_own = matches!(inverse[*s].entries(), [(own, _)] if *own == k);
            let mut ratios = Vec::new();
            for term in &rest[*s] {
                let ratio = bench.graph.div(*term, *b);
                let is_known = bench.graph.roles(ratio).is_constant() || !is_its_own;
                if is_known && balance::divides_as(bench, ratio, *term) {
                    ratios.push(ratio);
                }
            }
            if ratios.is_empty() {
                continue;
            }
            let ratio = bench.graph.sum(ratios);
            let mut changed = Vec::new();
            for (s, b) in row.entries() {
                let product = bench.graph.mul(ratio, *b);
                let left = bench.graph.sum(rest[*s].iter().copied());
                let left = bench.graph.sub(left, product);
                let tidy = bench.tidy(left);
                let lists = [tidy, left].map(|left| summands(bench, left));
                changed.push((*s, lists.into_iter().min_by_key(Vec::len).unwrap_or_default()));
            }
            let left = dearness(&changed);
            if left < best.0 {
                best = (left, Some((ratio, changed)));
            }
        }
        if let (_, Some((ratio, changed))) = best {
            changed.into_iter().for_each(|(s, left)| rest[s] = left);
            found.add(bench, k, ratio);
        }
    }
    found
}
