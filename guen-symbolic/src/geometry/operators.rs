//! The operators of displacement (1.4), (1.7): `xi = A^-1` and `xi_0 = -A^-1 a_0`, without pivots that can vanish.
//!
//! Rows are eliminated on entries that are nonzero numbers, or constants that the declaration promises to
//! be nonzero, rows of constraints first. What remains is split into the blocks of its block triangular
//! form; a block is inverted by `K^T D^-1` when its rows are orthogonal, else by its adjugate. Pivoting on a
//! function that can vanish would make the operators wrong near its zeros although the forms are regular there.

use std::collections::BTreeMap;

use super::Forms;
use super::blocks::blocks;
use super::dependence::{SingularForms, dependencies};
use super::minors::{ADJUGATE_SIZE, adjugate};
use crate::algebra::{ExprId, Graph, Node};
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// The number of coordinates above which entries of the operators that are made of others stay factored: their number
/// is the square of that of the coordinates.
pub(crate) const MANY_COORDINATES: usize = 24;

/// The operators `X_0..X_n` by their coefficients.
#[derive(Clone, Debug)]
pub struct Operators {
    /// `xi[j][i]`, the coefficient of `d/dx_{i+1}` in `X_j`, `j` from 0.
    pub xi: Vec<Vec<ExprId>>,
    /// Functions of `t, x` that must not vanish: the factors of `det A` that are not constants.
    pub chart: Vec<ExprId>,
    /// The forms that are dependent where each of them vanishes, counted from 0.
    pub chart_forms: Vec<Vec<usize>>,
    /// Functions of constants alone that must not vanish.
    pub constant_pivots: Vec<ExprId>,
    /// Entries made of constants alone that would be divided by if it were promised that they do not vanish.
    pub unpromised: Vec<ExprId>,
    /// The steps of solving the forms.
    pub(crate) steps: Vec<Step>,
}

/// A step of the solution of the forms, to be repeated with other right sides. Forms and coordinates are counted from 0.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    /// A form, divided by its entry for a coordinate, is subtracted from others.
    Subtract {
        form: usize,
        pivot: ExprId,
        /// Forms, each with its entry for the coordinate.
        others: Vec<(usize, ExprId)>,
    },
    /// A block of forms is solved for as many coordinates.
    Block {
        /// Each form with what it has for coordinates that are known.
        forms: Vec<(usize, Vec<(usize, ExprId)>)>,
        coordinates: Vec<usize>,
        inverse: Vec<Vec<ExprId>>,
    },
    /// A coordinate from a form that was subtracted, with its entries for coordinates that are known.
    Back { form: usize, coordinate: usize, known: Vec<(usize, ExprId)> },
}

/// A linear equation `sum_c entries[c] x_c' = sum_j right[j] eta_j`, where `right[0]` goes with the number one.
#[derive(Clone)]
struct Equation {
    /// The form that it was.
    form: usize,
    entries: BTreeMap<usize, ExprId>,
    right: BTreeMap<usize, ExprId>,
}

impl Operators {
    /// The `x'` of which the forms have these values, `A x' = right`, each from those before it: where coordinates depend on
    /// each other one after the other, that is much less than a product with `A^-1`. `None` where it is not known how.
    pub(crate) fn solved(&self, bench: &mut Workbench, mut right: Vec<ExprId>) -> Option<Vec<ExprId>> {
        if self.steps.is_empty() {
            return None;
        }
        let mut found = vec![bench.graph.zero(); right.len()];
        let less = |bench: &mut Workbench, e: ExprId, known: &[(usize, ExprId)], values: &[ExprId]| {
            let mut terms = vec![e];
            for (c, a) in known {
                let product = bench.graph.mul(*a, values[*c]);
                terms.push(bench.graph.neg(product));
            }
            bench.graph.sum(terms)
        };
        for step in &self.steps {
            match step {
                Step::Subtract { form, pivot, others } => {
                    let own = bench.graph.div(right[*form], *pivot);
                    right[*form] = bench.keep_large(own);
                    for (other, factor) in others {
                        let product = bench.graph.mul(*factor, right[*form]);
                        right[*other] = bench.graph.sub(right[*other], product);
                    }
                }
                Step::Block { forms, coordinates, inverse } => {
                    let sides: Vec<ExprId> = forms
                        .iter()
                        .map(|(form, known)| {
                            let side = less(bench, right[*form], known, &found);
                            bench.keep_large(side)
                        })
                        .collect();
                    for (coordinate, row) in coordinates.iter().zip(inverse) {
                        let value = bench.dot(row, &sides);
                        found[*coordinate] = bench.keep_large(value);
                    }
                }
                Step::Back { form, coordinate, known } => {
                    let value = less(bench, right[*form], known, &found);
                    found[*coordinate] = bench.keep_large(value);
                }
            }
        }
        Some(found)
    }

