//! The declared forms and loads over the variables of a tree.

use super::forms::{Direction, Functional, Part};
use super::strain::Strain;
use super::variables::Variables;
use crate::algebra::{ExprId, Rational};
use crate::motion::Mechanics;
use crate::motion::formulations::multibody::places::tree::{Tree, Turn, Vec3, plus};
use crate::motion::graph::{FormShape, Motion, Place, Velocity, VelocityComponent};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::numbering::{Num, Numbering};
use crate::workbench::Workbench;

/// The forms of one vector that vanishes, parameters subtracted, whose components may be taken along any directions.
pub(in crate::motion) struct Group {
    /// Three forms, along the axes named; those that are not declared vanish identically.
    pub(in crate::motion) rows: Vec<usize>,
    pub(in crate::motion) parts: Vec<(Num, Part)>,
    pub(in crate::motion) axes: usize,
}

/// The forms and loads.
pub(in crate::motion) struct Declared {
    /// The forms, parameters subtracted: what vanishes.
    pub(in crate::motion) rows: Vec<Functional>,
    pub(in crate::motion) groups: Vec<Group>,
    /// The velocity along which each force acts.
    pub(in crate::motion) loads: Vec<Functional>,
    /// The parameters as declared, where the system is stated in others.
    pub(in crate::motion) parameters: Vec<Functional>,
}

/// The context in which the parts of the declaration are made.
struct Maker<'a> {
    bench: &'a mut Workbench,
    numbers: &'a mut Numbering,
    system: &'a Mechanics,
    tree: &'a mut Tree,
    strains: &'a [Strain],
}

/// A form as parts, before variables have their numbers.
#[derive(Clone, Debug, Default)]
struct Shape {
    components: Vec<(Direction, Vec<(Num, Part)>)>,
    rest: Option<ExprId>,
}

