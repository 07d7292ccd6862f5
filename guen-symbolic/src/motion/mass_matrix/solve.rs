//! `M eta' = f` by a straight-line `L D L^T` factorisation of each block of the mass matrix.

use super::cancellation;
use super::sparse::Vector;
use crate::algebra::ExprId;
use crate::geometry::{ADJUGATE_SIZE, adjugate};
use crate::motion::coordinates::restriction::written_out;
use crate::motion::thresholds::BLOCK_WRITTEN_OUT;
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// The solved accelerations.
#[derive(Clone, Debug)]
pub struct Solution {
    /// `eta_1'..eta_l'`.
    pub accelerations: Vec<ExprId>,
    /// Pivots of small blocks that depend on the state: with the chart's functions, the domain of the equations.
    pub pivots: Vec<ExprId>,
    /// The larger blocks by the parameters of their rows, with their determinants where these depend on the state.
    pub determinants: Vec<(Vec<usize>, ExprId)>,
    /// Pivots that depend on constants alone: checked when a system is prepared.
    pub constant_pivots: Vec<ExprId>,
}

impl Solution {
    /// Solves the equations, or names a combination of parameters without inertia: rows that are dependent.
    pub fn new(bench: &mut Workbench, mass: &[Vec<ExprId>], forces: &[ExprId]) -> Result<Self, Vec<usize>> {
        Self::of_blocks(bench, mass, forces, Pairs::WrittenOut)
    }

    /// Solves with the first solutions kept whole in small blocks, too; `None` where there is nothing to share.
    pub(in crate::motion) fn shared(
        bench: &mut Workbench,
        mass: &[Vec<ExprId>],
        forces: &[ExprId],
    ) -> Option<Self> {
        let pairs = blocks(bench, mass).into_iter().filter(|block| block.len() == BLOCK_WRITTEN_OUT);
        let is_coupled = |block: Vec<usize>| !bench.graph.roles(mass[block[0]][block[1]]).is_constant();
        if !pairs.into_iter().any(is_coupled) {
            return None;
        }
        Self::of_blocks(bench, mass, forces, Pairs::Shared).ok()
    }

    /// Solves pairs whose determinant is a constant by dividing by it alone, as those of a body of revolution that rolls on its rim, in its
    /// axes; `None` where there are none.
    pub(in crate::motion) fn by_constant_determinants(
        bench: &mut Workbench,
        mass: &[Vec<ExprId>],
        forces: &[ExprId],
    ) -> Option<Self> {
        let pairs = blocks(bench, mass).into_iter().filter(|block| block.len() == 2);
        let pairs: Vec<Vec<usize>> = pairs.collect();
        let matrix = |block: &[usize]| -> Vec<Vec<ExprId>> {
            block.iter().map(|s| block.iter().map(|t| mass[*s][*t]).collect()).collect()
        };
        if !pairs.iter().any(|block| constant_determinant(bench, &matrix(block)).is_some()) {
            return None;
        }
        Self::of_blocks(bench, mass, forces, Pairs::ByDeterminant).ok()
    }

    fn of_blocks(
        bench: &mut Workbench,
        mass: &[Vec<ExprId>],
        forces: &[ExprId],
        pairs: Pairs,
    ) -> Result<Self, Vec<usize>> {
        let l = mass.len();
        if let Some(rank) = bench.zero.rank(&mut bench.graph, mass, true)
            && rank < l
        {
            return Err(dependent_rows(bench, mass));
        }
        let zero = bench.graph.zero();
        let mut solution = Solution {
            accelerations: vec![zero; l],
            pivots: Vec::new(),
            determinants: Vec::new(),
            constant_pivots: Vec::new(),
        };
        for block in blocks(bench, mass) {
            let matrix: Vec<Vec<ExprId>> =
                block.iter().map(|s| block.iter().map(|t| mass[*s][*t]).collect()).collect();
            let right: Vec<ExprId> = block.iter().map(|s| forces[*s]).collect();
            let values =
                solution.solve_block(bench, &block, matrix, right, pairs).ok_or_else(|| block.clone())?;
            for (s, value) in block.into_iter().zip(values) {
                solution.accelerations[s] = value;
            }
        }
        Ok(solution)
    }

