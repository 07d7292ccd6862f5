//! Velocities of a state, and accelerations at zero rates of the parameters and of the core's unknowns, outwards.
//!
//! Accelerations are those of points in space, gravity taken as an upward acceleration of the world:
//!
//! ```text
//! alpha = R^T alpha_p + omega x w + w',   a = R^T (a_p + U_p r + 2 omega_p x r' + r''),   U = [alpha]x + [omega]x [omega]x
//! ```
//!
//! with the spin `w` of a joint and the place `r` of a point in the axes of the one that it is seen from. Where a velocity is
//! a multiple of a parameter its component has no rate of its own, and the acceleration is what its axes do to it.

use crate::motion::formulations::multibody::places::tree::{RateForm, Tree, Turn, Vec3, cross};
use crate::motion::formulations::multibody::planning::core::Core;
use crate::motion::formulations::multibody::velocities::definitions::{Def, Plan};
use crate::motion::formulations::multibody::velocities::forms::Part;
use crate::motion::formulations::multibody::velocities::relations::{
    Linear, definition, link, raw_kinematic, reduced,
};
use crate::motion::formulations::multibody::velocities::variables::{Class, Kind, Var, Variables};
use crate::motion::{Frame, Mechanics};
use crate::numbering::{Num, Numbering, Rates};
use crate::workbench::Workbench;

/// Velocities and accelerations, each computed when it is asked for.
pub(in crate::motion) struct Kinematics<'a> {
    pub(in crate::motion) bench: &'a mut Workbench,
    pub(in crate::motion) numbers: &'a mut Numbering,
    pub(in crate::motion) system: &'a Mechanics,
    pub(in crate::motion) frame: &'a Frame,
    pub(in crate::motion) tree: &'a Tree,
    pub(in crate::motion) variables: &'a Variables,
    pub(in crate::motion) plan: &'a Plan,
    pub(in crate::motion) core: &'a Core,
    pub(super) values: Vec<Option<Num>>,
    pub(super) rates: Vec<Option<Num>>,
    pub(super) accelerations: Vec<Option<Num>>,
    pub(super) gradients: Vec<Option<[Vec3; 3]>>,
    pub(super) weights: Vec<Option<Vec3>>,
    pub(super) motion: Option<Rates>,
    /// Whether velocities are those at zero parameters.
    pub(in crate::motion) is_at_rest: bool,
}

impl<'a> Kinematics<'a> {
    pub(in crate::motion) fn new(
        bench: &'a mut Workbench,
        numbers: &'a mut Numbering,
        system: &'a Mechanics,
        frame: &'a Frame,
        (tree, variables): (&'a Tree, &'a Variables),
        (plan, core): (&'a Plan, &'a Core),
    ) -> Self {
        let count = variables.len();
        Kinematics {
            bench,
            numbers,
            system,
            frame,
            tree,
            variables,
            plan,
            core,
            values: vec![None; count],
            rates: vec![None; count],
            accelerations: vec![None; count],
            gradients: vec![None; tree.axes.len()],
            weights: vec![None; tree.axes.len()],
            motion: None,
            is_at_rest: false,
        }
    }

    /// Goes on at zero parameters: what is accelerated is by gravity and forces alone.
    pub(in crate::motion) fn rest(&mut self) {
        self.values.fill(None);
        self.is_at_rest = true;
    }

    /// The value of a variable.
    pub(in crate::motion) fn value(&mut self, var: Var) -> Num {
        let Class::Of(representative, factor) = self.variables.class(var) else { return Num::ZERO };
        let own = match self.values[representative.0 as usize] {
            Some(known) => known,
            None => {
                let own = self.fresh_value(representative);
                self.values[representative.0 as usize] = Some(own);
                own
            }
        };
        self.numbers.mul(factor, own)
    }