impl Maker<'_> {
    /// The parts of a form; `None` where a velocity has a factor that moves.
    fn shape(&mut self, shape: &FormShape) -> Option<Shape> {
        let mut components = Vec::new();
        for component in &shape.components {
            let direction = self.direction(&component.direction);
            let parts = self.parts(&component.velocity, direction.axes)?;
            components.push((direction, parts));
        }
        let rest = (!self.bench.graph.is_zero(shape.rest)).then_some(shape.rest);
        Some(Shape { components, rest })
    }

    fn direction(&mut self, place: &Place) -> Direction {
        let terms = self.tree.terms(self.bench, self.numbers, place);
        let axes = terms.iter().map(|(axes, _)| *axes).max().unwrap_or(0);
        let vector = self.sum_in(axes, &terms);
        Direction { axes, vector, is_free: false }
    }

    fn sum_in(&mut self, axes: usize, terms: &[(usize, Vec3)]) -> Vec3 {
        let mut sum = [Num::ZERO; 3];
        for (from, vector) in terms {
            let seen = self.tree.seen_in(self.numbers, axes, *from, vector);
            sum = plus(self.numbers, &sum, &seen);
        }
        sum
    }

    /// The parts of a velocity, places seen in the axes of its levers, or in those given, if these hang on all of theirs.
    fn parts(&mut self, velocity: &Velocity, axes: usize) -> Option<Vec<(Num, Part)>> {
        let mut parts = Vec::new();
        let mut seen = axes;
        for (_, motion) in &velocity.parts {
            if let Motion::Lever(frame, place) = motion {
                let terms = self.tree.terms(self.bench, self.numbers, place);
                seen = self.axes_of_lever(self.tree.axes_of(*frame), &terms);
            }
        }
        for (factor, motion) in &velocity.parts {
            let factor = self.numbers.import(self.bench, *factor);
            if !self.numbers.is_constant(factor) {
                return None;
            }
            match motion {
                Motion::Rate(place) => {
                    for part in self.rate(place, seen)?.into_iter().chain(self.strained(place)) {
                        parts.push((factor, part));
                    }
                }
                Motion::Spin(frame) => parts.push((factor, Part::Spin { axes: self.tree.axes_of(*frame) })),
                Motion::Lever(frame, place) => {
                    let body = self.tree.axes_of(*frame);
                    let terms = self.tree.terms(self.bench, self.numbers, place);
                    let axes = self.axes_of_lever(body, &terms);
                    let arm = self.sum_in(axes, &terms);
                    parts.push((factor, Part::Arm { axes, body, arm }));
                }
                Motion::Given(place) => {
                    for (axes, vector) in self.tree.terms(self.bench, self.numbers, place) {
                        parts.push((factor, Part::Given { axes, vector }));
                    }
                }
            }
        }
        Some(parts)
    }

    /// Numbers the lengths of vectors where these are short.
    fn lengths(&mut self) {
        for (length, place) in &self.system.structure.lengths {
            if self.bench.zero.has_roots_of_squares(&self.bench.graph, *length) {
                continue;
            }
            let terms = self.tree.terms(self.bench, self.numbers, place);
            let axes = terms.iter().map(|(axes, _)| *axes).max().unwrap_or(0);
            let vector = self.sum_in(axes, &terms);
            let square = self.numbers.dot(&vector, &vector);
            self.numbers.sqrt(square);
            self.numbers.import(self.bench, *length);
        }
    }

    /// Numbers functions of places that forces depend on: as sums over the frames in which the places are written, which are short.
    fn scalars(&mut self) {
        let magnitudes: Vec<ExprId> = self.system.forces.iter().map(|force| force.magnitude).collect();
        let below = self.bench.graph.reachable(&magnitudes, |_| false);
        for force in &self.system.forces {
            self.numbers.look_for_multiples(self.bench, force.along);
        }
        let structure = &self.system.structure;
        let is_asked = |(scalar, _): &(&ExprId, &FormShape)| below.contains(*scalar);
        let scalars = structure.scalars.iter().filter(is_asked).map(|(_, shape)| shape);
        for shape in scalars.chain(structure.loads.iter().flatten()) {
            let mut sum = Num::ZERO;
            for VelocityComponent { direction, velocity } in &shape.components {
                let [(factor, Motion::Rate(place))] = &velocity.parts[..] else { continue };
                let factor = self.numbers.import(self.bench, *factor);
                let own = self.product(direction, place);
                let own = self.numbers.mul(factor, own);
                sum = self.numbers.add(sum, own);
            }
            // Of a product each factor has a rate.
            self.numbers.times(self.bench, &Rational::new(1, 2), sum);
        }
    }

    /// The inner product of a direction and a place: in the axes of each frame of the place, or where both have several, in those of the youngest.
    fn product(&mut self, direction: &Place, place: &Place) -> Num {
        let direction = self.tree.terms(self.bench, self.numbers, direction);
        let place = self.tree.terms(self.bench, self.numbers, place);
        if let [(from, vector)] = &direction[..] {
            let mut sum = Num::ZERO;
            for (axes, own) in &place {
                let seen = self.tree.seen_in(self.numbers, *axes, *from, vector);
                let part = self.numbers.dot(&seen, own);
                sum = self.numbers.add(sum, part);
            }
            return sum;
        }
        let axes = direction.iter().chain(&place).map(|(axes, _)| *axes).max().unwrap_or(0);
        let (direction, place) = (self.sum_in(axes, &direction), self.sum_in(axes, &place));
        self.numbers.dot(&direction, &place)
    }

    /// The rate of a place: the velocity of a point and a lever, or levers in axes that do not hang on each other.
    fn rate(&mut self, place: &Place, axes: usize) -> Option<Vec<Part>> {
        let terms = self.tree.all.terms(self.bench, place);
        let youngest = terms.iter().map(|(axes, _)| *axes).max().unwrap_or(0);
        let is_branch = terms.iter().all(|(axes, _)| self.tree.all.hangs_on(youngest, *axes));
        let is_fixed = |v: &[ExprId; 3]| v.iter().all(|e| self.bench.graph.roles(*e).is_constant());
        if !is_branch && terms.iter().all(|(_, v)| is_fixed(v)) {
            let terms = self.tree.terms(self.bench, self.numbers, place);
            let arms = terms.into_iter().filter(|(axes, _)| *axes > 0);
            return Some(arms.map(|(axes, arm)| Part::Arm { axes, body: axes, arm }).collect());
        }
        let hangs = terms.iter().all(|(own, _)| self.tree.all.hangs_on(axes, *own));
        let axes = if hangs { axes } else { youngest };
        let (point, arm) = self.tree.locate(self.bench, self.numbers, self.system, place, Some(axes));
        if axes > 0 && arm.iter().any(|e| !e.is_zero()) && arm.iter().all(|e| self.numbers.is_constant(*e)) {
            let point = self.tree.point_at(self.bench, self.numbers, self.system, place, axes);
            return Some(vec![Part::Point { point }]);
        }
        let mut parts = vec![Part::Point { point }];
        if arm.iter().any(|e| !e.is_zero()) {
            parts.push(Part::Arm { axes, body: axes, arm });
        }
        Some(parts)
    }

    /// The part of a place that is not a turn.
    fn strained(&mut self, place: &Place) -> Option<Part> {
        if self.strains.is_empty() {
            return None;
        }
        let terms = self.tree.terms(self.bench, self.numbers, place);
        let axes = terms.iter().map(|(axes, _)| *axes).max().unwrap_or(0);
        let mut vectors = Vec::new();
        for strain in self.strains {
            let strained: Vec<(usize, Vec3)> =
                terms.iter().map(|(own, v)| (*own, strain.of(self.numbers, *own, v))).collect();
            vectors.push((strain.form, self.sum_in(axes, &strained)));
        }
        Some(Part::Strained { axes, vectors })
    }

    /// The axes in which a lever is short: those of the body, or of the carrier about whose axis it turns.
    fn axes_of_lever(&self, body: usize, terms: &[(usize, Vec3)]) -> usize {
        let node = &self.tree.axes[body];
        let is_own = terms.iter().any(|(axes, _)| *axes == body);
        if !is_own && matches!(node.turn, Turn::About { .. }) { node.parent } else { body }
    }
}

