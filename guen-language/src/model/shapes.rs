//! The structure of values: which frames and places a vector, a rotation or a form was written in.
//!
//! Values are scalars of the exact algebra, in which equal expressions are one; so what a vector was made of is remembered
//! under its three components, and a value without an entry is one without structure. Nothing here decides what an
//! expression is worth: it only keeps what the evaluation would forget.

use std::collections::BTreeMap;

use guen_symbolic::{
    ExprId, FormShape, FrameId, Graph, Motion, Node, Place, Role, Roles, SystemGraph, Turn, Velocity,
    VelocityComponent,
};

use super::value::{Rotation, Value, Vector};

/// The points and frames behind the expressions resolved so far.
pub(super) struct Shapes {
    /// Frames, bodies, forms and loads.
    pub(super) system: SystemGraph,
    places: BTreeMap<Vector, Place>,
    velocities: BTreeMap<Vector, Velocity>,
    forms: BTreeMap<ExprId, FormShape>,
    /// Rates of functions of places in outputs.
    rated: BTreeMap<ExprId, FormShape>,
    /// Forms whose rates along the motion outputs ask for.
    measured: Vec<FormShape>,
    /// Components of places along axes of the world.
    heights: BTreeMap<ExprId, (usize, Place)>,
}

/// The components of velocities that the rate of a function of places is the sum of, at most.
const MOST_COMPONENTS: usize = 6;

const MOVING: Roles = Roles::of(Role::Velocity)
    .or(Roles::of(Role::QuasiVelocity))
    .or(Roles::of(Role::QuasiAcceleration))
    .or(Roles::of(Role::Input));

fn is_moving(graph: &Graph, v: &Vector) -> bool {
    v.iter().any(|e| graph.roles(*e).meets(MOVING))
}

/// A unit vector along an axis.
pub(super) fn axis(graph: &Graph, i: usize) -> Vector {
    let mut axis = [graph.zero(); 3];
    axis[i] = graph.one();
    axis
}

impl Shapes {
    /// Creates the structure in which nothing is known yet.
    pub(super) fn new(graph: &Graph) -> Self {
        Shapes {
            system: SystemGraph::new(graph),
            places: BTreeMap::new(),
            velocities: BTreeMap::new(),
            forms: BTreeMap::new(),
            rated: BTreeMap::new(),
            measured: Vec::new(),
            heights: BTreeMap::new(),
        }
    }

    /// A vector as a place; one that nothing is known of has its components in the world's axes.
    pub(super) fn place(&self, graph: &Graph, v: &Vector) -> Place {
        self.places.get(v).cloned().unwrap_or_else(|| Place::in_axes(graph, FrameId::WORLD, *v))
    }

    /// A vector as a velocity, where it is known to be one or has no velocity in it.
    fn velocity(&self, graph: &Graph, v: &Vector) -> Option<Velocity> {
        if let Some(known) = self.velocities.get(v) {
            return Some(known.clone());
        }
        if is_moving(graph, v) {
            return None;
        }
        let place = self.place(graph, v);
        let given = Velocity::of(graph, Motion::Given(place.clone()));
        Some(if place.terms.is_empty() { Velocity::default() } else { given })
    }

    fn remember_place(&mut self, v: Vector, place: Place) {
        self.places.entry(v).or_insert(place);
    }

    fn remember_velocity(&mut self, v: Vector, velocity: Velocity) {
        self.velocities.entry(v).or_insert(velocity);
    }

    fn remember_form(&mut self, graph: &Graph, e: ExprId, shape: FormShape) {
        // The rate of a coordinate says what it is.
        if !shape.components.is_empty() && !matches!(graph.node(e), Node::Symbol(_) | Node::Number(_)) {
            self.forms.entry(e).or_insert(shape);
        }
    }

    /// Whether a vector is known to be a velocity in space.
    pub(super) fn is_velocity(&self, v: &Vector) -> bool {
        self.velocities.contains_key(v)
    }

    /// The components of a velocity, where it was met as a vector.
    pub(super) fn written_out(&self, velocity: &Velocity) -> Option<Vector> {
        self.velocities.iter().find(|(_, known)| *known == velocity).map(|(vector, _)| *vector)
    }

    /// A scalar as a form, where structure is known.
    pub(super) fn form(&self, e: ExprId) -> Option<FormShape> {
        self.forms.get(&e).cloned()
    }

