//! Steps between velocities: one step outwards, one step back, and forms solved for one of them.

use super::definitions::{Def, Plan};
use super::variables::{Class, Kind, Var, Variables};
use crate::motion::formulations::multibody::places::tree::{RateForm, Tree, Turn};
use crate::numbering::{Num, Numbering};

/// A linear combination of variables that stand for their classes.
pub(in crate::motion) type Linear = Vec<(Var, Num)>;

/// A combination over the variables that stand for their classes.
pub(in crate::motion) fn reduced(
    numbers: &mut Numbering,
    variables: &Variables,
    terms: &[(Var, Num)],
) -> Linear {
    let mut sum: Linear = Vec::new();
    for (var, c) in terms {
        let Class::Of(representative, factor) = variables.class(*var) else { continue };
        let c = numbers.mul(*c, factor);
        match sum.iter_mut().find(|(known, _)| *known == representative) {
            Some((_, known)) => *known = numbers.add(*known, c),
            None => sum.push((representative, c)),
        }
    }
    sum.retain(|(_, c)| !c.is_zero());
    sum
}

/// Returns the kinematics of a variable as a combination that vanishes, over the variables that stand for their
/// classes; the variable itself has the opposite sign.
pub(in crate::motion) fn link(
    numbers: &mut Numbering,
    tree: &Tree,
    variables: &Variables,
    var: Var,
) -> Option<(Linear, Num)> {
    let (mut terms, offset) = raw_kinematic(tree, variables, var)?;
    terms.push((var, Num::ONE.neg()));
    Some((reduced(numbers, variables, &terms), offset))
}

/// The components that one turn makes of others: those of which the variable is one, and what they are made of, in the same
/// order.
pub(in crate::motion) fn turned_components(
    tree: &Tree,
    variables: &Variables,
    var: Var,
) -> Option<(Vec<Var>, Vec<Var>)> {
    let axes = match variables.kind(var) {
        Kind::Spin(axes, _) if axes > 0 => axes,
        Kind::Velocity(point, _) if point > 0 => {
            let node = &tree.points[point];
            if node.axes == tree.points[node.parent].axes {
                return None;
            }
            node.axes
        }
        _ => return None,
    };
    let components: &[usize] = match tree.axes[axes].turn {
        // The spin of a ball joint is between its axes: its rates would have to be known first.
        Turn::By { .. } if matches!(variables.kind(var), Kind::Spin(..)) => return None,
        Turn::World => return None,
        Turn::About { axis, .. } => &[[1, 2], [2, 0], [0, 1]][axis],
        Turn::By { .. } => &[0, 1, 2],
    };
    let of = |q: &usize| match variables.kind(var) {
        Kind::Velocity(point, _) => (variables.velocity(point, *q), variables.before(point, *q)),
        _ => (variables.spin(axes, *q), variables.spin(tree.axes[axes].parent, *q)),
    };
    let (images, sources): (Vec<Var>, Vec<Var>) = components.iter().map(of).unzip();
    images.contains(&var).then_some((images, sources))
}

/// The source of a component that a turn makes, by all that the turn makes: the variable that stands for the source, over
/// variables that stand for their classes.
pub(in crate::motion) fn back(
    numbers: &mut Numbering,
    tree: &Tree,
    variables: &Variables,
    image: Var,
) -> Option<Linear> {
    let (images, sources) = turned_components(tree, variables, image)?;
    let place = images.iter().position(|var| *var == image)?;
    let axes = match variables.kind(image) {
        Kind::Spin(axes, _) => axes,
        Kind::Velocity(point, _) => tree.points[point].axes,
        _ => return None,
    };
    let mut terms: Linear = match &tree.axes[axes].turn {
        Turn::World => return None,
        Turn::About { cosine, sine, .. } if place == 0 => vec![(images[0], *cosine), (images[1], sine.neg())],
        Turn::About { cosine, sine, .. } => vec![(images[0], *sine), (images[1], *cosine)],
        Turn::By { matrix, .. } => (0..3).map(|q| (images[q], matrix[place][q])).collect(),
    };
    let Class::Of(_, factor) = variables.class(sources[place]) else { return None };
    terms.iter_mut().for_each(|(_, c)| *c = numbers.div(*c, factor));
    Some(reduced(numbers, variables, &terms))
}

/// A form that vanishes, solved for a variable.
pub(in crate::motion) fn solved(numbers: &mut Numbering, mut terms: Linear, var: Var) -> Linear {
    let Some(place) = terms.iter().position(|(known, _)| *known == var) else { return Linear::new() };
    let (_, pivot) = terms.remove(place);
    terms.iter().map(|(other, c)| (*other, numbers.div(*c, pivot).neg())).collect()
}