    /// The entries of each coordinate that differ from zero, with their operators.
    pub(crate) fn by_coordinate(&self, graph: &Graph) -> Vec<Vec<(usize, ExprId)>> {
        let mut columns = vec![Vec::new(); self.xi.len() - 1];
        for (j, row) in self.xi.iter().enumerate() {
            for (i, e) in row.iter().enumerate() {
                if !graph.is_zero(*e) {
                    columns[i].push((j, *e));
                }
            }
        }
        columns
    }

    /// Inverts the forms, or lists what makes them dependent.
    pub fn new(bench: &mut Workbench, forms: &Forms) -> Result<Self, Vec<SingularForms>> {
        let n = forms.len();
        let singular = dependencies(bench, forms);
        if !singular.is_empty() {
            return Err(singular);
        }
        let mut equations: Vec<Option<Equation>> = Vec::with_capacity(n);
        for (j, form) in forms.forms.iter().enumerate() {
            let entries = form
                .row
                .iter()
                .enumerate()
                .filter(|(_, a)| !bench.graph.is_zero(**a))
                .map(|(c, a)| (c, *a))
                .collect();
            let mut right = BTreeMap::from([(j + 1, bench.graph.one())]);
            if !bench.graph.is_zero(form.offset) {
                right.insert(0, bench.graph.neg(form.offset));
            }
            equations.push(Some(Equation { form: j, entries, right }));
        }
        let (chart, chart_forms, constant_pivots, solved, steps) = Default::default();
        let is_large = n > MANY_COORDINATES;
        let mut solver =
            Solver { bench, chart, chart_forms, constant_pivots, solved, steps, is_large, beyond: None };
        solver.eliminate(&mut equations, forms.degrees);
        let core: Vec<Equation> = equations.into_iter().flatten().collect();
        let entries = core.iter().flat_map(|equation| equation.entries.values());
        let mut unpromised: Vec<ExprId> =
            entries.copied().filter(|e| solver.bench.graph.roles(*e).is_constant()).collect();
        unpromised.sort_unstable();
        unpromised.dedup();
        let mut values: Vec<Option<BTreeMap<usize, ExprId>>> = vec![None; n];
        solver.solve_core(core, forms.degrees, &mut values).map_err(|singular| vec![singular])?;
        solver.substitute_back(&mut values);
        let Solver { chart, chart_forms, constant_pivots, steps, .. } = solver;
        let zero = bench.graph.zero();
        let xi = (0..=n)
            .map(|j| {
                values
                    .iter()
                    .map(|value| {
                        let value = value.as_ref().expect("every coordinate is solved for");
                        value.get(&j).copied().unwrap_or(zero)
                    })
                    .collect()
            })
            .collect();
        Ok(Operators { xi, chart, chart_forms, constant_pivots, unpromised, steps })
    }
}

struct Solver<'a> {
    bench: &'a mut Workbench,
    chart: Vec<ExprId>,
    chart_forms: Vec<Vec<usize>>,
    constant_pivots: Vec<ExprId>,
    // Columns with the equations that give them, in the order of elimination.
    solved: Vec<(usize, Equation)>,
    steps: Vec<Step>,
    /// Whether there are many coordinates.
    is_large: bool,
    /// The least cost of an entry that has no normal form.
    beyond: Option<u64>,
}