    pub(super) fn fresh_value(&mut self, var: Var) -> Num {
        match self.plan.def(var) {
            Some(Def::Known) if self.is_at_rest => Num::ZERO,
            Some(Def::Known) => {
                let Kind::Eta(s) = self.variables.kind(var) else { return Num::ZERO };
                self.numbers.import(self.bench, self.system.etas[s])
            }
            Some(Def::Core(index)) => {
                let solution = &self.core.solutions[index];
                let mut sum = self.core.offsets[index];
                for (eta, c) in solution {
                    let eta = self.value(*eta);
                    let part = self.numbers.mul(*c, eta);
                    sum = self.numbers.add(sum, part);
                }
                sum
            }
            // A form solved for a variable is divided once.
            Some(Def::Row(row)) => {
                let terms = self.plan.rows[row].terms.clone();
                let terms = reduced(self.numbers, self.variables, &terms);
                self.solved(terms, self.plan.rows[row].offset, var)
            }
            Some(Def::Link(other)) => match link(self.numbers, self.tree, self.variables, other) {
                Some((terms, offset)) => self.solved(terms, offset, var),
                None => Num::ZERO,
            },
            Some(Def::Kinematic | Def::Back(_)) => {
                let Some((terms, offset)) =
                    definition(self.numbers, self.tree, self.variables, self.plan, var)
                else {
                    return Num::ZERO;
                };
                let mut sum = Num::ZERO;
                for (other, c) in terms {
                    let other = self.value(other);
                    let part = self.numbers.mul(c, other);
                    sum = self.numbers.add(sum, part);
                }
                self.numbers.add(sum, offset)
            }
            None => match self.variables.kind(var) {
                Kind::Rate(_) if self.is_at_rest => Num::ZERO,
                // Nothing in the tree needs it: by what it is a coordinate of, or as the operators have it.
                Kind::Rate(i) => match self.rate_of_coordinate(i) {
                    Some(rate) => rate,
                    None => self.numbers.import(self.bench, self.frame.velocities[i]),
                },
                _ => match raw_kinematic(self.tree, self.variables, var) {
                    Some((terms, offset)) => {
                        let mut sum = offset;
                        for (other, c) in terms {
                            let other = self.value(other);
                            let part = self.numbers.mul(c, other);
                            sum = self.numbers.add(sum, part);
                        }
                        sum
                    }
                    None => Num::ZERO,
                },
            },
        }
    }

    /// A combination that vanishes, solved for a variable.
    pub(super) fn solved(&mut self, terms: Linear, offset: Num, var: Var) -> Num {
        let mut sum = offset;
        let mut pivot = Num::ONE;
        for (other, c) in terms {
            if other == var {
                pivot = c;
                continue;
            }
            let other = self.value(other);
            let part = self.numbers.mul(c, other);
            sum = self.numbers.add(sum, part);
        }
        self.numbers.div(sum, pivot).neg()
    }

    pub(in crate::motion) fn spin(&mut self, axes: usize) -> Vec3 {
        [0, 1, 2].map(|q| self.value(self.variables.spin(axes, q)))
    }

    pub(super) fn velocity(&mut self, point: usize) -> Vec3 {
        [0, 1, 2].map(|q| self.value(self.variables.velocity(point, q)))
    }

    pub(super) fn before(&mut self, point: usize) -> Vec3 {
        [0, 1, 2].map(|q| self.value(self.variables.before(point, q)))
    }

    pub(super) fn form(&mut self, form: &RateForm) -> Num {
        let mut sum = form.offset.unwrap_or(Num::ZERO);
        for (i, c) in &form.terms {
            let rate = self.value(self.variables.rate(*i));
            let part = self.numbers.mul(*c, rate);
            sum = self.numbers.add(sum, part);
        }
        sum
    }

    /// The spin of axes against their parent, in their own axes.
    pub(in crate::motion) fn relative_spin(&mut self, axes: usize) -> Vec3 {
        let node = &self.tree.axes[axes];
        match &node.turn {
            Turn::World => [Num::ZERO; 3],
            Turn::About { axis, .. } => {
                let mut spin = [Num::ZERO; 3];
                let own = self.value(self.variables.spin(axes, *axis));
                let parent = self.value(self.variables.spin(node.parent, *axis));
                spin[*axis] = self.numbers.sub(own, parent);
                spin
            }
            Turn::By { .. } => {
                let parent = self.spin(node.parent);
                let seen = self.tree.outwards(self.numbers, axes, &parent);
                let own = self.spin(axes);
                [0, 1, 2].map(|q| self.numbers.sub(own[q], seen[q]))
            }
        }
    }

