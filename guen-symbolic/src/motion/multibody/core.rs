//! The core: forms pulled back to parameters and unknowns, and solved for the unknowns.
//!
//! No form is divided by a coefficient that may vanish: forms in which no other is left are solved together, by what vanishes only
//! where they are dependent.

use std::collections::BTreeMap;

use super::definitions::{Equation, Plan};
use super::forms::{Functional, Part};
use super::plan::Planner;
use super::relations::{Linear, definition, link, order};
use super::tree::{Tree, Turn, plus};
use super::variables::{Var, Variables};
use crate::numbering::{Num, Numbering};
use crate::zero::field;

/// A combination of parameters and unknowns.
type Combination = BTreeMap<Var, Num>;

/// The largest number of forms that are solved together by their determinant.
const DETERMINANT_SIZE: usize = 3;

/// A step of the elimination.
enum Step {
    /// A form solved for an unknown.
    One {
        row: usize,
        unknown: usize,
        /// The reciprocal of the divisor.
        inverse: Num,
        /// Unknowns that are solved for later, with what they contribute.
        later: Vec<(usize, Num)>,
        /// Forms that have the unknown too, with its coefficients there.
        others: Vec<(usize, Num)>,
    },
    /// Forms solved together for unknowns that no other form has, by the inverse of their matrix.
    Together { rows: Vec<usize>, unknowns: Vec<usize>, inverse: Vec<Vec<Num>> },
}

/// The unknowns of a core as functions of the parameters.
#[derive(Default)]
pub(super) struct Core {
    steps: Vec<Step>,
    /// The combination of parameters of each unknown.
    pub(super) solutions: Vec<Linear>,
    /// The value of each unknown where all parameters are zero.
    pub(super) offsets: Vec<Num>,
}

impl Core {
    /// Pulls the forms of a core back, and solves them; `None` if a divisor vanishes.
    pub(super) fn new(planner: &mut Planner<'_>, plan: &Plan) -> Option<Self> {
        let (tree, variables) = (planner.tree, planner.variables);
        let mut rows: Vec<(Combination, Num)> = Vec::new();
        for equation in &plan.core {
            let (terms, offset) = match equation {
                Equation::Row(row) => {
                    moments(planner.numbers, tree, &plan.rows[*row]);
                    let terms = plan.rows[*row].terms.clone();
                    (planner.reduced(&terms), plan.rows[*row].offset)
                }
                Equation::Link(var) => link(planner.numbers, tree, variables, *var)?,
            };
            rows.push(pulled(planner.numbers, tree, variables, plan, terms, offset));
        }
        let unknowns = plan.unknowns.clone();
        let count = unknowns.len();
        let mut core = Core {
            solutions: vec![Linear::new(); count],
            offsets: vec![Num::ZERO; count],
            ..Core::default()
        };
        let mut open_rows: Vec<usize> = (0..count).collect();
        let mut open: Vec<usize> = (0..count).collect();
        while !open.is_empty() {
            let Choice { row, unknown, is_safe } = choose(planner, &rows, &unknowns, &open_rows, &open)?;
            if !is_safe
                && let Some(step) = together(planner.numbers, &rows, &unknowns, (&open_rows, &open), unknown)
            {
                core.solve_together(planner.numbers, &rows, &unknowns, &step);
                let Step::Together { rows, unknowns, .. } = &step else { return None };
                open_rows.retain(|r| !rows.contains(r));
                open.retain(|u| !unknowns.contains(u));
                core.steps.push(step);
                continue;
            }
            open_rows.retain(|r| *r != row);
            open.retain(|u| *u != unknown);
            let numbers = &mut *planner.numbers;
            let var = unknowns[unknown];
            let (mut combination, offset) = rows[row].clone();
            let pivot = combination.remove(&var)?;
            let inverse = numbers.div(Num::ONE, pivot);
            let scaled: Vec<(Var, Num)> =
                combination.iter().map(|(other, c)| (*other, numbers.mul(*c, inverse).neg())).collect();
            let scaled_offset = numbers.mul(offset, inverse).neg();
            let mut others = Vec::new();
            for other in open_rows.iter().copied() {
                let Some(c) = rows[other].0.remove(&var) else { continue };
                for (place, own) in &scaled {
                    let part = numbers.mul(c, *own);
                    add(numbers, &mut rows[other].0, *place, part);
                }
                let part = numbers.mul(c, scaled_offset);
                rows[other].1 = numbers.add(rows[other].1, part);
                others.push((other, c));
            }
            let later = scaled
                .iter()
                .filter_map(|(place, c)| Some((unknowns.iter().position(|u| u == place)?, *c)))
                .collect();
            core.solutions[unknown] = scaled;
            core.offsets[unknown] = scaled_offset;
            core.steps.push(Step::One { row, unknown, inverse, later, others });
        }
        // Unknowns that were solved for later are put in.
        let numbers = &mut *planner.numbers;
        for step in core.steps.iter().rev() {
            let Step::One { unknown, .. } = step else { continue };
            let mut combination = Combination::new();
            let mut offset = core.offsets[*unknown];
            for (var, c) in core.solutions[*unknown].clone() {
                match unknowns.iter().position(|u| *u == var) {
                    None => add(numbers, &mut combination, var, c),
                    Some(other) => {
                        for (place, own) in core.solutions[other].clone() {
                            let part = numbers.mul(c, own);
                            add(numbers, &mut combination, place, part);
                        }
                        let part = numbers.mul(c, core.offsets[other]);
                        offset = numbers.add(offset, part);
                    }
                }
            }
            core.solutions[*unknown] = combination.into_iter().collect();
            core.offsets[*unknown] = offset;
        }
        planner.numbers.is_sound().then_some(core)
    }

