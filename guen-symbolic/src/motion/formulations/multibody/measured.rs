//! Velocities in outputs, and their rates along the motion, outwards over the axes and points of bodies.
//!
//! Once `x'` and `x''` of the motion are known, nothing has to be solved any more: the angular acceleration of axes and the acceleration of a point
//! follow from one joint to the next,
//!
//! ```text
//! alpha = R^T alpha_p + omega x w + w',   a = R^T (a_p + U_p r + 2 omega_p x r' + r''),   U = [alpha]x + [omega]x [omega]x
//! ```
//!
//! in the axes of the bodies. Outputs are then read as they were written, with second derivatives along coordinates. An expression that has the value
//! of something that is numbered already is not looked into: so of these derivatives only those are left that no recursion gives.

use super::places::tree::{RateForm, Tree, Turn, Vec3, cross, gradient, plus};
use super::{At, DRAWN_POINTS, points};
use crate::algebra::ExprId;
use crate::motion::Mechanics;
use crate::motion::graph::{FormShape, Motion, Place, Velocity};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::numbering::{Num, Numbering, Rates};
use crate::workbench::Workbench;

/// A motion: what the symbols of rates stand for.
pub(in crate::motion) struct Along<'a> {
    /// The rates of the state, velocities first.
    pub(in crate::motion) rates: &'a [ExprId],
    /// Further symbols with what they stand for, over the state and the rates of the parameters.
    pub(in crate::motion) images: &'a [(ExprId, ExprId)],
    /// The symbols of rates of velocities, by the index of the coordinate.
    pub(in crate::motion) second: &'a [(ExprId, usize)],
}

/// Outputs as functions of the state, by the places and frames that they speak of; none where these are not understood.
pub(in crate::motion) fn outputs(
    bench: &mut Workbench,
    system: &Mechanics,
    partials: &mut VelocityPartials,
    along: &Along<'_>,
    outputs: &[ExprId],
) -> Option<Vec<ExprId>> {
    let structure = system.measured.clone()?;
    let seen = Mechanics { structure, ..system.clone() };
    let on_manifold = super::has_general_turns(&seen) && !seen.holonomic.is_empty();
    let mut tried = points(bench, &seen, on_manifold);
    // A length that outputs ask for is a root as well.
    if outputs.iter().any(|e| bench.zero.has_signs_or_roots(&bench.graph, *e)) {
        let drawn = (0..DRAWN_POINTS).map(|number| At { number, on_manifold, has_drawn_roots: true });
        tried.extend(drawn);
    }
    tried.into_iter().find_map(|point| {
        let mut numbers = point.numbering(bench);
        let found = attempt(bench, &mut numbers, &seen, partials, along, outputs)?;
        numbers.is_sound().then(|| numbers.export(&mut bench.graph, &found))
    })
}

fn attempt(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    system: &Mechanics,
    partials: &mut VelocityPartials,
    along: &Along<'_>,
    outputs: &[ExprId],
) -> Option<Vec<Num>> {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    for eta in &system.etas[l..] {
        numbers.define(*eta, Num::ZERO);
    }
    let etas: Vec<Num> = system.etas[..l].iter().map(|eta| numbers.import(bench, *eta)).collect();
    let tree = Tree::new(bench, numbers, system, partials)?;
    let rates: Vec<Num> = along.rates[..n + l].iter().map(|rate| numbers.import(bench, *rate)).collect();
    let (velocities, accelerations) = rates.split_at(n);
    for (symbol, value) in system.velocities.iter().chain(&system.accelerations).zip(&rates) {
        numbers.define(*symbol, *value);
    }
    let coordinates = system.forms.coordinates.iter().zip(velocities);
    let mut symbols: Vec<(ExprId, Num)> = coordinates.map(|(x, rate)| (*x, *rate)).collect();
    symbols.extend(system.etas[..l].iter().copied().zip(accelerations.iter().copied()));
    symbols.push((system.forms.time, Num::ONE));
    for (eta, rate) in etas.into_iter().zip(accelerations) {
        numbers.set_rate(eta, *rate);
    }
    let count = tree.axes.len();
    let mut measured = Measured {
        bench,
        numbers,
        system,
        tree,
        velocities: velocities.to_vec(),
        seconds: vec![None; n],
        motion: Rates { symbols },
        spins: vec![None; count],
        gradients: vec![None; count],
        points: Vec::new(),
    };
    for (symbol, coordinate) in along.second {
        let value = measured.second(*coordinate);
        measured.numbers.define(*symbol, value);
    }
    for (symbol, image) in along.images {
        let value = measured.numbers.import(measured.bench, *image);
        measured.numbers.define(*symbol, value);
    }
    for form in system.structure.forms.iter().flatten() {
        measured.form_and_rate(form);
    }
    let Measured { bench, numbers, .. } = measured;
    numbers.is_sound().then(|| outputs.iter().map(|e| numbers.import(bench, *e)).collect())
}

/// A vector that moves, with its rates in space; all in the same axes.
#[derive(Clone, Copy, Debug)]
struct Moving {
    value: Vec3,
    first: Vec3,
    second: Vec3,
}