    /// Accelerations of which each is coupled to all others, and the pivots by which they were found: these vanish nowhere but
    /// where the mass matrix does not have its rank.
    pub(in crate::motion) fn of_pivots(
        bench: &mut Workbench,
        accelerations: Vec<ExprId>,
        pivots: &[ExprId],
    ) -> Self {
        let rows = (0..accelerations.len()).collect();
        let mut solution = Self::known(bench, accelerations, &[]);
        let factors: Vec<_> = pivots.iter().map(|pivot| (*pivot, 1)).collect();
        let determinant = bench.graph.product(&factors);
        if bench.graph.roles(determinant).is_constant() {
            solution.require(bench, determinant);
        } else {
            solution.determinants.push((rows, determinant));
        }
        solution
    }

    /// Accelerations that were found in another way; what was divided by must not vanish.
    pub(in crate::motion) fn known(
        bench: &Workbench,
        accelerations: Vec<ExprId>,
        divisors: &[ExprId],
    ) -> Self {
        let (pivots, determinants, constant_pivots) = Default::default();
        let mut solution = Solution { accelerations, pivots, determinants, constant_pivots };
        divisors.iter().for_each(|divisor| solution.require(bench, *divisor));
        solution
    }

    fn solve_block(
        &mut self,
        bench: &mut Workbench,
        rows: &[usize],
        m: Vec<Vec<ExprId>>,
        f: Vec<ExprId>,
        pairs: Pairs,
    ) -> Option<Vec<ExprId>> {
        let n = m.len();
        if n == 2
            && pairs == Pairs::ByDeterminant
            && let Some(determinant) = constant_determinant(bench, &m)
        {
            self.require(bench, determinant);
            return Some(by_determinant(bench, &m, &f, determinant));
        }
        let naming = match n {
            0..=BLOCK_WRITTEN_OUT if pairs == Pairs::Shared => Naming::Values,
            0..=BLOCK_WRITTEN_OUT => Naming::Nothing,
            _ => Naming::Everything,
        };
        let Some(Elimination { mut values, pivots }) =
            eliminate(bench, sparse_rows(bench, &m), f.clone(), naming, choose_pivot)
        else {
            return self.solve_by_adjugate(bench, &m, &f);
        };
        if n == 2 && !bench.graph.roles(pivots[1]).is_constant() {
            let first = usize::from(pivots[0] != m[0][0]);
            let uncancelled = put_back(bench, &m, &f, first, pivots[1]);
            values[first] = uncancelled.unwrap_or(values[first]);
        }
        if n > BLOCK_WRITTEN_OUT {
            let factors: Vec<_> = pivots.iter().map(|pivot| (*pivot, 1)).collect();
            let determinant = bench.graph.product(&factors);
            if bench.graph.roles(determinant).is_constant() {
                self.require(bench, determinant);
            } else {
                self.determinants.push((rows.to_vec(), determinant));
            }
        } else {
            pivots.into_iter().for_each(|pivot| self.require(bench, pivot));
        }
        Some(values)
    }

    fn solve_by_adjugate(
        &mut self,
        bench: &mut Workbench,
        m: &[Vec<ExprId>],
        f: &[ExprId],
    ) -> Option<Vec<ExprId>> {
        if m.len() > ADJUGATE_SIZE {
            return None;
        }
        let (adjugate, determinant) = adjugate(bench, m);
        // Where no point of the manifold was found the rank did not tell.
        if bench.graph.is_zero(determinant) {
            return None;
        }
        self.require(bench, determinant);
        Some(
            adjugate
                .iter()
                .map(|row| {
                    let product = bench.dot(row, f);
                    bench.graph.div(product, determinant)
                })
                .collect(),
        )
    }

    fn require(&mut self, bench: &Workbench, pivot: ExprId) {
        if bench.graph.manifestly_nonzero(pivot) {
            return;
        }
        let list =
            if bench.graph.roles(pivot).is_constant() { &mut self.constant_pivots } else { &mut self.pivots };
        if !list.contains(&pivot) {
            list.push(pivot);
        }
    }
}

/// The way in which coupled pairs of equations are solved.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pairs {
    /// Elimination without names.
    WrittenOut,
    /// Elimination with the first solution kept whole.
    Shared,
    /// The determinant where it is a constant.
    ByDeterminant,
}

