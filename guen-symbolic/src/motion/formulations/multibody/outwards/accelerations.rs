//! Accelerations of points at zero rates of what is free.

use super::kinematics::Kinematics;
use crate::algebra::ExprId;
use crate::motion::formulations::multibody::places::tree::{Turn, Vec3, cross, gradient};
use crate::motion::formulations::multibody::velocities::definitions::Def;
use crate::motion::formulations::multibody::velocities::relations::turned_components;
use crate::motion::formulations::multibody::velocities::variables::{Class, Kind, Var};
use crate::numbering::Num;

impl Kinematics<'_> {
    /// `[alpha]x + [omega]x [omega]x`.
    pub(in crate::motion) fn gradient(&mut self, axes: usize) -> [Vec3; 3] {
        if let Some(known) = self.gradients[axes] {
            return known;
        }
        let w = self.spin(axes);
        let alpha = self.spin_rates(axes);
        let gradient = gradient(self.numbers, &w, &alpha);
        self.gradients[axes] = Some(gradient);
        gradient
    }

    /// The acceleration of gravity in some axes.
    pub(super) fn weight(&mut self, axes: usize) -> Vec3 {
        if let Some(known) = self.weights[axes] {
            return known;
        }
        let weight = if axes == 0 {
            let gravity: Option<[ExprId; 3]> = self.system.structure.gravity;
            gravity.map_or([Num::ZERO; 3], |g| g.map(|e| self.numbers.import(self.bench, e)))
        } else if let Some(declared) = self.tree.spins.iter().find(|found| found.axes == axes) {
            let carrier = self.weight(declared.against);
            [0, 1, 2].map(|q| self.numbers.dot(&declared.matrix.map(|row| row[q]), &carrier))
        } else {
            let parent = self.weight(self.tree.axes[axes].parent);
            self.tree.outwards(self.numbers, axes, &parent)
        };
        self.weights[axes] = Some(weight);
        weight
    }

    /// A component of the acceleration of a point in its own axes.
    pub(in crate::motion) fn acceleration(&mut self, point: usize, q: usize) -> Num {
        let var = self.variables.velocity(point, q);
        if let Some(known) = self.accelerations[var.0 as usize] {
            return known;
        }
        let acceleration = self.fresh_acceleration(point, q, var);
        self.accelerations[var.0 as usize] = Some(acceleration);
        acceleration
    }

    pub(super) fn fresh_acceleration(&mut self, point: usize, q: usize, var: Var) -> Num {
        let node = &self.tree.points[point];
        let (axes, parent) = (node.axes, node.parent);
        if let Some(acceleration) = self.by_component(var, axes, q) {
            return acceleration;
        }
        if let Some(acceleration) = self.determined_otherwise(var, axes, q) {
            return acceleration;
        }
        if axes == self.tree.points[parent].axes {
            return self.acceleration_before(point, q);
        }
        if let Class::Of(representative, _) = self.variables.class(var)
            && representative == var
            && let Some(Def::Row(row)) = self.plan.def(var)
        {
            let rate = self.row_rate(row, var);
            let weight = self.weight(axes)[q];
            return self.numbers.sub(rate, weight);
        }
        self.carried_acceleration(point, q).unwrap_or(Num::ZERO)
    }

    /// A component of the acceleration of a point by what it is in the axes before.
    pub(super) fn carried_acceleration(&mut self, point: usize, q: usize) -> Option<Num> {
        let axes = self.tree.points[point].axes;
        Some(match &self.tree.axes[axes].turn {
            Turn::World => return None,
            Turn::About { axis, cosine, sine, .. } => {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                if q == *axis {
                    return Some(self.acceleration_before(point, q));
                }
                let (c, s) = (*cosine, *sine);
                let (a, b) = (self.acceleration_before(point, i), self.acceleration_before(point, j));
                let (a, b) = if q == i {
                    (self.numbers.mul(c, a), self.numbers.mul(s, b))
                } else {
                    (self.numbers.mul(c, b), self.numbers.mul(s, a).neg())
                };
                self.numbers.add(a, b)
            }
            Turn::By { matrix, .. } => {
                let column = [matrix[0][q], matrix[1][q], matrix[2][q]];
                let before = [0, 1, 2].map(|r| self.acceleration_before(point, r));
                self.numbers.dot(&column, &before)
            }
        })
    }

    /// The acceleration along a velocity that is turned back, or that the kinematics of another one determine.
    fn determined_otherwise(&mut self, var: Var, axes: usize, q: usize) -> Option<Num> {
        if self.variables.class(var) != Class::Of(var, Num::ONE) {
            return None;
        }
        match self.plan.def(var)? {
            Def::Back(image) => {
                // Accelerations are vectors: they turn as velocities do.
                let (images, _) = turned_components(self.tree, self.variables, image)?;
                let place = images.iter().position(|var| *var == image)?;
                let Kind::Velocity(point, _) = self.variables.kind(image) else { return None };
                let entries: Vec<Num> = match &self.tree.axes[self.tree.points[point].axes].turn {
                    Turn::World => return None,
                    Turn::About { cosine, sine, .. } if place == 0 => vec![*cosine, sine.neg()],
                    Turn::About { cosine, sine, .. } => vec![*sine, *cosine],
                    Turn::By { matrix, .. } => matrix[place].to_vec(),
                };
                let mut sum = Num::ZERO;
                for (image, entry) in images.into_iter().zip(entries) {
                    let Kind::Velocity(point, q) = self.variables.kind(image) else { return None };
                    let own = self.acceleration(point, q);
                    let part = self.numbers.mul(entry, own);
                    sum = self.numbers.add(sum, part);
                }
                Some(sum)
            }
            Def::Link(other) => {
                let rate = self.link_rate(other, var);
                let turning = self.turning(var, axes, q);
                let weight = self.weight(axes)[q];
                let sum = self.numbers.add(rate, turning);
                Some(self.numbers.sub(sum, weight))
            }
            _ => None,
        }
    }

    /// Whether a velocity vanishes or is a multiple of a parameter or a rate.
    pub(super) fn is_by_component(&self, var: Var) -> bool {
        let Class::Of(representative, _) = self.variables.class(var) else { return true };
        let is_free = matches!(self.plan.def(representative), Some(Def::Core(_)));
        is_free || !matches!(self.variables.kind(representative), Kind::Velocity(..) | Kind::Before(..))
    }

    /// The acceleration of a point along an axis in which its velocity vanishes or is a multiple of a parameter or a rate.
    pub(super) fn by_component(&mut self, var: Var, axes: usize, q: usize) -> Option<Num> {
        if !self.is_by_component(var) {
            return None;
        }
        let rate = match self.variables.class(var) {
            Class::Zero => Num::ZERO,
            Class::Of(representative, factor) => {
                let rate = self.rate(representative);
                self.numbers.mul(factor, rate)
            }
        };
        let turning = self.turning(var, axes, q);
        let weight = self.weight(axes)[q];
        let sum = self.numbers.add(rate, turning);
        Some(self.numbers.sub(sum, weight))
    }

    /// Returns the part of a point's velocity rate that the turn of its axes makes, `omega x v`.
    pub(super) fn turning(&mut self, var: Var, axes: usize, q: usize) -> Num {
        let velocity = match self.variables.kind(var) {
            Kind::Velocity(point, _) => self.velocity(point),
            Kind::Before(point, _) => self.before(point),
            _ => return Num::ZERO,
        };
        let spin = self.spin(axes);
        cross(self.numbers, &spin, &velocity)[q]
    }

    /// A component of the acceleration of a point in the axes of the one that it is seen from.
    pub(super) fn acceleration_before(&mut self, point: usize, q: usize) -> Num {
        let (tree, variables) = (self.tree, self.variables);
        let node = &tree.points[point];
        if tree.is_at_rest(point) {
            return self.acceleration(node.parent, q);
        }
        let var = variables.before(point, q);
        if let Some(known) = self.accelerations[var.0 as usize] {
            return known;
        }
        let axes = tree.points[node.parent].axes;
        let acceleration = self.fresh_acceleration_before(point, axes, q, var);
        self.accelerations[var.0 as usize] = Some(acceleration);
        acceleration
    }

    pub(super) fn fresh_acceleration_before(&mut self, point: usize, axes: usize, q: usize, var: Var) -> Num {
        let node = &self.tree.points[point];
        if let Some(acceleration) = self.by_component(var, axes, q) {
            return acceleration;
        }
        if let Class::Of(representative, _) = self.variables.class(var)
            && representative == var
            && let Some(Def::Row(row)) = self.plan.def(var)
        {
            let rate = self.row_rate(row, var);
            let weight = self.weight(axes)[q];
            return self.numbers.sub(rate, weight);
        }
        if let Some(acceleration) = self.determined_otherwise(var, axes, q) {
            return acceleration;
        }
        let parent = self.acceleration(node.parent, q);
        if let Some(arm) = &node.arm {
            let gradient = self.gradient(arm.axes);
            let own = gradient.map(|row| self.numbers.dot(&row, &arm.vector));
            let carried = self.tree.seen_in(self.numbers, axes, arm.axes, &own)[q];
            return self.numbers.add(parent, carried);
        }
        let gradient = self.gradient(axes);
        let carried = self.numbers.dot(&gradient[q], &node.offset);
        let mut sum = self.numbers.add(parent, carried);
        if let Some(rates) = &node.rate {
            let own = [0, 1, 2].map(|r| self.form(&rates[r]));
            let spin = self.spin(axes);
            let coriolis = cross(self.numbers, &spin, &own)[q];
            let second = self.form_rate(&rates[q]);
            sum = self.numbers.sum([sum, coriolis, coriolis, second]);
        }
        sum
    }
}