    /// The unknowns of forms that are solved together.
    fn solve_together(
        &mut self,
        numbers: &mut Numbering,
        rows: &[(Combination, Num)],
        unknowns: &[Var],
        step: &Step,
    ) {
        let Step::Together { rows: of, unknowns: found, inverse } = step else { return };
        for (unknown, inverse) in found.iter().zip(inverse) {
            let mut combination = Combination::new();
            let mut offset = Num::ZERO;
            for (row, c) in of.iter().zip(inverse) {
                let c = c.neg();
                let (terms, own) = &rows[*row];
                for (var, k) in terms.iter().filter(|(var, _)| !unknowns.contains(var)) {
                    let part = numbers.mul(c, *k);
                    add(numbers, &mut combination, *var, part);
                }
                let part = numbers.mul(c, *own);
                offset = numbers.add(offset, part);
            }
            self.solutions[*unknown] = combination.into_iter().collect();
            self.offsets[*unknown] = offset;
        }
    }

    /// The unknowns of the same forms with other values without unknowns, and without parameters.
    pub(super) fn solve(&self, numbers: &mut Numbering, mut right: Vec<Num>) -> Vec<Num> {
        let mut found = vec![Num::ZERO; self.solutions.len()];
        for step in &self.steps {
            match step {
                Step::One { row, unknown, inverse, others, .. } => {
                    let own = numbers.mul(right[*row], *inverse).neg();
                    for (other, c) in others {
                        let part = numbers.mul(*c, own);
                        right[*other] = numbers.add(right[*other], part);
                    }
                    found[*unknown] = own;
                }
                Step::Together { rows, unknowns, inverse } => {
                    let sides: Vec<Num> = rows.iter().map(|row| right[*row]).collect();
                    for (unknown, inverse) in unknowns.iter().zip(inverse) {
                        found[*unknown] = dot(numbers, inverse, &sides).neg();
                    }
                }
            }
        }
        for step in self.steps.iter().rev() {
            let Step::One { unknown, later, .. } = step else { continue };
            for (other, c) in later {
                let part = numbers.mul(*c, found[*other]);
                found[*unknown] = numbers.add(found[*unknown], part);
            }
        }
        found
    }
}