    /// A component of a vector in the world's axes as a form, where structure is known.
    pub(super) fn component(&self, graph: &Graph, v: &Vector, i: usize) -> Option<FormShape> {
        if let Some(known) = self.form(v[i]) {
            return Some(known);
        }
        let velocity = self.velocities.get(v)?.clone();
        let direction = Place::in_axes(graph, FrameId::WORLD, axis(graph, i));
        Some(FormShape { components: vec![VelocityComponent { direction, velocity }], rest: graph.zero() })
    }

    fn form_or_rest(&self, e: ExprId) -> FormShape {
        self.form(e).unwrap_or(FormShape { components: Vec::new(), rest: e })
    }

    /// A new rotation: its axes are places, its angular velocities velocities.
    pub(super) fn rotation(&mut self, graph: &Graph, r: &Rotation) {
        for i in 0..3 {
            let column = [0, 1, 2].map(|k| r.matrix[k][i]);
            // A constant place is written in the axes of the world.
            if column.iter().any(|e| !graph.roles(*e).is_constant()) {
                self.remember_place(column, Place::in_axes(graph, r.frame, axis(graph, i)));
            }
        }
        let spin = Velocity::of(graph, Motion::Spin(r.frame));
        if is_moving(graph, &r.world_rate) {
            self.remember_velocity(r.world_rate, spin.clone());
        }
        for (i, e) in r.body_rate.into_iter().enumerate() {
            let direction = Place::in_axes(graph, r.frame, axis(graph, i));
            let components = vec![VelocityComponent { direction, velocity: spin.clone() }];
            if graph.roles(e).meets(MOVING) {
                self.remember_form(graph, e, FormShape { components, rest: graph.zero() });
            }
        }
    }

    /// The frame of a turn about a fixed axis.
    pub(super) fn turn(&mut self, axis: Vector, angle: ExprId) -> FrameId {
        self.system.turned(FrameId::WORLD, Turn::About { axis, angle })
    }

    /// `a + b` is `sum`.
    pub(super) fn added(&mut self, graph: &mut Graph, a: &Vector, b: &Vector, sum: Vector) {
        if is_moving(graph, a) || is_moving(graph, b) {
            let (Some(a), Some(b)) = (self.velocity(graph, a), self.velocity(graph, b)) else { return };
            let velocity = a.plus(graph, &b);
            self.remember_velocity(sum, velocity);
        } else if self.places.contains_key(a) || self.places.contains_key(b) {
            let (a, b) = (self.place(graph, a), self.place(graph, b));
            let place = a.plus(graph, &b);
            self.remember_place(sum, place);
        }
    }

    /// `factor v` is `product`.
    pub(super) fn scaled(&mut self, graph: &mut Graph, factor: ExprId, v: &Vector, product: Vector) {
        if graph.roles(factor).meets(MOVING) {
            return;
        }
        if let Some(known) = self.velocities.get(v) {
            let velocity = known.times(graph, factor);
            self.remember_velocity(product, velocity);
        } else if let Some(known) = self.places.get(v) {
            let place = known.times(graph, factor);
            self.remember_place(product, place);
        }
    }

    /// `R v` is `turned`.
    pub(super) fn turned(&mut self, graph: &mut Graph, r: &Rotation, v: &Vector, turned: Vector) {
        if !is_moving(graph, v) {
            let mut place = Place::default();
            for (frame, components) in self.place(graph, v).terms {
                let frame = self.system.product(r.frame, frame);
                place = place.plus(graph, &Place::in_axes(graph, frame, components));
            }
            self.remember_place(turned, place);
            return;
        }
        let Some(velocity) = self.velocities.get(v).cloned() else { return };
        for (row, e) in r.matrix.iter().zip(turned) {
            let components =
                vec![VelocityComponent { direction: self.place(graph, row), velocity: velocity.clone() }];
            self.remember_form(graph, e, FormShape { components, rest: graph.zero() });
        }
    }

    /// `dot(v)` is `rate`.
    pub(super) fn rate(&mut self, graph: &Graph, v: &Vector, rate: Vector) {
        if is_moving(graph, &rate) && !is_moving(graph, v) {
            let place = self.place(graph, v);
            self.remember_velocity(rate, Velocity::of(graph, Motion::Rate(place)));
        }
    }