    /// Returns the motion: time, and coordinates with their rates. Sines and cosines of joints, and the world's axes
    /// in all others, are known to turn.
    pub(in crate::motion) fn motion(&mut self) -> Rates {
        if let Some(motion) = &self.motion {
            return Rates { symbols: motion.symbols.clone() };
        }
        let mut symbols = vec![(self.system.forms.time, Num::ONE)];
        for (i, x) in self.system.forms.coordinates.iter().enumerate() {
            let rate = self.value(self.variables.rate(i));
            symbols.push((*x, rate));
        }
        for axes in 1..self.tree.axes.len() {
            if let Turn::About { cosine, sine, .. } = &self.tree.axes[axes].turn {
                let Turn::About { axis, .. } = self.tree.axes[axes].turn else { continue };
                let rate = self.relative_spin(axes)[axis];
                let (fall, rise) = (self.numbers.mul(*sine, rate), self.numbers.mul(*cosine, rate));
                self.numbers.set_rate(*cosine, fall.neg());
                self.numbers.set_rate(*sine, rise);
            }
        }
        for axes in 1..self.tree.axes.len() {
            let spin = self.spin(axes);
            for q in 0..3 {
                let mut unit = [Num::ZERO; 3];
                unit[q] = Num::ONE;
                let seen = self.tree.seen_in(self.numbers, axes, 0, &unit);
                let rate = cross(self.numbers, &seen, &spin);
                for (e, rate) in seen.into_iter().zip(rate) {
                    self.numbers.set_rate(e, rate);
                }
            }
        }
        self.turn_normals();
        self.motion = Some(Rates { symbols: symbols.clone() });
        Rates { symbols }
    }

    /// Levers along what is left of an axis of the world across an axis of a body, as to the lowest point of a wheel: they keep
    /// their length, so that they turn, by
    ///
    /// ```text
    /// e' = Omega k x e,   Omega = n_k (e . omega)/|n - n_k k| - omega_k
    /// ```
    ///
    /// with the axis `n` of the world. What both components have in common does not have to cancel in each.
    pub(super) fn turn_normals(&mut self) {
        let rows = self.plan.rows.iter();
        let arms = rows.flat_map(|row| &row.parts).filter_map(|(part, ..)| match part {
            Part::Arm { axes, arm, .. } => Some((*axes, *arm)),
            _ => None,
        });
        let mut arms: Vec<(usize, Vec3)> = arms.collect();
        arms.dedup();
        for (axes, arm) in arms {
            for (k, normal) in (0..3).flat_map(|k| (0..3).map(move |normal| (k, normal))) {
                self.turn_normal(axes, &arm, k, normal);
            }
        }
    }

    fn turn_normal(&mut self, axes: usize, arm: &Vec3, k: usize, normal: usize) {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let mut unit = [Num::ZERO; 3];
        unit[normal] = Num::ONE;
        let n = self.tree.seen_in(self.numbers, axes, 0, &unit);
        let across = [n[i], n[j]];
        if !arm[k].is_zero() || across.iter().chain(&[arm[i], arm[j]]).any(|e| self.numbers.is_constant(*e)) {
            return;
        }
        let square = self.numbers.dot(&across, &across);
        let Some(size) = self.numbers.known_root(square) else { return };
        let direction = across.map(|e| self.numbers.div(e, size));
        let Some(length) = self.numbers.ratio(arm[i], direction[0]) else { return };
        if self.numbers.ratio(arm[j], direction[1]) != Some(length) || !self.numbers.is_constant(length) {
            return;
        }
        let spin = self.spin(axes);
        let along = self.numbers.dot(&direction, &[spin[i], spin[j]]);
        let share = self.numbers.div(n[k], size);
        let share = self.numbers.mul(share, along);
        let turning = self.numbers.sub(share, spin[k]);
        let (first, second) = (self.numbers.mul(turning, arm[j]), self.numbers.mul(turning, arm[i]));
        self.numbers.set_rate(arm[i], first.neg());
        self.numbers.set_rate(arm[j], second);
    }