fn dot(numbers: &mut Numbering, a: &[Num], b: &[Num]) -> Num {
    let mut sum = Num::ZERO;
    for (a, b) in a.iter().zip(b) {
        let product = numbers.mul(*a, *b);
        sum = numbers.add(sum, product);
    }
    sum
}

/// Numbers the moments of what acts at a point along a direction, about all joints on the way to the root: about the axis of a joint
/// it is one component of `p x d`, with the point as it is seen from there. The turns of the whole moment are dearer.
fn moments(numbers: &mut Numbering, tree: &Tree, row: &Functional) {
    let points = row.parts.iter().filter_map(|(part, _, along)| match part {
        Part::Point { point } => Some((*point, along)),
        _ => None,
    });
    for (point, along) in points {
        let mut place = point;
        let mut d = *along;
        // The lever, if the same direction has one.
        let axes = tree.points[point].axes;
        let arm = row.parts.iter().find_map(|(part, _, own)| match part {
            Part::Arm { axes: own_axes, arm, .. } if *own_axes == axes && own == along => Some(*arm),
            _ => None,
        });
        let mut p = arm.unwrap_or_default();
        while place > 0 {
            let node = &tree.points[place];
            let parent = tree.points[node.parent].axes;
            if node.axes != parent {
                if let Turn::About { axis, .. } = tree.axes[node.axes].turn {
                    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                    let (first, second) = (numbers.mul(p[i], d[j]), numbers.mul(p[j], d[i]));
                    numbers.sub(first, second);
                }
                p = tree.inwards(numbers, node.axes, &p);
                d = tree.inwards(numbers, node.axes, &d);
            }
            p = plus(numbers, &p, &node.offset);
            place = node.parent;
        }
    }
}

fn add(numbers: &mut Numbering, combination: &mut Combination, var: Var, c: Num) {
    let sum = match combination.get(&var) {
        Some(known) => numbers.add(*known, c),
        None => c,
    };
    if sum.is_zero() {
        combination.remove(&var);
    } else {
        combination.insert(var, sum);
    }
}

/// A combination pulled back to parameters and unknowns.
fn pulled(
    numbers: &mut Numbering,
    tree: &Tree,
    variables: &Variables,
    plan: &Plan,
    terms: Linear,
    mut offset: Num,
) -> (Combination, Num) {
    let roots: Vec<Var> = terms.iter().map(|(var, _)| *var).collect();
    let order = order(numbers, tree, variables, plan, &roots);
    let mut combination: Combination = terms.into_iter().collect();
    for var in order.into_iter().rev() {
        let Some((terms, own)) = definition(numbers, tree, variables, plan, var) else { continue };
        let Some(c) = combination.remove(&var) else { continue };
        for (other, k) in terms {
            let part = numbers.mul(c, k);
            add(numbers, &mut combination, other, part);
        }
        let part = numbers.mul(c, own);
        offset = numbers.add(offset, part);
    }
    (combination, offset)
}

/// A form and an unknown to eliminate, and whether its coefficient vanishes at no state that was looked at.
struct Choice {
    row: usize,
    unknown: usize,
    is_safe: bool,
}

/// The form and the unknown to eliminate: of those whose coefficient vanishes at no state that was looked at the one with the
/// fewest other unknowns.
fn choose(
    planner: &mut Planner<'_>,
    rows: &[(Combination, Num)],
    unknowns: &[Var],
    open_rows: &[usize],
    open: &[usize],
) -> Option<Choice> {
    let mut candidates: Vec<(bool, usize, usize, usize, usize)> = Vec::new();
    for row in open_rows {
        let combination = &rows[*row].0;
        let count = open.iter().filter(|u| combination.contains_key(&unknowns[**u])).count();
        for unknown in open {
            let Some(pivot) = combination.get(&unknowns[*unknown]).copied() else { continue };
            let others = open_rows.iter().filter(|r| rows[**r].0.contains_key(&unknowns[*unknown])).count();
            let is_unsafe = !planner.is_safe(pivot);
            candidates.push((is_unsafe, (count - 1) * (others - 1), combination.len(), *row, *unknown));
        }
    }
    candidates.sort_unstable();
    candidates.first().map(|(is_unsafe, .., row, unknown)| Choice {
        row: *row,
        unknown: *unknown,
        is_safe: !is_unsafe,
    })
}