    /// The velocity `velocity` of a point that a body has at the end of `arm` from its centre.
    pub(super) fn velocity_at(
        &mut self,
        graph: &mut Graph,
        (center, frame): (&Vector, FrameId),
        arm: &Vector,
        velocity: Vector,
    ) {
        let center = Velocity::of(graph, Motion::Rate(self.place(graph, center)));
        let arm = self.place(graph, arm);
        let lever = Velocity::of(graph, Motion::Lever(frame, arm.clone()));
        let whole = if arm.terms.is_empty() { center } else { center.plus(graph, &lever) };
        self.remember_velocity(velocity, whole);
    }

    /// `inner(u, v)` is `product`.
    pub(super) fn inner(&mut self, graph: &mut Graph, u: &Vector, v: &Vector, product: ExprId) {
        if !is_moving(graph, u) && !is_moving(graph, v) {
            self.scalar(graph, product, [(u, v), (v, u)]);
            self.components(graph, u);
            self.components(graph, v);
            return;
        }
        let (direction, velocity) = match (is_moving(graph, u), is_moving(graph, v)) {
            (false, true) => (u, v),
            (true, false) => (v, u),
            _ => return,
        };
        let Some(velocity) = self.velocities.get(velocity).cloned() else { return };
        let components = vec![VelocityComponent { direction: self.place(graph, direction), velocity }];
        self.remember_form(graph, product, FormShape { components, rest: graph.zero() });
    }

    /// `norm(v)` is `length`.
    pub(super) fn length(&mut self, graph: &mut Graph, v: &Vector, length: ExprId) {
        if is_moving(graph, v) {
            return;
        }
        let lengths = &mut self.system.lengths;
        if self.places.contains_key(v)
            && !graph.roles(length).is_constant()
            && lengths.iter().all(|(known, _)| *known != length)
        {
            lengths.push((length, self.places[v].clone()));
            let inverse = graph.powi(length, -1);
            let unit = v.map(|e| graph.mul(e, inverse));
            self.scaled(graph, inverse, v, unit);
            self.scalar(graph, length, [(&unit, v)]);
        }
    }

    /// The components of a place, of which a function is made.
    fn components(&mut self, graph: &mut Graph, v: &Vector) {
        for i in 0..3 {
            self.scalar(graph, v[i], [(&axis(graph, i), v)]);
        }
    }

    /// A function of places whose rate is the sum of components of velocities, each of a place along a direction.
    fn scalar<const N: usize>(&mut self, graph: &mut Graph, e: ExprId, parts: [(&Vector, &Vector); N]) {
        let mut shape = FormShape { components: Vec::new(), rest: graph.zero() };
        for (direction, v) in parts {
            if v.iter().any(|e| !graph.roles(*e).is_constant()) {
                let velocity = Velocity::of(graph, Motion::Rate(self.place(graph, v)));
                let components =
                    vec![VelocityComponent { direction: self.place(graph, direction), velocity }];
                shape = shape.plus(graph, &FormShape { components, rest: graph.zero() });
            }
        }
        self.remember_scalar(graph, e, shape);
    }

    fn remember_scalar(&mut self, graph: &mut Graph, e: ExprId, shape: FormShape) {
        // A coordinate says what it is.
        if shape.components.is_empty() || matches!(graph.node(e), Node::Symbol(_) | Node::Number(_)) {
            return;
        }
        // In products sums have no factor in common.
        let (content, primitive) = graph.split_content(e);
        if primitive != e
            && let Some(inverse) = content.recip()
        {
            let inverse = graph.number(inverse);
            let shape = shape.times(graph, inverse);
            self.system.scalars.entry(primitive).or_insert(shape);
        }
        self.system.scalars.entry(e).or_insert(shape);
    }

    /// A function of places or a constant, as a function of places.
    fn scalar_or_constant(&self, graph: &Graph, e: ExprId) -> Option<FormShape> {
        let constant = || FormShape { components: Vec::new(), rest: graph.zero() };
        let known = self.system.scalars.get(&e).cloned();
        known.or_else(|| graph.roles(e).is_constant().then(constant))
    }

