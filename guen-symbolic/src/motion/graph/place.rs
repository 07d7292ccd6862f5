//! Places, velocities and forms as sums of what belongs to single frames.

use super::FrameId;
use crate::algebra::{ExprId, Graph};

/// A vector in space: the sum of vectors with components in the axes of frames.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Place {
    /// Frames in ascending order, each once, with components that do not all vanish.
    pub terms: Vec<(FrameId, [ExprId; 3])>,
}

/// A part of a velocity.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Motion {
    /// The rate of a place.
    Rate(Place),
    /// The angular velocity of a frame.
    Spin(FrameId),
    /// The angular velocity of a frame times a lever.
    Lever(FrameId, Place),
    /// A vector that has no velocity in it.
    Given(Place),
}

/// A velocity: the sum of multiples of its parts, the factors functions of time and coordinates.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Velocity {
    /// The parts with their factors.
    pub parts: Vec<(ExprId, Motion)>,
}

/// A component of a velocity.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct VelocityComponent {
    /// The direction, of any length.
    pub direction: Place,
    /// The velocity.
    pub velocity: Velocity,
}

/// A form affine in the velocities: components of velocities in space, and the rest as a scalar.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FormShape {
    /// The components.
    pub components: Vec<VelocityComponent>,
    /// The part that belongs to no velocity in space.
    pub rest: ExprId,
}

impl Place {
    /// A vector in the axes of a frame.
    pub fn in_axes(graph: &Graph, frame: FrameId, components: [ExprId; 3]) -> Self {
        let vanishes = components.iter().all(|e| graph.is_zero(*e));
        Place { terms: if vanishes { Vec::new() } else { vec![(frame, components)] } }
    }

    /// Returns the sum of two places.
    pub fn plus(&self, graph: &mut Graph, other: &Place) -> Place {
        let mut terms = self.terms.clone();
        for (frame, vector) in &other.terms {
            match terms.binary_search_by_key(frame, |(known, _)| *known) {
                Ok(at) => {
                    let known = &mut terms[at].1;
                    *known = [0, 1, 2].map(|i| graph.add(known[i], vector[i]));
                }
                Err(at) => terms.insert(at, (*frame, *vector)),
            }
        }
        terms.retain(|(_, vector)| vector.iter().any(|e| !graph.is_zero(*e)));
        Place { terms }
    }

    /// A multiple, by a function of time and coordinates.
    pub fn times(&self, graph: &mut Graph, factor: ExprId) -> Place {
        let scaled =
            |(frame, vector): &(FrameId, [ExprId; 3])| (*frame, vector.map(|e| graph.mul(factor, e)));
        let mut terms: Vec<_> = self.terms.iter().map(scaled).collect();
        terms.retain(|(_, vector)| vector.iter().any(|e| !graph.is_zero(*e)));
        Place { terms }
    }

    pub(super) fn map(&mut self, mut image: impl FnMut(ExprId) -> ExprId) {
        self.terms.iter_mut().for_each(|(_, vector)| *vector = vector.map(&mut image));
    }
}

impl Velocity {
    /// Creates a velocity of one part.
    pub fn of(graph: &Graph, motion: Motion) -> Self {
        Velocity { parts: vec![(graph.one(), motion)] }
    }

    /// The sum.
    pub fn plus(&self, graph: &mut Graph, other: &Velocity) -> Velocity {
        let mut parts = self.parts.clone();
        for (factor, motion) in &other.parts {
            match parts.iter_mut().find(|(_, known)| known == motion) {
                Some((known, _)) => *known = graph.add(*known, *factor),
                None => parts.push((*factor, motion.clone())),
            }
        }
        parts.retain(|(factor, _)| !graph.is_zero(*factor));
        Velocity { parts }
    }

    /// A multiple, by a function of time and coordinates.
    pub fn times(&self, graph: &mut Graph, factor: ExprId) -> Velocity {
        let scaled = |(own, motion): &(ExprId, Motion)| (graph.mul(factor, *own), motion.clone());
        let mut parts: Vec<_> = self.parts.iter().map(scaled).collect();
        parts.retain(|(factor, _)| !graph.is_zero(*factor));
        Velocity { parts }
    }
}

impl FormShape {
    /// The sum.
    pub fn plus(&self, graph: &mut Graph, other: &FormShape) -> FormShape {
        let mut components = self.components.clone();
        for component in &other.components {
            let same = |known: &&mut VelocityComponent| known.direction == component.direction;
            match components.iter_mut().find(same) {
                Some(known) => known.velocity = known.velocity.plus(graph, &component.velocity),
                None => components.push(component.clone()),
            }
        }
        components.retain(|component| !component.velocity.parts.is_empty());
        FormShape { components, rest: graph.add(self.rest, other.rest) }
    }

    /// A multiple, by a function of time and coordinates.
    pub fn times(&self, graph: &mut Graph, factor: ExprId) -> FormShape {
        let mut components = self.components.clone();
        for component in &mut components {
            component.velocity = component.velocity.times(graph, factor);
        }
        components.retain(|component| !component.velocity.parts.is_empty());
        FormShape { components, rest: graph.mul(factor, self.rest) }
    }

    pub(super) fn map(&mut self, mut image: impl FnMut(ExprId) -> ExprId) {
        for component in &mut self.components {
            component.direction.map(&mut image);
            for (factor, motion) in &mut component.velocity.parts {
                *factor = image(*factor);
                match motion {
                    Motion::Rate(place) | Motion::Lever(_, place) | Motion::Given(place) => {
                        place.map(&mut image)
                    }
                    Motion::Spin(_) => {}
                }
            }
        }
        self.rest = image(self.rest);
    }

    /// Visits every frame that the form speaks of.
    pub(super) fn frames(&self, mut visit: impl FnMut(FrameId)) {
        let mut other = self.clone();
        other.renamed(&mut |frame: &mut FrameId| visit(*frame));
    }

    pub(super) fn renamed(&mut self, mut image: impl FnMut(&mut FrameId)) {
        for component in &mut self.components {
            component.direction.terms.iter_mut().for_each(|(frame, _)| image(frame));
            for (_, motion) in &mut component.velocity.parts {
                match motion {
                    Motion::Rate(place) | Motion::Given(place) => {
                        place.terms.iter_mut().for_each(|(frame, _)| image(frame));
                    }
                    Motion::Spin(frame) => image(frame),
                    Motion::Lever(frame, place) => {
                        image(frame);
                        place.terms.iter_mut().for_each(|(frame, _)| image(frame));
                    }
                }
            }
        }
    }
}
