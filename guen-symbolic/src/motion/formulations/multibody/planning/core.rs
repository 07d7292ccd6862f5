//! The core: forms pulled back to parameters and unknowns, and solved for the unknowns.
//!
//! A form is divided by a coefficient that is not seen to vanish. Where no form has one, the forms that are left are solved by the blocks
//! of their triangular form: small ones by their determinants, large ones by orthogonal rows. Both divide by what vanishes only where the
//! forms are dependent.

use std::collections::BTreeMap;

use super::plan::Planner;
use crate::geometry::blocks;
use crate::motion::formulations::multibody::places::tree::{Tree, Turn, plus};
use crate::motion::formulations::multibody::velocities::definitions::{Def, Equation, Plan};
use crate::motion::formulations::multibody::velocities::forms::{Functional, Part};
use crate::motion::formulations::multibody::velocities::relations::{Linear, definition, link, order};
use crate::motion::formulations::multibody::velocities::variables::{Var, Variables};
use crate::numbering::{Num, Numbering};
use crate::zero::field;

/// A combination of parameters and unknowns.
type Combination = BTreeMap<Var, Num>;

/// The largest number of forms that are solved together by their determinant.
const DETERMINANT_SIZE: usize = 3;

/// A step of the elimination: forms solved for as many unknowns, mostly one.
struct Step {
    rows: Vec<usize>,
    unknowns: Vec<usize>,
    /// The inverse of the coefficients: a row for each unknown.
    inverse: Vec<Vec<Num>>,
    /// Unknowns that are solved for later, with what they contribute to the only one.
    later: Vec<(usize, Num)>,
    /// Forms that have the unknowns too, with their coefficients there.
    others: Vec<(usize, Vec<Num>)>,
}

/// The unknowns of a core as functions of the parameters.
#[derive(Default)]
pub(in crate::motion) struct Core {
    steps: Vec<Step>,
    /// The combination of parameters of each unknown.
    pub(in crate::motion) solutions: Vec<Linear>,
    /// The value of each unknown where all parameters are zero.
    pub(in crate::motion) offsets: Vec<Num>,
}

impl Core {
    /// Pulls the forms of a core back, and solves them; `None` if a divisor vanishes.
    pub(in crate::motion) fn new(planner: &mut Planner<'_>, plan: &Plan) -> Option<Self> {
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
        Self::solved(planner, rows, plan.unknowns.clone())
    }

    /// The values of all parameters where forms have given ones. The forms speak of velocities; the parameters are those of the plan.
    pub(in crate::motion) fn parameters(
        &self,
        planner: &mut Planner<'_>,
        plan: &Plan,
        forms: &[(Functional, Num)],
    ) -> Option<Vec<Num>> {
        let (tree, variables) = (planner.tree, planner.variables);
        let mut rows = Vec::new();
        for (form, value) in forms {
            let terms = planner.reduced(&form.terms);
            let numbers = &mut *planner.numbers;
            let (terms, mut offset) = pulled(numbers, tree, variables, plan, terms, form.offset);
            let mut row = Combination::new();
            for (var, c) in terms {
                match plan.def(var) {
                    Some(Def::Core(index)) => {
                        for (eta, own) in &self.solutions[index] {
                            let part = numbers.mul(c, *own);
                            add(numbers, &mut row, *eta, part);
                        }
                        let part = numbers.mul(c, self.offsets[index]);
                        offset = numbers.add(offset, part);
                    }
                    _ => add(numbers, &mut row, var, c),
                }
            }
            rows.push((row, numbers.sub(offset, *value)));
        }
        let unknowns = (0..forms.len()).map(|s| variables.eta(s)).collect();
        Some(Self::solved(planner, rows, unknowns)?.offsets)
    }