    pub(super) fn slope(&mut self, e: Num) -> Num {
        if self.numbers.is_constant(e) {
            return Num::ZERO;
        }
        let motion = self.motion();
        self.numbers.rate(self.bench, &motion, e)
    }

    /// The rate of a rate form at zero rates of what is free.
    pub(super) fn form_rate(&mut self, form: &RateForm) -> Num {
        let mut sum = form.offset.map_or(Num::ZERO, |offset| self.slope(offset));
        for (i, c) in &form.terms {
            let var = self.variables.rate(*i);
            let rate = self.rate(var);
            let first = self.numbers.mul(*c, rate);
            let slope = self.slope(*c);
            let value = if slope.is_zero() { Num::ZERO } else { self.value(var) };
            let second = self.numbers.mul(slope, value);
            sum = self.numbers.sum([sum, first, second]);
        }
        sum
    }

    /// The rate of a spin or of a coordinate's rate.
    pub(in crate::motion) fn rate(&mut self, var: Var) -> Num {
        let Class::Of(representative, factor) = self.variables.class(var) else { return Num::ZERO };
        if let Some(known) = self.rates[var.0 as usize] {
            return known;
        }
        let rate = if representative == var {
            self.fresh_rate(var)
        } else {
            let rate = self.rate(representative);
            self.numbers.mul(factor, rate)
        };
        self.rates[var.0 as usize] = Some(rate);
        rate
    }

    pub(super) fn fresh_rate(&mut self, var: Var) -> Num {
        match (self.plan.def(var), self.variables.kind(var)) {
            (Some(Def::Known | Def::Core(_)), _) => Num::ZERO,
            (Some(Def::Row(row)), _) => self.row_rate(row, var),
            (Some(Def::Link(other)), _) => self.link_rate(other, var),
            (Some(Def::Back(image)), _) => self.back_rate(image),
            (_, Kind::Spin(axes, q)) => self.spin_rate(axes, q),
            (_, Kind::Rate(i)) => {
                // Nothing in the tree determines it: along the motion, at zero rates of the parameters.
                let motion = self.motion();
                let velocity = self.frame.velocities[i];
                self.numbers.slope_of(self.bench, &motion, velocity)
            }
            _ => Num::ZERO,
        }
    }

    pub(super) fn spin_rate(&mut self, axes: usize, q: usize) -> Num {
        let node = &self.tree.axes[axes];
        match &node.turn {
            Turn::World => Num::ZERO,
            Turn::About { axis, cosine, sine, rate } => {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                let (axis, cosine, sine) = (*axis, *cosine, *sine);
                if q == axis {
                    let parent = self.rate(self.variables.spin(node.parent, q));
                    let own = self.form_rate(rate);
                    return self.numbers.add(parent, own);
                }
                let relative = self.relative_spin(axes)[axis];
                let [p_i, p_j] = [i, j].map(|q| self.rate(self.variables.spin(node.parent, q)));
                let other = self.value(self.variables.spin(axes, if q == i { j } else { i }));
                let turning = self.numbers.mul(other, relative);
                if q == i {
                    let (a, b) = (self.numbers.mul(cosine, p_i), self.numbers.mul(sine, p_j));
                    self.numbers.sum([a, b, turning])
                } else {
                    let (a, b) = (self.numbers.mul(cosine, p_j), self.numbers.mul(sine, p_i));
                    self.numbers.sum([a, b.neg(), turning.neg()])
                }
            }
            Turn::By { matrix, spin } => {
                let parent = [0, 1, 2].map(|r| self.rate(self.variables.spin(node.parent, r)));
                let column = [matrix[0][q], matrix[1][q], matrix[2][q]];
                let carried = self.numbers.dot(&column, &parent);
                let own = match self.variables.of_joint(axes, q) {
                    Some(_) => Num::ZERO,
                    None => self.form_rate(&spin[q]),
                };
                let relative = self.relative_spin(axes);
                let whole = self.spin(axes);
                let turning = cross(self.numbers, &whole, &relative)[q];
                self.numbers.sum([carried, own, turning])
            }
        }
    }

    pub(in crate::motion) fn spin_rates(&mut self, axes: usize) -> Vec3 {
        [0, 1, 2].map(|q| self.rate(self.variables.spin(axes, q)))
    }
}
