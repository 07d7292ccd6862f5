//! Forms as linear functions of the velocities of a tree, in parts, with what their rates need beside accelerations.

use super::variables::{Class, Var, Variables};
use crate::motion::formulations::multibody::places::tree::{PointNode, Tree, Turn, Vec3, cross};
use crate::numbering::{Num, Numbering};

/// A direction, by its components in some axes.
#[derive(Clone, Debug)]
pub(in crate::motion) struct Direction {
    pub(in crate::motion) axes: usize,
    pub(in crate::motion) vector: Vec3,
    /// Whether its rate is of no matter, because the velocity vanishes in all directions.
    pub(in crate::motion) is_free: bool,
}

/// A part of a form, in the axes that it names.
#[derive(Clone, Debug)]
pub(in crate::motion) enum Part {
    /// The velocity of a point, in its axes.
    Point { point: usize },
    /// The angular velocity of `body` times a lever; the axes are those of the body, or its parent's if it turns about an
    /// axis of these.
    Arm { axes: usize, body: usize, arm: Vec3 },
    /// The angular velocity of axes.
    Spin { axes: usize },
    /// A velocity that is given.
    Given { axes: usize, vector: Vec3 },
    /// Parameters as the components of a vector along the axes of the world.
    Known { components: [Option<Var>; 3] },
    /// The effect of displacements along the operators of forms, counted from 0, on a place beside their turns.
    Strained { axes: usize, vectors: Vec<(usize, Vec3)> },
    /// A form in the rates of coordinates and the parameters.
    Plain { terms: Vec<(Var, Num)>, offset: Num },
}

/// A form: parts along directions.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct Functional {
    /// Parts, each with the index of its direction and the components of that in the axes of the part.
    pub(in crate::motion) parts: Vec<(Part, usize, Vec3)>,
    pub(in crate::motion) directions: Vec<Direction>,
    /// Coefficients of the variables.
    pub(in crate::motion) terms: Vec<(Var, Num)>,
    /// The value of the form at rest.
    pub(in crate::motion) offset: Num,
}

impl Part {
    /// The axes in which it is written.
    pub(super) fn axes(&self, tree: &Tree) -> usize {
        match self {
            Part::Point { point } => tree.points[*point].axes,
            Part::Arm { axes, .. }
            | Part::Spin { axes }
            | Part::Given { axes, .. }
            | Part::Strained { axes, .. } => *axes,
            Part::Plain { .. } | Part::Known { .. } => 0,
        }
    }
}

/// The velocity of a point that is fixed in the axes of another one, by that and a lever, where it vanishes along the direction or is a
/// multiple of something: a form that says so speaks of what it follows from.
fn apart((tree, variables): (&Tree, &Variables), part: &Part, along: &Vec3) -> Vec<Part> {
    let Part::Point { point } = part else { return vec![part.clone()] };
    let is_own = |q: usize| {
        let class = variables.class(variables.velocity(*point, q));
        class == Class::Of(variables.before(*point, q), Num::ONE)
    };
    if !tree.is_end(*point) || (0..3).all(|q| along[q].is_zero() || is_own(q)) {
        return vec![part.clone()];
    }
    let PointNode { axes, parent, offset, .. } = tree.points[*point];
    vec![Part::Point { point: parent }, Part::Arm { axes, body: axes, arm: offset }]
}

impl Functional {
    /// Adds a component of a velocity.
    pub(in crate::motion) fn add(
        &mut self,
        numbers: &mut Numbering,
        (tree, variables): (&Tree, &Variables),
        direction: &Direction,
        parts: &[(Num, Part)],
    ) {
        let index = self.directions.len();
        self.directions.push(direction.clone());
        for (factor, part) in parts {
            let axes = part.axes(tree);
            let seen = tree.seen_in(numbers, axes, direction.axes, &direction.vector);
            let along = seen.map(|e| numbers.mul(*factor, e));
            for part in apart((tree, variables), part, &along) {
                self.add_terms(numbers, (tree, variables), &part, &along);
                self.parts.push((part, index, along));
            }
        }
    }

    fn add_terms(
        &mut self,
        numbers: &mut Numbering,
        (tree, variables): (&Tree, &Variables),
        part: &Part,
        along: &Vec3,
    ) {
        match part {
            Part::Point { point } => {
                for (q, e) in along.iter().enumerate() {
                    self.add_term(numbers, variables.velocity(*point, q), *e);
                }
            }
            Part::Arm { axes, body, arm } => {
                let moment = cross(numbers, arm, along);
                for (q, e) in moment.into_iter().enumerate() {
                    let own = match tree.axes[*body].turn {
                        Turn::About { axis, .. } if axis == q => *body,
                        _ => *axes,
                    };
                    self.add_term(numbers, variables.spin(own, q), e);
                }
            }
            Part::Spin { axes } => {
                for (q, e) in along.iter().enumerate() {
                    self.add_term(numbers, variables.spin(*axes, q), *e);
                }
            }
            Part::Given { vector, .. } => {
                let given = numbers.dot(vector, along);
                self.offset = numbers.add(self.offset, given);
            }
            Part::Known { components } => {
                for (component, e) in components.iter().zip(along) {
                    if let Some(var) = component {
                        self.add_term(numbers, *var, *e);
                    }
                }
            }
            Part::Strained { vectors, .. } => {
                for (form, vector) in vectors {
                    let coefficient = numbers.dot(vector, along);
                    self.add_term(numbers, variables.eta(*form), coefficient);
                }
            }
            Part::Plain { .. } => {}
        }
    }

    pub(in crate::motion) fn add_term(&mut self, numbers: &mut Numbering, var: Var, coefficient: Num) {
        if coefficient.is_zero() {
            return;
        }
        match self.terms.iter_mut().find(|(known, _)| *known == var) {
            Some((_, known)) => *known = numbers.add(*known, coefficient),
            None => self.terms.push((var, coefficient)),
        }
        self.terms.retain(|(_, known)| !known.is_zero());
    }

    /// Adds a form in the rates of coordinates and the parameters.
    pub(super) fn add_plain(&mut self, numbers: &mut Numbering, terms: Vec<(Var, Num)>, offset: Num) {
        for (var, c) in &terms {
            self.add_term(numbers, *var, *c);
        }
        self.offset = numbers.add(self.offset, offset);
        self.parts.push((Part::Plain { terms, offset }, 0, [Num::ZERO; 3]));
    }
}