    /// `v.x`, `v.y` or `v.z`.
    pub(super) fn taken(&mut self, graph: &mut Graph, v: &Vector, i: usize) {
        if is_moving(graph, v)
            && let Some(shape) = self.component(graph, v, i)
        {
            self.remember_form(graph, v[i], shape);
        } else if let Some(place) = self.places.get(v) {
            self.heights.entry(v[i]).or_insert((i, place.clone()));
            self.scalar(graph, v[i], [(&axis(graph, i), v)]);
        }
    }

    /// `dot(e)` of a scalar is `rate`.
    pub(super) fn scalar_rate(&mut self, graph: &Graph, e: ExprId, rate: ExprId) {
        if let Some((i, place)) = self.heights.get(&e) {
            let direction = Place::in_axes(graph, FrameId::WORLD, axis(graph, *i));
            let velocity = Velocity::of(graph, Motion::Rate(place.clone()));
            let components = vec![VelocityComponent { direction, velocity }];
            self.remember_form(graph, rate, FormShape { components, rest: graph.zero() });
        }
    }

    /// Records that the scalar `sum` is `a + b`.
    pub(super) fn scalar_sum(&mut self, graph: &mut Graph, a: ExprId, b: ExprId, sum: ExprId) {
        if self.forms.contains_key(&a) || self.forms.contains_key(&b) {
            let shape = self.form_or_rest(a).plus(graph, &self.form_or_rest(b));
            self.remember_form(graph, sum, shape);
        }
        if let (Some(a), Some(b)) = (self.scalar_or_constant(graph, a), self.scalar_or_constant(graph, b)) {
            // Sums of many are looked at term by term.
            if a.components.len() + b.components.len() <= MOST_COMPONENTS {
                let shape = a.plus(graph, &b);
                self.remember_scalar(graph, sum, shape);
            }
        }
        // A height above another level.
        for (height, level) in [(a, b), (b, a)] {
            if graph.roles(level).is_constant()
                && let Some(known) = self.heights.get(&height).cloned()
            {
                self.heights.entry(sum).or_insert(known);
            }
        }
    }

    /// `factor e` of scalars is `product`.
    pub(super) fn scalar_product(&mut self, graph: &mut Graph, factor: ExprId, e: ExprId, product: ExprId) {
        for (factor, e) in [(factor, e), (e, factor)] {
            if let Some(known) = self.forms.get(&e)
                && !graph.roles(factor).meets(MOVING)
            {
                let shape = known.times(graph, factor);
                self.remember_form(graph, product, shape);
            }
            if let Some(known) = self.system.scalars.get(&e)
                && graph.roles(factor).is_constant()
            {
                let shape = known.times(graph, factor);
                self.remember_scalar(graph, product, shape);
            }
        }
    }

    /// `dot(e)` of a function of places is `rate` in an output.
    pub(super) fn rated(&mut self, e: ExprId, rate: ExprId) {
        if let Some(shape) = self.system.scalars.get(&e) {
            self.rated.entry(rate).or_insert_with(|| shape.clone());
        }
    }

    /// The rate of a scalar along the motion is asked for; whether it is known as a form.
    pub(super) fn measure_scalar(&mut self, e: ExprId) -> bool {
        let shape = self.form(e).or_else(|| self.rated.get(&e).cloned());
        self.measure(shape)
    }

    /// The rate of a component of a vector along the motion is asked for; whether it is known as a form.
    pub(super) fn measure_component(&mut self, graph: &Graph, v: &Vector, i: usize) -> bool {
        let shape = self.component(graph, v, i);
        self.measure(shape)
    }

    fn measure(&mut self, shape: Option<FormShape>) -> bool {
        let is_known = shape.is_some();
        self.measured.extend(shape.filter(|shape| !self.measured.contains(shape)));
        is_known
    }

    /// The graph of the forms whose rates are asked for, if there are any.
    pub(super) fn measured(&self) -> Option<SystemGraph> {
        let forms: Vec<Option<FormShape>> = self.measured.iter().cloned().map(Some).collect();
        let mut graph = (!forms.is_empty()).then(|| self.system.clone())?;
        graph.forms = forms;
        Some(graph)
    }

    /// A name for a value: frames are called by it.
    pub(super) fn named(&mut self, name: &str, value: &Value) {
        if let Value::Rotation(rotation) = value {
            self.system.name(rotation.frame, name);
        }
    }
}