const NOTHING: Vec3 = [Num::ZERO; 3];

struct Measured<'a> {
    bench: &'a mut Workbench,
    numbers: &'a mut Numbering,
    system: &'a Mechanics,
    tree: Tree,
    /// `x'`.
    velocities: Vec<Num>,
    /// `x''`.
    seconds: Vec<Option<Num>>,
    motion: Rates,
    /// Angular velocities and accelerations of axes, in these.
    spins: Vec<Option<(Vec3, Vec3)>>,
    /// `[alpha]x + [omega]x [omega]x`.
    gradients: Vec<Option<[Vec3; 3]>>,
    /// Velocities and accelerations of points, in their axes.
    points: Vec<Option<(Vec3, Vec3)>>,
}

impl Measured<'_> {
    fn slope(&mut self, e: Num) -> Num {
        self.numbers.rate(self.bench, &self.motion, e)
    }

    fn slopes(&mut self, v: &Vec3) -> Vec3 {
        v.map(|e| self.slope(e))
    }

    /// `x''` of a coordinate.
    fn second(&mut self, coordinate: usize) -> Num {
        if let Some(known) = self.seconds[coordinate] {
            return known;
        }
        let second = self.slope(self.velocities[coordinate]);
        self.seconds[coordinate] = Some(second);
        second
    }

    /// A form in the rates of coordinates, and its rate.
    fn of_rates(&mut self, form: &RateForm) -> (Num, Num) {
        let mut value = form.offset.unwrap_or(Num::ZERO);
        let mut rate = self.slope(value);
        for (i, c) in &form.terms {
            let velocity = self.velocities[*i];
            let part = self.numbers.mul(*c, velocity);
            value = self.numbers.add(value, part);
            let second = self.second(*i);
            let first = self.numbers.mul(*c, second);
            let slope = self.slope(*c);
            let turned = self.numbers.mul(slope, velocity);
            rate = self.numbers.sum([rate, first, turned]);
        }
        (value, rate)
    }

    fn of_three(&mut self, forms: &[RateForm; 3]) -> (Vec3, Vec3) {
        let both = [0, 1, 2].map(|q| self.of_rates(&forms[q]));
        (both.map(|(value, _)| value), both.map(|(_, rate)| rate))
    }

    /// The angular velocity and acceleration of axes.
    fn spin(&mut self, axes: usize) -> (Vec3, Vec3) {
        if let Some(known) = self.spins[axes] {
            return known;
        }
        let node = &self.tree.axes[axes];
        let (parent, turn) = (node.parent, node.turn.clone());
        let (own, rate) = match &turn {
            Turn::World => (NOTHING, NOTHING),
            Turn::About { axis, rate, .. } => {
                let (mut own, mut second) = (NOTHING, NOTHING);
                (own[*axis], second[*axis]) = self.of_rates(rate);
                (own, second)
            }
            Turn::By { spin, .. } => self.of_three(spin),
        };
        let found = match turn {
            Turn::World => (NOTHING, NOTHING),
            _ => {
                let (carrier, carried) = self.spin(parent);
                let carrier = self.tree.outwards(self.numbers, axes, &carrier);
                let carried = self.tree.outwards(self.numbers, axes, &carried);
                let whole = plus(self.numbers, &carrier, &own);
                // With omega = carrier + w both omega x w and carrier x w are the same.
                let turning = cross(self.numbers, &carrier, &own);
                let second = plus(self.numbers, &carried, &turning);
                (whole, plus(self.numbers, &second, &rate))
            }
        };
        self.spins[axes] = Some(found);
        found
    }

    fn gradient(&mut self, axes: usize) -> [Vec3; 3] {
        if let Some(known) = self.gradients[axes] {
            return known;
        }
        let (w, alpha) = self.spin(axes);
        let gradient = gradient(self.numbers, &w, &alpha);
        self.gradients[axes] = Some(gradient);
        gradient
    }

    /// The rates in space of a vector of axes, whose components there may move; `own` are their rates.
    fn swept(&mut self, axes: usize, value: &Vec3, own: (Vec3, Vec3)) -> (Vec3, Vec3) {
        let (spin, _) = self.spin(axes);
        let turned = cross(self.numbers, &spin, value);
        let first = plus(self.numbers, &turned, &own.0);
        let gradient = self.gradient(axes);
        let turned = gradient.map(|row| self.numbers.dot(&row, value));
        let coriolis = cross(self.numbers, &spin, &own.0);
        let twice = plus(self.numbers, &coriolis, &coriolis);
        let second = plus(self.numbers, &turned, &twice);
        (first, plus(self.numbers, &second, &own.1))
    }

    /// The velocity and acceleration of a point.
    fn point(&mut self, point: usize) -> (Vec3, Vec3) {
        if self.points.len() < self.tree.points.len() {
            self.points.resize(self.tree.points.len(), None);
        }
        if point == 0 {
            return (NOTHING, NOTHING);
        }
        if let Some(known) = self.points[point] {
            return known;
        }
        let node = &self.tree.points[point];
        let (axes, parent, offset) = (node.axes, node.parent, node.offset);
        let (rate, arm) = (node.rate.clone(), node.arm.as_ref().map(|arm| (arm.axes, arm.vector)));
        let base = self.tree.points[parent].axes;
        let (velocity, acceleration) = self.point(parent);
        let (first, second) = match (arm, rate) {
            (Some((own, vector)), _) => {
                let (first, second) = self.swept(own, &vector, (NOTHING, NOTHING));
                [first, second].map(|v| self.tree.seen_in(self.numbers, base, own, &v)).into()
            }
            (None, Some(rate)) => {
                let own = self.of_three(&rate);
                self.swept(base, &offset, own)
            }
            (None, None) => self.swept(base, &offset, (NOTHING, NOTHING)),
        };
        let mut found = (plus(self.numbers, &velocity, &first), plus(self.numbers, &acceleration, &second));
        if axes != base {
            found.0 = self.tree.outwards(self.numbers, axes, &found.0);
            found.1 = self.tree.outwards(self.numbers, axes, &found.1);
        }
        self.points[point] = Some(found);
        found
    }

    /// The velocity and acceleration of a place, and the axes in which they are.
    fn place(&mut self, place: &Place) -> (usize, Vec3, Vec3) {
        let (point, offset) = self.tree.locate(self.bench, self.numbers, self.system, place, None);
        let axes = self.tree.points[point].axes;
        let (velocity, acceleration) = self.point(point);
        let first = self.slopes(&offset);
        let second = self.slopes(&first);
        let (first, second) = self.swept(axes, &offset, (first, second));
        (axes, plus(self.numbers, &velocity, &first), plus(self.numbers, &acceleration, &second))
    }

    /// A vector in space with its rates, in some axes.
    fn vector(&mut self, place: &Place, axes: usize) -> Moving {
        let terms = self.tree.terms(self.bench, self.numbers, place);
        let mut sum = Moving { value: NOTHING, first: NOTHING, second: NOTHING };
        for (own, value) in terms {
            let first = self.slopes(&value);
            let second = self.slopes(&first);
            let (first, second) = self.swept(own, &value, (first, second));
            let [value, first, second] =
                [value, first, second].map(|v| self.tree.seen_in(self.numbers, axes, own, &v));
            sum = Moving {
                value: plus(self.numbers, &sum.value, &value),
                first: plus(self.numbers, &sum.first, &first),
                second: plus(self.numbers, &sum.second, &second),
            };
        }
        sum
    }

    /// A velocity and its rate, in some axes.
    fn velocity(&mut self, velocity: &Velocity, axes: usize) -> (Vec3, Vec3) {
        let (mut sum, mut rate) = (NOTHING, NOTHING);
        for (factor, motion) in &velocity.parts {
            let (value, first) = match motion {
                Motion::Rate(place) => {
                    let (own, velocity, acceleration) = self.place(place);
                    [velocity, acceleration].map(|v| self.tree.seen_in(self.numbers, axes, own, &v)).into()
                }
                Motion::Spin(frame) => {
                    let own = self.tree.axes_of(*frame);
                    let (spin, alpha) = self.spin(own);
                    [spin, alpha].map(|v| self.tree.seen_in(self.numbers, axes, own, &v)).into()
                }
                Motion::Lever(frame, place) => {
                    let own = self.tree.axes_of(*frame);
                    let (spin, alpha) = self.spin(own);
                    let lever = self.vector(place, own);
                    let value = cross(self.numbers, &spin, &lever.value);
                    let turned = cross(self.numbers, &alpha, &lever.value);
                    let moved = cross(self.numbers, &spin, &lever.first);
                    let first = plus(self.numbers, &turned, &moved);
                    [value, first].map(|v| self.tree.seen_in(self.numbers, axes, own, &v)).into()
                }
                Motion::Given(place) => {
                    let given = self.vector(place, axes);
                    (given.value, given.first)
                }
            };
            let factor = self.numbers.import(self.bench, *factor);
            let slope = self.slope(factor);
            for q in 0..3 {
                let own = self.numbers.mul(factor, value[q]);
                sum[q] = self.numbers.add(sum[q], own);
                let (a, b) = (self.numbers.mul(factor, first[q]), self.numbers.mul(slope, value[q]));
                rate[q] = self.numbers.sum([rate[q], a, b]);
            }
        }
        (sum, rate)
    }

    /// Numbers a form of velocities and its rate.
    fn form_and_rate(&mut self, form: &FormShape) -> (Num, Num) {
        let mut value = self.numbers.import(self.bench, form.rest);
        let mut rate = self.slope(value);
        for component in &form.components {
            let terms = component.direction.terms.iter();
            let axes = terms.map(|(frame, _)| self.tree.axes_of(*frame)).max().unwrap_or(0);
            let direction = self.vector(&component.direction, axes);
            let (velocity, acceleration) = self.velocity(&component.velocity, axes);
            let own = self.numbers.dot(&direction.value, &velocity);
            value = self.numbers.add(value, own);
            let turned = self.numbers.dot(&direction.first, &velocity);
            let own = self.numbers.dot(&direction.value, &acceleration);
            rate = self.numbers.sum([rate, own, turned]);
        }
        (value, rate)
    }
}