/// The determinant of a coupled pair, if it is a constant and some entry is not.
fn constant_determinant(bench: &mut Workbench, m: &[Vec<ExprId>]) -> Option<ExprId> {
    if m.iter().flatten().all(|e| bench.graph.roles(*e).is_constant()) {
        return None;
    }
    let (first, second) = (bench.graph.mul(m[0][0], m[1][1]), bench.graph.mul(m[0][1], m[1][0]));
    let determinant = bench.graph.sub(first, second);
    let determinant = written_out(bench, determinant);
    let determinant = bench.tidy(determinant);
    (bench.graph.roles(determinant).is_constant() && !bench.graph.is_zero(determinant)).then_some(determinant)
}

/// The solution of a pair of equations by its determinant.
fn by_determinant(
    bench: &mut Workbench,
    m: &[Vec<ExprId>],
    f: &[ExprId],
    determinant: ExprId,
) -> Vec<ExprId> {
    let values = [(0, 1), (1, 0)].map(|(own, other)| {
        let (plus, minus) = (bench.graph.mul(m[other][other], f[own]), bench.graph.mul(m[0][1], f[other]));
        let above = bench.graph.sub(plus, minus);
        bench.graph.div(above, determinant)
    });
    values.to_vec()
}

/// The result of an elimination.
pub(in crate::motion) struct Elimination {
    /// The solution.
    pub(in crate::motion) values: Vec<ExprId>,
    /// The pivots, in their order.
    pub(super) pivots: Vec<ExprId>,
}

/// The results of an elimination that are kept whole.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::motion) enum Naming {
    /// No names: small blocks are written out, and simplify.
    Nothing,
    /// The solutions that are computed first and that the others use.
    Values,
    /// Names for everything: in larger blocks every intermediate result has many users.
    Everything,
    /// Names for everything, of a matrix that is positive definite and sparse: entries that vanish are not looked for.
    Definite,
}

/// A step of an elimination.
struct Step {
    /// The row that leaves.
    row: usize,
    /// The entry of the row on the diagonal.
    pivot: ExprId,
    /// The rows that it meets, with their multipliers `L_rk`.
    multipliers: Vec<(usize, ExprId)>,
}

/// The rows of a matrix without what is zero.
fn sparse_rows(bench: &Workbench, m: &[Vec<ExprId>]) -> Vec<Vector> {
    m.iter().map(|row| Vector::of_list(&bench.graph, row)).collect()
}