/// Solves the forms that hang together with an unknown: orthogonal ones by the squares of their lengths, few others by their
/// determinant; `None` for a single form, and for many.
fn together(
    numbers: &mut Numbering,
    rows: &[(Combination, Num)],
    unknowns: &[Var],
    (open_rows, open): (&[usize], &[usize]),
    first: usize,
) -> Option<Step> {
    let has = |row: usize, unknown: usize| rows[row].0.contains_key(&unknowns[unknown]);
    let (mut of, mut found) = (Vec::new(), vec![first]);
    loop {
        let row = open_rows.iter().find(|row| !of.contains(*row) && found.iter().any(|u| has(**row, *u)));
        let unknown = open.iter().find(|u| !found.contains(*u) && of.iter().any(|row| has(*row, **u)));
        of.extend(row);
        found.extend(unknown);
        if row.is_none() && unknown.is_none() {
            break;
        }
    }
    if of.len() != found.len() || of.len() == 1 {
        return None;
    }
    of.sort_unstable();
    found.sort_unstable();
    let entry =
        |row: &usize, unknown: &usize| rows[*row].0.get(&unknowns[*unknown]).copied().unwrap_or(Num::ZERO);
    let matrix: Vec<Vec<Num>> =
        of.iter().map(|row| found.iter().map(|unknown| entry(row, unknown)).collect()).collect();
    let inverse = match orthogonal_inverse(numbers, &matrix) {
        Some(inverse) => inverse,
        None if of.len() <= DETERMINANT_SIZE => inverse_by_determinant(numbers, &matrix),
        None => return None,
    };
    Some(Step::Together { rows: of, unknowns: found, inverse })
}

/// `K^-1 = K^T D^-1` for orthogonal rows, `D` the squares of their lengths.
fn orthogonal_inverse(numbers: &mut Numbering, matrix: &[Vec<Num>]) -> Option<Vec<Vec<Num>>> {
    let residues: Vec<Vec<u64>> =
        matrix.iter().map(|row| row.iter().map(|e| numbers.residue(*e)).collect()).collect();
    for (i, row) in residues.iter().enumerate() {
        for other in &residues[..i] {
            let products = row.iter().zip(other).map(|(a, b)| field::mul(*a, *b));
            if products.fold(0, field::add) != 0 {
                return None;
            }
        }
    }
    let n = matrix.len();
    let mut inverse = vec![vec![Num::ZERO; n]; n];
    for (k, row) in matrix.iter().enumerate() {
        let square = dot(numbers, row, row);
        let reciprocal = numbers.div(Num::ONE, square);
        for (i, e) in row.iter().enumerate() {
            inverse[i][k] = numbers.mul(*e, reciprocal);
        }
    }
    Some(inverse)
}

/// The inverse of two or three rows: cofactors over the determinant.
fn inverse_by_determinant(numbers: &mut Numbering, matrix: &[Vec<Num>]) -> Vec<Vec<Num>> {
    let n = matrix.len();
    let mut cofactor = |row: usize, column: usize| {
        if n == 2 {
            let e = matrix[1 - row][1 - column];
            return if row == column { e } else { e.neg() };
        }
        // Rows and columns in cyclic order have the sign in themselves.
        let at = |i: usize, j: usize| matrix[(row + i) % 3][(column + j) % 3];
        let (first, second) = (numbers.mul(at(1, 1), at(2, 2)), numbers.mul(at(1, 2), at(2, 1)));
        numbers.sub(first, second)
    };
    let cofactors: Vec<Vec<Num>> = (0..n).map(|i| (0..n).map(|j| cofactor(i, j)).collect()).collect();
    let determinant = dot(numbers, &matrix[0], &cofactors[0]);
    let reciprocal = numbers.div(Num::ONE, determinant);
    (0..n).map(|i| (0..n).map(|k| numbers.mul(cofactors[k][i], reciprocal)).collect()).collect()
}
