//! The system graph: what a declaration says of frames, places, bodies, forms and loads, before anything is multiplied out.
//!
//! Frames hang on each other by turns, the first of them is the world. A place is a sum of vectors, each with its components in
//! the axes of one frame; a velocity is a sum of rates of places and of angular velocities. The scalars that the rest of the
//! derivation works with say the same without the structure; every node here has an expression beside it that it must agree
//! with.

mod place;
mod print;

pub use place::{FormShape, Motion, Place, Velocity, VelocityComponent};

use std::collections::BTreeMap;

use crate::algebra::{ExprId, Graph, Substitution};

/// A frame of a system graph.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct FrameId(u32);

impl FrameId {
    /// The world.
    pub const WORLD: FrameId = FrameId(0);

    /// The position in the graph's list of frames.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The turn of a frame against its parent.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Turn {
    /// A turn by an angle about a unit vector of constants in the axes of the parent.
    About {
        /// The unit vector.
        axis: [ExprId; 3],
        /// The angle, of time and coordinates.
        angle: ExprId,
    },
    /// Any rotation.
    General {
        /// The rotation matrix from these axes to the parent's, row by row.
        matrix: [[ExprId; 3]; 3],
        /// The angular velocity against the parent, in these axes, linear in the velocities.
        spin: [ExprId; 3],
    },
}

/// A frame.
#[derive(Clone, Debug)]
pub struct FrameNode {
    /// The name in the declaration; empty if it has none.
    pub name: String,
    /// The frame on which it hangs; older.
    pub parent: FrameId,
    /// The turn against the parent. The world has a turn by no angle.
    pub turn: Turn,
}

/// A body or a particle.
#[derive(Clone, Debug)]
pub struct BodyNode {
    /// The name in the declaration; empty for particles.
    pub name: String,
    /// The frame in whose axes its inertia is given, where it has inertia.
    pub frame: Option<FrameId>,
    /// The mass centre, where it has mass.
    pub center: Option<Place>,
    /// The mass.
    pub mass: ExprId,
    /// The entries `xx, yy, zz, xy, yz, zx` of the inertia about the mass centre.
    pub inertia: [ExprId; 6],
}

/// The structure of a declared system: frames, bodies, particles, forms and loads.
#[derive(Clone, Debug, Default)]
pub struct SystemGraph {
    frames: Vec<FrameNode>,
    /// Bodies and particles in their order.
    pub bodies: Vec<BodyNode>,
    /// The acceleration of gravity, in the world's axes.
    pub gravity: Option<[ExprId; 3]>,
    /// Lengths of vectors, where these are written in frames.
    pub lengths: Vec<(ExprId, Place)>,
    /// Functions of places with their rates: lengths, products and components of vectors.
    pub scalars: BTreeMap<ExprId, FormShape>,
    /// Each form as it was declared, where it speaks of places and frames.
    pub forms: Vec<Option<FormShape>>,
    /// The forms that are the components of one velocity along the axes of the world; those that vanish identically are no
    /// forms.
    pub vectors: Vec<[Option<usize>; 3]>,
    /// The velocity along which each force acts, as far as it speaks of places and frames.
    pub loads: Vec<Option<FormShape>>,
}

impl SystemGraph {
    /// A graph that has the world only.
    pub fn new(graph: &Graph) -> Self {
        let zero = graph.zero();
        let turn = Turn::About { axis: [zero, zero, graph.one()], angle: zero };
        let world = FrameNode { name: "world".to_owned(), parent: FrameId::WORLD, turn };
        SystemGraph { frames: vec![world], ..SystemGraph::default() }
    }

    /// The frames; each hangs on an older one.
    pub fn frames(&self) -> &[FrameNode] {
        &self.frames
    }

    /// The frame at a position of the list.
    pub(crate) fn id(&self, index: usize) -> FrameId {
        FrameId(index as u32)
    }

    /// A frame.
    pub fn frame(&self, id: FrameId) -> &FrameNode {
        &self.frames[id.index()]
    }

    /// The frame that is turned so against its parent; the same turn is the same frame.
    pub fn turned(&mut self, parent: FrameId, turn: Turn) -> FrameId {
        let known = self.frames[1..].iter().position(|frame| frame.parent == parent && frame.turn == turn);
        let place = known.map_or(self.frames.len(), |place| place + 1);
        if place == self.frames.len() {
            self.frames.push(FrameNode { name: String::new(), parent, turn });
        }
        FrameId(place as u32)
    }

    /// Names a frame, if it has no name yet.
    pub fn name(&mut self, id: FrameId, name: &str) {
        let frame = &mut self.frames[id.index()];
        if frame.name.is_empty() {
            name.clone_into(&mut frame.name);
        }
    }