/// A variable by those from which it is one step outwards, and what it is without them.
pub(in crate::motion) fn raw_kinematic(
    tree: &Tree,
    variables: &Variables,
    var: Var,
) -> Option<(Linear, Num)> {
    let mut terms = Linear::new();
    let mut offset = Num::ZERO;
    let form = |terms: &mut Linear, offset: &mut Num, form: &RateForm| {
        terms.extend(form.terms.iter().map(|(i, c)| (variables.rate(*i), *c)));
        *offset = form.offset.unwrap_or(Num::ZERO);
    };
    match variables.kind(var) {
        Kind::Eta(_) | Kind::Rate(_) => return None,
        Kind::Spin(axes, q) => {
            let node = &tree.axes[axes];
            let parent = |q: usize| variables.spin(node.parent, q);
            match &node.turn {
                Turn::World => return None,
                Turn::About { axis, cosine, sine, rate } => {
                    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                    if q == *axis {
                        terms.push((parent(q), Num::ONE));
                        form(&mut terms, &mut offset, rate);
                    } else if q == i {
                        terms.extend([(parent(i), *cosine), (parent(j), *sine)]);
                    } else {
                        terms.extend([(parent(i), sine.neg()), (parent(j), *cosine)]);
                    }
                }
                Turn::By { matrix, spin } => {
                    terms.extend((0..3).map(|r| (parent(r), matrix[r][q])));
                    match variables.of_joint(axes, q) {
                        Some(own) => terms.push(own),
                        None => form(&mut terms, &mut offset, &spin[q]),
                    }
                }
            }
        }
        Kind::Before(point, q) => {
            if point == 0 {
                return None;
            }
            let node = &tree.points[point];
            let axes = tree.points[node.parent].axes;
            let (j, k) = ((q + 1) % 3, (q + 2) % 3);
            terms.push((variables.velocity(node.parent, q), Num::ONE));
            if let Some(arm) = &node.arm {
                terms.extend((0..3).map(|r| (variables.spin(arm.axes, r), arm.by_spin[q][r])));
                terms.retain(|(_, c)| !c.is_zero());
                return Some((terms, offset));
            }
            terms.push((variables.spin(axes, j), node.offset[k]));
            terms.push((variables.spin(axes, k), node.offset[j].neg()));
            if let Some(rate) = &node.rate {
                form(&mut terms, &mut offset, &rate[q]);
            }
        }
        Kind::Velocity(point, q) => {
            if point == 0 {
                return None;
            }
            let node = &tree.points[point];
            let before = |q: usize| variables.before(point, q);
            if node.axes == tree.points[node.parent].axes {
                terms.push((before(q), Num::ONE));
            } else {
                match &tree.axes[node.axes].turn {
                    Turn::World => return None,
                    Turn::About { axis, cosine, sine, .. } => {
                        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                        if q == *axis {
                            terms.push((before(q), Num::ONE));
                        } else if q == i {
                            terms.extend([(before(i), *cosine), (before(j), *sine)]);
                        } else {
                            terms.extend([(before(i), sine.neg()), (before(j), *cosine)]);
                        }
                    }
                    Turn::By { matrix, .. } => terms.extend((0..3).map(|r| (before(r), matrix[r][q]))),
                }
            }
        }
    }
    terms.retain(|(_, c)| !c.is_zero());
    Some((terms, offset))
}

/// The variables that stand for their classes as combinations of those from which they follow.
pub(in crate::motion) fn definition(
    numbers: &mut Numbering,
    tree: &Tree,
    variables: &Variables,
    plan: &Plan,
    var: Var,
) -> Option<(Linear, Num)> {
    match plan.def(var)? {
        Def::Known | Def::Core(_) => None,
        Def::Link(other) => {
            let (terms, offset) = link(numbers, tree, variables, other)?;
            let pivot = terms.iter().find(|(known, _)| *known == var).map(|(_, c)| *c)?;
            let offset = numbers.div(offset, pivot).neg();
            Some((solved(numbers, terms, var), offset))
        }
        Def::Back(image) => Some((back(numbers, tree, variables, image)?, Num::ZERO)),
        Def::Kinematic => {
            let (terms, offset) = raw_kinematic(tree, variables, var)?;
            Some((reduced(numbers, variables, &terms), offset))
        }
        Def::Row(row) => {
            let terms = plan.rows[row].terms.clone();
            let terms = reduced(numbers, variables, &terms);
            let pivot = terms.iter().find(|(known, _)| *known == var).map(|(_, c)| *c)?;
            let offset = numbers.div(plan.rows[row].offset, pivot).neg();
            Some((solved(numbers, terms, var), offset))
        }
    }
}

/// A combination with every variable that is a plain sum of others in their place: what is the same in two of them drops out.
pub(in crate::motion) fn in_steps(
    numbers: &mut Numbering,
    tree: &Tree,
    variables: &Variables,
    plan: &Plan,
    mut terms: Linear,
) -> Linear {
    let mut next = 0;
    while let Some((var, c)) = terms.get(next).copied() {
        match definition(numbers, tree, variables, plan, var) {
            Some((steps, _)) if steps.iter().all(|(_, k)| k.abs() == Num::ONE) => {
                terms.remove(next);
                terms.extend(steps.into_iter().map(|(other, k)| (other, numbers.mul(c, k))));
                terms = reduced(numbers, variables, &terms);
                next = 0;
            }
            _ => next += 1,
        }
    }
    terms
}

/// The variables in an order in which each comes after those from which it follows.
pub(in crate::motion) fn order(
    numbers: &mut Numbering,
    tree: &Tree,
    variables: &Variables,
    plan: &Plan,
    roots: &[Var],
) -> Vec<Var> {
    let mut seen = vec![false; variables.len()];
    let mut order = Vec::new();
    for root in roots {
        let mut stack = vec![(*root, false)];
        while let Some((var, done)) = stack.pop() {
            if done {
                order.push(var);
                continue;
            }
            if std::mem::replace(&mut seen[var.0 as usize], true) {
                continue;
            }
            stack.push((var, true));
            if let Some((terms, _)) = definition(numbers, tree, variables, plan, var) {
                stack.extend(terms.into_iter().rev().map(|(var, _)| (var, false)));
            }
        }
    }
    order
}
