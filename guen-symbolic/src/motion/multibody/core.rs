//! The core: forms pulled back to parameters and unknowns, and solved for the unknowns.

use std::collections::BTreeMap;

use super::definitions::{Equation, Plan};
use super::forms::{Functional, Part};
use super::plan::Planner;
use super::relations::{Linear, definition, link, order};
use super::tree::{Tree, Turn, plus};
use super::variables::{Var, Variables};
use crate::numbering::{Num, Numbering};

/// A combination of parameters and unknowns.
type Combination = BTreeMap<Var, Num>;

/// A step of the elimination: a form solved for an unknown.
struct Step {
    row: usize,
    unknown: usize,
    /// The reciprocal of the divisor.
    inverse: Num,
    /// Unknowns that are solved for later, with what they contribute.
    later: Vec<(usize, Num)>,
    /// Forms that have the unknown too, with its coefficients there.
    others: Vec<(usize, Num)>,
}

/// The unknowns of a core as functions of the parameters.
#[derive(Default)]
pub(super) struct Core {
    steps: Vec<Step>,
    /// The combination of parameters of each unknown.
    pub(super) solutions: Vec<Linear>,
    /// The value of each unknown where all parameters are zero.
    pub(super) offsets: Vec<Num>,
    /// The divisors of the elimination.
    pub(super) pivots: Vec<Num>,
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
            let (row, unknown) = choose(planner, &rows, &unknowns, &open_rows, &open)?;
            open_rows.retain(|r| *r != row);
            open.retain(|u| *u != unknown);
            let numbers = &mut *planner.numbers;
            let var = unknowns[unknown];
            let (mut combination, offset) = rows[row].clone();
            let pivot = combination.remove(&var)?;
            core.pivots.push(pivot);
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
            core.steps.push(Step { row, unknown, inverse, later, others });
        }
        // Unknowns that were solved for later are put in.
        let numbers = &mut *planner.numbers;
        for step in core.steps.iter().rev() {
            let mut combination = Combination::new();
            let mut offset = core.offsets[step.unknown];
            for (var, c) in core.solutions[step.unknown].clone() {
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
            core.solutions[step.unknown] = combination.into_iter().collect();
            core.offsets[step.unknown] = offset;
        }
        planner.numbers.is_sound().then_some(core)
    }

    /// The unknowns of the same forms with other values without unknowns, and without parameters.
    pub(super) fn solve(&self, numbers: &mut Numbering, mut right: Vec<Num>) -> Vec<Num> {
        let mut found = vec![Num::ZERO; self.solutions.len()];
        for step in &self.steps {
            let own = numbers.mul(right[step.row], step.inverse).neg();
            for (other, c) in &step.others {
                let part = numbers.mul(*c, own);
                right[*other] = numbers.add(right[*other], part);
            }
            found[step.unknown] = own;
        }
        for step in self.steps.iter().rev() {
            for (other, c) in &step.later {
                let part = numbers.mul(*c, found[*other]);
                found[step.unknown] = numbers.add(found[step.unknown], part);
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

/// The form and the unknown to eliminate: of those whose coefficient vanishes at no state that was looked at the one with the
/// fewest other unknowns.
fn choose(
    planner: &mut Planner<'_>,
    rows: &[(Combination, Num)],
    unknowns: &[Var],
    open_rows: &[usize],
    open: &[usize],
) -> Option<(usize, usize)> {
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
    candidates.first().map(|(.., row, unknown)| (*row, *unknown))
}