    /// The turns that lead from the world to a frame, in this order.
    pub fn turns(&self, id: FrameId) -> Vec<Turn> {
        let mut found = Vec::new();
        let mut place = id;
        while place != FrameId::WORLD {
            found.push(self.frame(place).turn.clone());
            place = self.frame(place).parent;
        }
        found.reverse();
        found
    }

    /// The frame `A B`: turned against `a` as `b` is against the world.
    pub fn product(&mut self, a: FrameId, b: FrameId) -> FrameId {
        self.turns(b).into_iter().fold(a, |frame, turn| self.turned(frame, turn))
    }

    /// The frame from which the world looks as the frame does from the world.
    pub fn inverse(&mut self, graph: &mut Graph, id: FrameId) -> FrameId {
        let turns = self.turns(id);
        turns.into_iter().rev().fold(FrameId::WORLD, |frame, turn| {
            let turn = inverse(graph, turn);
            self.turned(frame, turn)
        })
    }

    /// The graph without frames of which nothing speaks and on which nothing hangs.
    pub fn pruned(mut self) -> SystemGraph {
        let mut used = vec![false; self.frames.len()];
        let mut note = |frame: FrameId| used[frame.index()] = true;
        for body in &self.bodies {
            body.frame.iter().for_each(|frame| note(*frame));
            body.center.iter().flat_map(|place| &place.terms).for_each(|(frame, _)| note(*frame));
        }
        let scalars = self.scalars.values();
        for shape in self.forms.iter().chain(&self.loads).flatten().chain(scalars) {
            shape.frames(&mut note);
        }
        self.lengths.iter().flat_map(|(_, place)| &place.terms).for_each(|(frame, _)| note(*frame));
        for index in (1..used.len()).rev() {
            let parent = self.frames[index].parent.index();
            used[parent] |= used[index];
        }
        used[0] = true;
        let mut next = 0;
        let places: Vec<u32> = used.iter().map(|used| (next, next += u32::from(*used)).0).collect();
        let image = |frame: &mut FrameId| *frame = FrameId(places[frame.index()]);
        let frames = core::mem::take(&mut self.frames).into_iter().zip(used);
        self.frames = frames.filter_map(|(frame, used)| used.then_some(frame)).collect();
        self.frames.iter_mut().for_each(|frame| image(&mut frame.parent));
        for body in &mut self.bodies {
            body.frame.iter_mut().for_each(image);
            body.center.iter_mut().flat_map(|place| &mut place.terms).for_each(|(frame, _)| image(frame));
        }
        let scalars = self.scalars.values_mut();
        let shapes = self.forms.iter_mut().chain(&mut self.loads).flatten().chain(scalars);
        shapes.for_each(|shape| shape.renamed(&image));
        self.lengths.iter_mut().flat_map(|(_, place)| &mut place.terms).for_each(|(frame, _)| image(frame));
        self
    }

    /// The graph with values in place of constants.
    pub(crate) fn with_values(&self, graph: &mut Graph, values: &mut Substitution) -> SystemGraph {
        let mut image = |e: ExprId| values.of(graph, e);
        let mut other = self.clone();
        for frame in &mut other.frames {
            match &mut frame.turn {
                Turn::About { axis, angle } => {
                    *axis = axis.map(&mut image);
                    *angle = image(*angle);
                }
                Turn::General { matrix, spin } => {
                    *matrix = matrix.map(|row| row.map(&mut image));
                    *spin = spin.map(&mut image);
                }
            }
        }
        for body in &mut other.bodies {
            body.mass = image(body.mass);
            body.inertia = body.inertia.map(&mut image);
            body.center.iter_mut().for_each(|place| place.map(&mut image));
        }
        other.gravity = other.gravity.map(|vector| vector.map(&mut image));
        for (length, place) in &mut other.lengths {
            *length = image(*length);
            place.map(&mut image);
        }
        other.scalars =
            core::mem::take(&mut other.scalars).into_iter().map(|(e, shape)| (image(e), shape)).collect();
        other.scalars.values_mut().for_each(|shape| shape.map(&mut image));
        for shape in other.forms.iter_mut().chain(&mut other.loads).flatten() {
            shape.map(&mut image);
        }
        other
    }
}

fn inverse(graph: &mut Graph, turn: Turn) -> Turn {
    match turn {
        Turn::About { axis, angle } => Turn::About { axis, angle: graph.neg(angle) },
        Turn::General { matrix, spin } => {
            let back = matrix.map(|row| {
                let products: Vec<ExprId> = row.iter().zip(spin).map(|(a, b)| graph.mul(*a, b)).collect();
                let sum = graph.sum(products);
                graph.neg(sum)
            });
            let transposed = [0, 1, 2].map(|i| [0, 1, 2].map(|k| matrix[k][i]));
            Turn::General { matrix: transposed, spin: back }
        }
    }
}