impl Solver<'_> {
    /// Eliminates on pivots that cannot vanish, cheapest fill first, rows of constraints first.
    fn eliminate(&mut self, equations: &mut [Option<Equation>], degrees: usize) {
        loop {
            let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
            for equation in equations.iter().flatten() {
                for c in equation.entries.keys() {
                    *counts.entry(*c).or_default() += 1;
                }
            }
            let mut best: Option<((bool, bool, usize), usize, usize)> = None;
            for (r, equation) in equations.iter().enumerate() {
                let Some(equation) = equation else { continue };
                for (c, a) in &equation.entries {
                    let number = self.bench.graph.as_number(*a).is_some();
                    let promised =
                        |graph: &Graph| graph.roles(*a).is_constant() && graph.manifestly_nonzero(*a);
                    if !number && !promised(&self.bench.graph) {
                        continue;
                    }
                    let fill = (equation.entries.len() - 1) * (counts[c] - 1);
                    let rank = (!number, r < degrees, fill);
                    if best.as_ref().is_none_or(|(known, ..)| rank < *known) {
                        best = Some((rank, r, *c));
                    }
                }
            }
            let Some((_, r, c)) = best else { return };
            let pivot_row = equations[r].take().expect("the pivot's row is active");
            let pivot = pivot_row.entries[&c];
            let row = self.normalised(pivot_row, c);
            let mut others = Vec::new();
            for equation in equations.iter_mut().flatten() {
                if let Some(factor) = equation.entries.remove(&c) {
                    self.subtract(equation, factor, &row);
                    others.push((equation.form, factor));
                }
            }
            self.steps.push(Step::Subtract { form: row.form, pivot, others });
            self.solved.push((c, row));
        }
    }

    /// The row divided by its entry in column `c`, that entry taken out.
    fn normalised(&mut self, mut row: Equation, c: usize) -> Equation {
        let pivot = row.entries.remove(&c).expect("the pivot's column occurs");
        for value in row.entries.values_mut().chain(row.right.values_mut()) {
            let quotient = self.bench.graph.div(*value, pivot);
            *value = self.bench.tidy(quotient);
        }
        row
    }

    /// `equation -= factor * row`.
    fn subtract(&mut self, equation: &mut Equation, factor: ExprId, row: &Equation) {
        let bench = &mut *self.bench;
        for (into, from) in [(&mut equation.entries, &row.entries), (&mut equation.right, &row.right)] {
            for (c, value) in from {
                let product = bench.graph.mul(factor, *value);
                let old = into.get(c).copied().unwrap_or(bench.graph.zero());
                let difference = bench.graph.sub(old, product);
                // What is kept whole has nothing in common with others.
                let is_kept = self.is_large && matches!(bench.graph.node(*value), Node::Kept(_));
                let difference =
                    if is_kept { difference } else { bench.tidy_alike(difference, &mut self.beyond) };
                if bench.graph.is_zero(difference) {
                    into.remove(c);
                } else {
                    into.insert(*c, difference);
                }
            }
        }
    }

    /// Solves what elimination left, block by block; `degrees` as in the forms.
    fn solve_core(
        &mut self,
        core: Vec<Equation>,
        degrees: usize,
        values: &mut [Option<BTreeMap<usize, ExprId>>],
    ) -> Result<(), SingularForms> {
        let generic = || SingularForms { combination: Vec::new(), rest: None };
        let used: Vec<Vec<usize>> =
            core.iter().map(|equation| equation.entries.keys().copied().collect()).collect();
        for (rows, columns) in blocks(&used).ok_or_else(generic)? {
            let mut right: Vec<BTreeMap<usize, ExprId>> = Vec::new();
            let mut forms: Vec<(usize, Vec<(usize, ExprId)>)> = Vec::new();
            for r in &rows {
                let form = core[*r].form;
                let mut equation = Equation { form, entries: BTreeMap::new(), right: core[*r].right.clone() };
                let mut before = Vec::new();
                for (c, a) in &core[*r].entries {
                    if let Some(known) = &values[*c] {
                        let row = Equation { form, entries: BTreeMap::new(), right: known.clone() };
                        self.subtract(&mut equation, *a, &row);
                        before.push((*c, *a));
                    }
                }
                right.push(equation.right);
                forms.push((form, before));
            }
            let zero = self.bench.graph.zero();
            let matrix: Vec<Vec<ExprId>> = rows
                .iter()
                .map(|r| columns.iter().map(|c| core[*r].entries.get(c).copied().unwrap_or(zero)).collect())
                .collect();
            let of: Vec<usize> = forms.iter().map(|(form, _)| *form).collect();
            let inverse = self.inverse(&matrix, &of).ok_or_else(generic)?;
            for (i, c) in columns.iter().enumerate() {
                let mut value: BTreeMap<usize, ExprId> = BTreeMap::new();
                for (k, right) in right.iter().enumerate() {
                    for (j, e) in right {
                        let product = self.bench.graph.mul(inverse[i][k], *e);
                        let old = value.get(j).copied().unwrap_or(zero);
                        value.insert(*j, self.bench.graph.add(old, product));
                    }
                }
                for (j, e) in &mut value {
                    let is_whole = *j > degrees && is_nested(self.bench, *e);
                    let tidy = if is_whole { *e } else { self.bench.tidy_alike(*e, &mut self.beyond) };
                    *e = self.bench.keep_large(tidy);
                }
                value.retain(|_, e| !self.bench.graph.is_zero(*e));
                values[*c] = Some(value);
            }
            self.steps.push(Step::Block { forms, coordinates: columns, inverse });
        }
        Ok(())
    }

    /// Inverts what is left of some forms.
    fn inverse(&mut self, matrix: &[Vec<ExprId>], forms: &[usize]) -> Option<Vec<Vec<ExprId>>> {
        let n = matrix.len();
        if n > ADJUGATE_SIZE || n > 1 && self.is_orthogonal(matrix) {
            return self.inverse_by_orthogonal_rows(matrix, forms);
        }
        let (mut inverse, determinant) = adjugate(self.bench, matrix);
        if self.bench.verdict_on_manifold(determinant) == Verdict::Zero {
            return None;
        }
        self.require(determinant, forms);
        let divisor = self.bench.keep_large(determinant);
        for e in inverse.iter_mut().flatten() {
            let quotient = self.bench.graph.div(*e, divisor);
            let tidy = self.bench.tidy_alike(quotient, &mut self.beyond);
            *e = self.bench.keep_large(tidy);
        }
        Some(inverse)
    }

    /// Whether the rows are orthogonal to each other.
    fn is_orthogonal(&mut self, matrix: &[Vec<ExprId>]) -> bool {
        (0..matrix.len()).all(|i| {
            (0..i).all(|k| {
                let product = self.bench.dot(&matrix[i], &matrix[k]);
                self.bench.vanishes(product)
            })
        })
    }

    /// `K^-1 = Q^T D^-1 T`, where the rows of `Q = T K` are orthogonal (Gram and Schmidt) and `D` is the squares of their lengths. None of
    /// these vanishes where the rows of `K` are independent, as pivots of an elimination do.
    fn inverse_by_orthogonal_rows(
        &mut self,
        matrix: &[Vec<ExprId>],
        forms: &[usize],
    ) -> Option<Vec<Vec<ExprId>>> {
        let n = matrix.len();
        let (zero, one) = (self.bench.graph.zero(), self.bench.graph.one());
        // Rows of K beside those of the unit matrix become rows of Q beside those of T.
        let mut rows: Vec<Vec<ExprId>> = (matrix.iter().enumerate())
            .map(|(i, row)| {
                row.iter().copied().chain((0..n).map(|k| if i == k { one } else { zero })).collect()
            })
            .collect();
        // The forms that each row is made of.
        let mut made_of: Vec<Vec<usize>> = forms.iter().map(|form| vec![*form]).collect();
        let mut terms = vec![vec![Vec::new(); n]; n];
        for k in 0..n {
            let square = self.bench.dot(&rows[k][..n], &rows[k][..n]);
            let mut square = self.bench.tidy_alike(square, &mut self.beyond);
            if self.bench.verdict_on_manifold(square) == Verdict::Zero {
                return None;
            }
            self.require(square, &made_of[k]);
            if made_of[k].len() > 1 {
                square = self.bench.keep_large(square);
            }
            for i in 0..n {
                let quotient = self.bench.graph.div(rows[k][i], square);
                let tidy = self.bench.tidy_alike(quotient, &mut self.beyond);
                let scaled = self.bench.keep_large(tidy);
                for (c, own) in rows[k][n..].iter().enumerate() {
                    terms[i][c].push(self.bench.graph.mul(scaled, *own));
                }
            }
            let (row, own) = (rows[k].clone(), made_of[k].clone());
            for (later, forms) in rows[k + 1..].iter_mut().zip(&mut made_of[k + 1..]) {
                let product = self.bench.dot(&later[..n], &row[..n]);
                let product = self.bench.dropped(product);
                if self.bench.graph.is_zero(product) {
                    continue;
                }
                let quotient = self.bench.graph.div(product, square);
                let share = self.bench.keep_large(quotient);
                for (e, own) in later.iter_mut().zip(&row) {
                    let part = self.bench.graph.mul(share, *own);
                    let difference = self.bench.graph.sub(*e, part);
                    let difference = self.bench.dropped(difference);
                    *e = self.bench.keep_large(difference);
                }
                forms.extend(&own);
                forms.sort_unstable();
                forms.dedup();
            }
        }
        let mut entry = |terms: Vec<ExprId>| {
            let sum = self.bench.graph.sum(terms);
            let tidy = self.bench.tidy_alike(sum, &mut self.beyond);
            self.bench.keep_large(tidy)
        };
        Some(terms.into_iter().map(|row| row.into_iter().map(&mut entry).collect()).collect())
    }

    /// Notes that an expression must not vanish, unless that is manifest: where it does some forms are dependent.
    fn require(&mut self, e: ExprId, forms: &[usize]) {
        if self.bench.graph.manifestly_nonzero(e) {
            return;
        }
        // Where a constant factor is zero it vanishes everywhere.
        if let Node::Product(factors) = self.bench.graph.node(e).clone()
            && !self.bench.graph.roles(e).is_constant()
        {
            for (base, _) in factors {
                if self.bench.graph.roles(base).is_constant() {
                    self.require(base, forms);
                }
            }
        }
        if self.bench.graph.roles(e).is_constant() {
            if !self.constant_pivots.contains(&e) {
                self.constant_pivots.push(e);
            }
        } else if let Some(place) = self.chart.iter().position(|known| *known == e) {
            let known = &mut self.chart_forms[place];
            known.extend(forms);
            known.sort_unstable();
            known.dedup();
        } else {
            self.chart.push(e);
            self.chart_forms.push(forms.to_vec());
        }
    }

    /// The eliminated columns, last eliminated first.
    fn substitute_back(&mut self, values: &mut [Option<BTreeMap<usize, ExprId>>]) {
        while let Some((c, row)) = self.solved.pop() {
            let form = row.form;
            let mut equation = Equation { form, entries: BTreeMap::new(), right: row.right };
            for (k, a) in &row.entries {
                let known = values[*k].clone().expect("columns eliminated later are known");
                self.subtract(&mut equation, *a, &Equation { form, entries: BTreeMap::new(), right: known });
            }
            let known = row.entries.iter().map(|(k, a)| (*k, *a)).collect();
            self.steps.push(Step::Back { form, coordinate: c, known });
            for e in equation.right.values_mut() {
                *e = self.bench.keep_large(*e);
            }
            values[c] = Some(equation.right);
        }
    }
}

/// Whether an expression is made of others that are kept whole: then there is little in it to be multiplied out.
pub(crate) fn is_nested(bench: &Workbench, e: ExprId) -> bool {
    let graph = &bench.graph;
    let mut found = false;
    graph.reachable(&[e], |id| {
        let is_kept = matches!(graph.node(id), Node::Kept(_));
        found |= is_kept;
        is_kept || graph.roles(id).is_constant()
    });
    found
}