    /// Solves combinations that vanish for as many unknowns; `None` if a divisor vanishes.
    fn solved(
        planner: &mut Planner<'_>,
        mut rows: Vec<(Combination, Num)>,
        unknowns: Vec<Var>,
    ) -> Option<Self> {
        let count = unknowns.len();
        let mut core = Core {
            solutions: vec![Linear::new(); count],
            offsets: vec![Num::ZERO; count],
            ..Core::default()
        };
        let mut open_rows: Vec<usize> = (0..count).collect();
        let mut open: Vec<usize> = (0..count).collect();
        while !open.is_empty() {
            let (of, found) = choose(planner, &rows, &unknowns, (&open_rows, &open))?;
            open_rows.retain(|row| !of.contains(row));
            open.retain(|unknown| !found.contains(unknown));
            let numbers = &mut *planner.numbers;
            let mut taken: Vec<(Combination, Num)> = of.iter().map(|row| rows[*row].clone()).collect();
            let matrix: Vec<Vec<Num>> = taken
                .iter_mut()
                .map(|(terms, _)| {
                    found.iter().map(|u| terms.remove(&unknowns[*u]).unwrap_or(Num::ZERO)).collect()
                })
                .collect();
            let inverse = inverse(numbers, &matrix);
            for (unknown, inverse) in found.iter().zip(&inverse) {
                let mut combination = Combination::new();
                let mut offset = Num::ZERO;
                for ((terms, own), k) in taken.iter().zip(inverse) {
                    for (var, c) in terms {
                        let part = numbers.mul(*c, *k).neg();
                        add(numbers, &mut combination, *var, part);
                    }
                    let part = numbers.mul(*own, *k).neg();
                    offset = numbers.add(offset, part);
                }
                core.solutions[*unknown] = combination.into_iter().collect();
                core.offsets[*unknown] = offset;
            }
            let mut others = Vec::new();
            for other in open_rows.iter().copied() {
                let coefficients: Vec<Num> =
                    found.iter().map(|u| rows[other].0.remove(&unknowns[*u]).unwrap_or(Num::ZERO)).collect();
                if coefficients.iter().all(|c| c.is_zero()) {
                    continue;
                }
                for (c, unknown) in coefficients.iter().zip(&found).filter(|(c, _)| !c.is_zero()) {
                    for (place, own) in &core.solutions[*unknown] {
                        let part = numbers.mul(*c, *own);
                        add(numbers, &mut rows[other].0, *place, part);
                    }
                    let part = numbers.mul(*c, core.offsets[*unknown]);
                    rows[other].1 = numbers.add(rows[other].1, part);
                }
                others.push((other, coefficients));
            }
            // Unknowns that several forms are solved for hang on no others.
            let later = core.solutions[found[0]]
                .iter()
                .filter_map(|(place, c)| Some((unknowns.iter().position(|u| u == place)?, *c)))
                .collect();
            core.steps.push(Step { rows: of, unknowns: found, inverse, later, others });
        }
        // Unknowns that were solved for later are put in.
        let numbers = &mut *planner.numbers;
        for step in core.steps.iter().rev() {
            let [unknown] = step.unknowns[..] else { continue };
            let mut combination = Combination::new();
            let mut offset = core.offsets[unknown];
            for (var, c) in core.solutions[unknown].clone() {
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
            core.solutions[unknown] = combination.into_iter().collect();
            core.offsets[unknown] = offset;
        }
        planner.numbers.is_sound().then_some(core)
    }

    /// The unknowns of the same forms with other values without unknowns, and without parameters.
    pub(in crate::motion) fn solve(&self, numbers: &mut Numbering, mut right: Vec<Num>) -> Vec<Num> {
        let mut found = vec![Num::ZERO; self.solutions.len()];
        for step in &self.steps {
            let sides: Vec<Num> = step.rows.iter().map(|row| right[*row]).collect();
            for (unknown, inverse) in step.unknowns.iter().zip(&step.inverse) {
                found[*unknown] = numbers.dot(&sides, inverse).neg();
            }
            for (other, coefficients) in &step.others {
                for (c, unknown) in coefficients.iter().zip(&step.unknowns) {
                    let part = numbers.mul(*c, found[*unknown]);
                    right[*other] = numbers.add(right[*other], part);
                }
            }
        }
        for step in self.steps.iter().rev() {
            for (other, c) in &step.later {
                let part = numbers.mul(*c, found[*other]);
                let unknown = step.unknowns[0];
                found[unknown] = numbers.add(found[unknown], part);
            }
        }
        found
    }
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

/// Returns the forms and the unknowns to eliminate next. Mostly these are one form and one unknown: of the coefficients that vanish at no
/// state that was looked at, the one with the least fill. Where every coefficient vanishes somewhere, they are a block of the triangular
/// form, a block of one form if there is one.
fn choose(
    planner: &mut Planner<'_>,
    rows: &[(Combination, Num)],
    unknowns: &[Var],
    (open_rows, open): (&[usize], &[usize]),
) -> Option<(Vec<usize>, Vec<usize>)> {
    let mut candidates: Vec<(bool, usize, usize, usize, usize)> = Vec::new();
    let mut used: Vec<Vec<usize>> = Vec::new();
    for row in open_rows {
        let combination = &rows[*row].0;
        let own: Vec<usize> =
            open.iter().copied().filter(|u| combination.contains_key(&unknowns[*u])).collect();
        for unknown in &own {
            let Some(pivot) = combination.get(&unknowns[*unknown]).copied() else { continue };
            let others = open_rows.iter().filter(|r| rows[**r].0.contains_key(&unknowns[*unknown])).count();
            let is_unsafe = !planner.is_safe(pivot);
            candidates.push((is_unsafe, (own.len() - 1) * (others - 1), combination.len(), *row, *unknown));
        }
        used.push(own);
    }
    candidates.sort_unstable();
    let (is_unsafe, .., row, unknown) = candidates.first().copied()?;
    let blocks = if is_unsafe { blocks(&used).unwrap_or_default() } else { Vec::new() };
    let blocks: Vec<(Vec<usize>, Vec<usize>)> = blocks
        .into_iter()
        .map(|(places, found)| (places.into_iter().map(|place| open_rows[place]).collect(), found))
        .collect();
    // The blocks may be eliminated in any order.
    let alone = candidates.iter().find(|(.., row, unknown)| {
        blocks.iter().any(|(of, found)| of[..] == [*row] && found[..] == [*unknown])
    });
    if let Some((.., row, unknown)) = alone {
        return Some((vec![*row], vec![*unknown]));
    }
    Some(blocks.into_iter().next().unwrap_or_else(|| (vec![row], vec![unknown])))
}

/// The inverse of the coefficients of forms: a row for each unknown.
pub(in crate::motion) fn inverse(numbers: &mut Numbering, matrix: &[Vec<Num>]) -> Vec<Vec<Num>> {
    match matrix.len() {
        1 => vec![vec![numbers.div(Num::ONE, matrix[0][0])]],
        2..=DETERMINANT_SIZE if !is_orthogonal(numbers, matrix) => inverse_by_determinant(numbers, matrix),
        _ => inverse_by_orthogonal_rows(numbers, matrix),
    }
}

/// Whether rows are orthogonal to each other, modulo the prime.
fn is_orthogonal(numbers: &Numbering, matrix: &[Vec<Num>]) -> bool {
    (0..matrix.len()).all(|i| (0..i).all(|k| are_orthogonal(numbers, &matrix[i], &matrix[k])))
}

/// Whether two rows are orthogonal, modulo the prime.
fn are_orthogonal(numbers: &Numbering, a: &[Num], b: &[Num]) -> bool {
    let products = a.iter().zip(b).map(|(a, b)| field::mul(numbers.residue(*a), numbers.residue(*b)));
    products.fold(0, field::add) == 0
}

/// `K^-1 = Q^T D^-1 T`, where the rows of `Q = T K` are orthogonal (Gram and Schmidt) and `D` is the squares of their lengths. None of
/// these vanishes where the rows of `K` are independent.
fn inverse_by_orthogonal_rows(numbers: &mut Numbering, matrix: &[Vec<Num>]) -> Vec<Vec<Num>> {
    let n = matrix.len();
    let mut rows = matrix.to_vec();
    let mut made: Vec<Vec<Num>> =
        (0..n).map(|i| (0..n).map(|k| if i == k { Num::ONE } else { Num::ZERO }).collect()).collect();
    let mut inverse = vec![vec![Num::ZERO; n]; n];
    for k in 0..n {
        let square = numbers.dot(&rows[k], &rows[k]);
        let reciprocal = numbers.div(Num::ONE, square);
        let scaled: Vec<Num> = rows[k].iter().map(|e| numbers.mul(*e, reciprocal)).collect();
        for (e, inverse) in scaled.iter().zip(&mut inverse) {
            for (entry, own) in inverse.iter_mut().zip(&made[k]) {
                let part = numbers.mul(*e, *own);
                *entry = numbers.add(*entry, part);
            }
        }
        for later in k + 1..n {
            if are_orthogonal(numbers, &rows[later], &rows[k]) {
                continue;
            }
            let share = numbers.dot(&rows[later], &scaled);
            for list in [&mut rows, &mut made] {
                let own = list[k].clone();
                for (e, own) in list[later].iter_mut().zip(own) {
                    let part = numbers.mul(share, own);
                    *e = numbers.sub(*e, part);
                }
            }
        }
    }
    inverse
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
    let determinant = numbers.dot(&matrix[0], &cofactors[0]);
    let reciprocal = numbers.div(Num::ONE, determinant);
    (0..n).map(|i| (0..n).map(|k| numbers.mul(cofactors[k][i], reciprocal)).collect()).collect()
}