/// Solves a symmetric system by `L D L^T`; `None` where nothing is chosen as a pivot. `choose` picks the next one from
/// the rows that are left, which have no components at those that are not.
pub(in crate::motion) fn eliminate(
    bench: &mut Workbench,
    mut m: Vec<Vector>,
    mut f: Vec<ExprId>,
    naming: Naming,
    mut choose: impl FnMut(&mut Workbench, &[Vector], &[usize]) -> Option<usize>,
) -> Option<Elimination> {
    let n = m.len();
    let names_all = matches!(naming, Naming::Everything | Naming::Definite);
    let keep = |bench: &mut Workbench, e: ExprId| if names_all { bench.graph.keep(e) } else { e };
    let entries = m.iter_mut().flat_map(Vector::entries_mut).map(|(_, e)| e);
    for e in entries.chain(&mut f) {
        *e = keep(bench, *e);
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut steps: Vec<Step> = Vec::new();
    while !left.is_empty() {
        let k = choose(bench, &m, &left)?;
        left.retain(|r| *r != k);
        let row = core::mem::take(&mut m[k]);
        let pivot = row.get(k).unwrap_or(bench.graph.zero());
        let mut multipliers = Vec::new();
        for (r, entry) in row.entries().iter().filter(|(r, _)| *r != k) {
            m[*r].remove(k);
            let quotient = bench.graph.div(*entry, pivot);
            // In a sparse matrix a multiplier has three users at least, and no other row its divisor.
            let factor = match naming {
                Naming::Definite => bench.graph.keep_whole(quotient),
                _ => keep(bench, quotient),
            };
            multipliers.push((*r, factor, *entry));
        }
        for (i, (r, factor, _)) in multipliers.iter().enumerate() {
            for (c, _, entry) in &multipliers[..=i] {
                let product = bench.graph.mul(*factor, *entry);
                let before = m[*r].get(*c).unwrap_or(bench.graph.zero());
                let difference = bench.graph.sub(before, product);
                let entry = if naming == Naming::Definite { difference } else { bench.dropped(difference) };
                let entry = keep(bench, entry);
                m[*r].set(&bench.graph, *c, entry);
                m[*c].set(&bench.graph, *r, entry);
            }
            let product = bench.graph.mul(*factor, f[k]);
            let rest = bench.graph.sub(f[*r], product);
            f[*r] = keep(bench, rest);
        }
        let multipliers = multipliers.into_iter().map(|(r, factor, _)| (r, factor)).collect();
        steps.push(Step { row: k, pivot, multipliers });
    }
    let pivots = steps.iter().map(|step| step.pivot).collect();
    // L^T x = D^-1 f', backwards.
    let mut values = vec![bench.graph.zero(); n];
    let mut last = true;
    for Step { row: k, pivot, multipliers } in steps.into_iter().rev() {
        let mut terms = vec![bench.graph.div(f[k], pivot)];
        for (r, factor) in multipliers {
            let product = bench.graph.mul(factor, values[r]);
            terms.push(bench.graph.neg(product));
        }
        let value = bench.graph.sum(terms);
        values[k] = if naming == Naming::Values && last {
            last = false;
            let tidy = bench.tidy(value);
            bench.graph.keep(tidy)
        } else {
            keep(bench, value)
        };
    }
    Some(Elimination { values, pivots })
}

/// The entry of a pair that was eliminated first, without what cancels in it, if anything does; `d` is the last pivot.
fn put_back(
    bench: &mut Workbench,
    m: &[Vec<ExprId>],
    f: &[ExprId],
    first: usize,
    d: ExprId,
) -> Option<ExprId> {
    let other = 1 - first;
    let (p, coupling) = (m[first][first], m[other][first]);
    let factor = bench.graph.div(coupling, p);
    let product = bench.graph.mul(factor, f[first]);
    let g = bench.graph.sub(f[other], product);
    let numerator = cancellation::difference(&mut bench.graph, [f[first], d], [coupling, g])?;
    Some(bench.graph.product(&[(numerator, 1), (p, -1), (d, -1)]))
}

/// The diagonal entry to eliminate on: constants before functions, then the one with the fewest neighbours.
fn choose_pivot(bench: &mut Workbench, m: &[Vector], left: &[usize]) -> Option<usize> {
    // A row without the entry on the diagonal is not divided by.
    let diagonal = |k: usize| m[k].get(k);
    let mut candidates: Vec<(bool, usize, usize)> = left
        .iter()
        .filter_map(|k| Some((!bench.graph.roles(diagonal(*k)?).is_constant(), m[*k].len() - 1, *k)))
        .collect();
    candidates.sort_unstable();
    candidates
        .into_iter()
        .map(|(_, _, k)| k)
        .find(|k| diagonal(*k).is_some_and(|e| bench.verdict_on_manifold(e) == Verdict::Nonzero))
}

/// The connected components of the matrix's pattern, in order of their first rows.
fn blocks(bench: &Workbench, mass: &[Vec<ExprId>]) -> Vec<Vec<usize>> {
    let l = mass.len();
    let mut seen = vec![false; l];
    let mut found = Vec::new();
    for start in 0..l {
        let mut block = Vec::new();
        let mut stack = vec![start];
        while let Some(s) = stack.pop() {
            if !seen[s] {
                seen[s] = true;
                block.push(s);
                stack.extend((0..l).filter(|t| !bench.graph.is_zero(mass[s][*t])));
            }
        }
        if !block.is_empty() {
            block.sort_unstable();
            found.push(block);
        }
    }
    found
}

/// A smallest set of rows that is linearly dependent, found by rank.
fn dependent_rows(bench: &mut Workbench, rows: &[Vec<ExprId>]) -> Vec<usize> {
    let mut support: Vec<usize> = (0..rows.len()).collect();
    for k in 0..rows.len() {
        let trial: Vec<usize> = support.iter().copied().filter(|r| *r != k).collect();
        let matrix: Vec<Vec<ExprId>> = trial.iter().map(|r| rows[*r].clone()).collect();
        if !trial.is_empty()
            && bench.zero.rank(&mut bench.graph, &matrix, true).is_some_and(|rank| rank < trial.len())
        {
            support = trial;
        }
    }
    support
}