/// The forms and the loads of a system as parts; points that they speak of join the tree.
pub(in crate::motion) struct Shapes {
    forms: Vec<Shape>,
    loads: Vec<Shape>,
    parameters: Vec<Shape>,
}

/// Takes the declared forms and loads apart, and the declared parameters where the system is stated in others.
pub(in crate::motion) fn shapes(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    system: &Mechanics,
    (tree, strains): (&mut Tree, &[Strain]),
    declared: Option<&Mechanics>,
) -> Option<Shapes> {
    let mut maker = Maker { bench, numbers, system, tree, strains };
    let structure = &system.structure;
    let mut taken = |shape: Option<&Option<FormShape>>, written: ExprId| {
        let made = shape.and_then(Option::as_ref).and_then(|shape| maker.shape(shape));
        made.unwrap_or(Shape { components: Vec::new(), rest: Some(written) })
    };
    let forms = system.written.iter().enumerate().map(|(j, e)| taken(structure.forms.get(j), *e)).collect();
    let loads = system.forces.iter().enumerate();
    let loads = loads.map(|(k, force)| taken(structure.loads.get(k), force.along)).collect();
    let parameters = declared.into_iter().flat_map(|declared| {
        (0..declared.forms.degrees).map(|s| (declared.structure.forms.get(s), declared.written[s]))
    });
    let parameters = parameters.map(|(shape, written)| taken(shape, written)).collect();
    maker.lengths();
    maker.scalars();
    Some(Shapes { forms, loads, parameters })
}

impl Declared {
    /// Forms and loads over the variables.
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        numbers: &mut Numbering,
        system: &Mechanics,
        partials: &mut VelocityPartials,
        (tree, variables): (&Tree, &Variables),
        shapes: &Shapes,
    ) -> Option<Self> {
        let l = system.forms.degrees;
        let mut functional = |numbers: &mut Numbering, shape: &Shape| {
            let mut form = Functional::default();
            for (direction, parts) in &shape.components {
                form.add(numbers, (tree, variables), direction, parts);
            }
            if let Some(rest) = shape.rest {
                let rest = partials.affine(bench, rest)?;
                let mut terms = Vec::new();
                for (i, b) in &rest.on_velocities {
                    terms.push((variables.rate(*i), numbers.import(bench, *b)));
                }
                for (j, c) in rest.on_etas.iter().filter(|(j, _)| *j < l) {
                    terms.push((variables.eta(*j), numbers.import(bench, *c)));
                }
                let offset = numbers.import(bench, rest.offset);
                form.add_plain(numbers, terms, offset);
            }
            Some(form)
        };
        let mut rows = Vec::new();
        for (j, shape) in shapes.forms.iter().enumerate() {
            let mut row = functional(numbers, shape)?;
            if j < l {
                row.add_term(numbers, variables.eta(j), Num::ONE.neg());
            }
            rows.push(row);
        }
        let mut all = |shapes: &[Shape]| -> Option<Vec<Functional>> {
            shapes.iter().map(|shape| functional(numbers, shape)).collect()
        };
        let (loads, parameters) = (all(&shapes.loads)?, all(&shapes.parameters)?);
        let mut groups = Vec::new();
        for vector in &system.structure.vectors {
            groups.extend(group(numbers, (tree, variables), shapes, (vector, l), &mut rows));
        }
        Some(Declared { rows, groups, loads, parameters })
    }
}

/// The components of a vector that vanishes, along the axes of its lever: there they are shorter than in the world's. One that is
/// no form vanishes identically, and is as good as one.
fn group(
    numbers: &mut Numbering,
    (tree, variables): (&Tree, &Variables),
    shapes: &Shapes,
    (vector, degrees): (&[Option<usize>; 3], usize),
    rows: &mut Vec<Functional>,
) -> Option<Group> {
    let mut members: Vec<usize> = vector.iter().flatten().copied().collect();
    let mut parts = members.iter().find_map(|j| match &shapes.forms[*j].components[..] {
        [(_, parts)] if shapes.forms[*j].rest.is_none() => Some(parts.clone()),
        _ => None,
    })?;
    let axes = parts.iter().map(|(_, part)| part.axes(tree)).max()?;
    let components = vector.map(|j| j.filter(|j| *j < degrees).map(|j| variables.eta(j)));
    if components.iter().any(Option::is_some) {
        parts.push((Num::ONE.neg(), Part::Known { components }));
    }
    for place in 0..3 {
        let mut vector = [Num::ZERO; 3];
        vector[place] = Num::ONE;
        let direction = Direction { axes, vector, is_free: true };
        let mut row = Functional::default();
        row.add(numbers, (tree, variables), &direction, &parts);
        match members.get(place) {
            Some(member) => rows[*member] = row,
            None => {
                members.push(rows.len());
                rows.push(row);
            }
        }
    }
    Some(Group { rows: members, parts, axes })
}
