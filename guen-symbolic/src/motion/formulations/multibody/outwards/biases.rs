//! Rates of forms at zero rates of what is free: of those that determine a variable, and of those of the core.

use super::kinematics::Kinematics;
use crate::motion::formulations::multibody::places::tree::{Turn, Vec3, cross, plus};
use crate::motion::formulations::multibody::velocities::forms::{Functional, Part};
use crate::motion::formulations::multibody::velocities::relations::{back, raw_kinematic};
use crate::motion::formulations::multibody::velocities::variables::{Class, Kind, Var};
use crate::numbering::Num;

impl Kinematics<'_> {
    /// The rate of a variable that a form determines.
    pub(super) fn row_rate(&mut self, row: usize, var: Var) -> Num {
        let functional = self.plan.rows[row].clone();
        let mut pivot = Num::ZERO;
        let mut sum = self.remainder(&functional);
        for (raw, c) in &functional.terms {
            let (own, rate) = match self.variables.class(*raw) {
                Class::Zero => (Num::ZERO, self.true_rate(*raw)),
                Class::Of(representative, factor) if representative == var => {
                    // What is left of a velocity that is a multiple of the variable.
                    let rest = match self.variables.kind(*raw) {
                        Kind::Velocity(point, q)
                            if !matches!(self.variables.kind(var), Kind::Velocity(..) | Kind::Before(..)) =>
                        {
                            self.turning(*raw, self.tree.points[point].axes, q)
                        }
                        _ => Num::ZERO,
                    };
                    (factor, rest)
                }
                Class::Of(..) => (Num::ZERO, self.true_rate(*raw)),
            };
            let own = self.numbers.mul(*c, own);
            pivot = self.numbers.add(pivot, own);
            let part = self.numbers.mul(*c, rate);
            sum = self.numbers.add(sum, part);
        }
        self.numbers.div(sum, pivot).neg()
    }

    /// The rate of a variable that follows from what another one follows from.
    pub(super) fn link_rate(&mut self, other: Var, var: Var) -> Num {
        // A velocity that is a multiple of the variable, by the acceleration that it follows from.
        if let Kind::Velocity(point, q) = self.variables.kind(other)
            && let Class::Of(representative, factor) = self.variables.class(other)
            && representative == var
            && let Some(acceleration) = self.carried_acceleration(point, q)
        {
            let axes = self.tree.points[point].axes;
            let weight = self.weight(axes)[q];
            let turning = self.turning(other, axes, q);
            let sum = self.numbers.add(acceleration, weight);
            let sum = self.numbers.sub(sum, turning);
            return self.numbers.div(sum, factor);
        }
        let (sum, pivot) = self.link_bias(other, Some(var));
        self.numbers.div(sum, pivot).neg()
    }

    /// The rate of what another variable follows from, without that variable, at zero rate of the one given; and what that is
    /// multiplied by.
    pub(in crate::motion) fn link_bias(&mut self, other: Var, var: Option<Var>) -> (Num, Num) {
        let Some((mut terms, offset)) = raw_kinematic(self.tree, self.variables, other) else {
            return (Num::ZERO, Num::ONE);
        };
        terms.push((other, Num::ONE.neg()));
        let mut pivot = Num::ZERO;
        let mut sum = self.slope(offset);
        for (raw, c) in terms {
            let slope = self.slope(c);
            if !slope.is_zero() {
                let value = self.value(raw);
                let part = self.numbers.mul(slope, value);
                sum = self.numbers.add(sum, part);
            }
            match self.variables.class(raw) {
                Class::Zero => {}
                Class::Of(representative, factor) if Some(representative) == var => {
                    let own = self.numbers.mul(c, factor);
                    pivot = self.numbers.add(pivot, own);
                }
                Class::Of(..) => {
                    let rate = self.component_rate(raw);
                    let part = self.numbers.mul(c, rate);
                    sum = self.numbers.add(sum, part);
                }
            }
        }
        (sum, pivot)
    }

    /// The rate of a variable that is turned into known ones.
    pub(super) fn back_rate(&mut self, image: Var) -> Num {
        let Some(terms) = back(self.numbers, self.tree, self.variables, image) else {
            return Num::ZERO;
        };
        let mut sum = Num::ZERO;
        for (other, c) in terms {
            let rate = self.component_rate(other);
            let slope = self.slope(c);
            let first = self.numbers.mul(c, rate);
            let value = self.value(other);
            let second = self.numbers.mul(slope, value);
            sum = self.numbers.sum([sum, first, second]);
        }
        sum
    }

    /// The rate of a component in its own axes.
    pub(super) fn component_rate(&mut self, var: Var) -> Num {
        let (axes, q, acceleration) = match self.variables.kind(var) {
            Kind::Velocity(point, q) => (self.tree.points[point].axes, q, self.acceleration(point, q)),
            Kind::Before(point, q) => {
                let axes = self.tree.points[self.tree.points[point].parent].axes;
                (axes, q, self.acceleration_before(point, q))
            }
            _ => return self.rate(var),
        };
        let weight = self.weight(axes)[q];
        let turning = self.turning(var, axes, q);
        let sum = self.numbers.add(acceleration, weight);
        self.numbers.sub(sum, turning)
    }

    /// The rate of a variable; of a velocity the acceleration of the point, without gravity.
    pub(super) fn true_rate(&mut self, var: Var) -> Num {
        match self.variables.kind(var) {
            Kind::Velocity(point, q) => {
                let acceleration = self.acceleration(point, q);
                let weight = self.weight(self.tree.points[point].axes)[q];
                self.numbers.add(acceleration, weight)
            }
            _ => self.rate(var),
        }
    }

    /// The rate of a form at zero rates of the parameters and of the core's unknowns.
    pub(in crate::motion) fn form_bias(&mut self, row: &Functional) -> Num {
        // A lever that is fixed in its axes is accelerated by their gradient, which all rows share; what gravity is along the direction
        // is found where both are known.
        let mut other = Functional { directions: row.directions.clone(), ..row.clone() };
        other.parts.clear();
        let mut whole: Vec<(usize, usize, Vec3, Vec3)> = Vec::new();
        let mut sum = Num::ZERO;
        for (part, direction, along) in &row.parts {
            let (axes, acceleration) = match part {
                Part::Point { point } if !self.has_own_rate(*point, along) => {
                    for (q, e) in along.iter().enumerate() {
                        other.add_term(self.numbers, self.variables.velocity(*point, q), e.neg());
                    }
                    other.parts.push((part.clone(), *direction, *along));
                    let axes = self.tree.points[*point].axes;
                    let seen = self.tree.seen_in(self.numbers, 0, axes, along);
                    let weight = self.weight(0);
                    let fall = self.numbers.dot(&seen, &weight);
                    sum = self.numbers.add(sum, fall);
                    (axes, [0, 1, 2].map(|q| self.acceleration(*point, q)))
                }
                Part::Arm { axes, body, arm }
                    if axes == body && arm.iter().all(|e| self.numbers.is_constant(*e)) =>
                {
                    for (q, e) in cross(self.numbers, arm, along).into_iter().enumerate() {
                        other.add_term(self.numbers, self.variables.spin(*axes, q), e.neg());
                    }
                    let spin = self.spin(*axes);
                    let velocity = cross(self.numbers, &spin, arm);
                    let turned = self.by_direction(row, *direction, *axes, along, &velocity);
                    sum = self.numbers.add(sum, turned);
                    let gradient = self.gradient(*axes);
                    (*axes, gradient.map(|row| self.numbers.dot(&row, arm)))
                }
                _ => {
                    other.parts.push((part.clone(), *direction, *along));
                    continue;
                }
            };
            let same = |known: &&mut (usize, usize, Vec3, Vec3)| {
                (known.0, known.1, known.2) == (axes, *direction, *along)
            };
            match whole.iter_mut().find(same) {
                Some((.., known)) => *known = plus(self.numbers, known, &acceleration),
                None => whole.push((axes, *direction, *along, acceleration)),
            }
        }
        for (_, _, along, acceleration) in whole {
            let own = self.numbers.dot(&along, &acceleration);
            sum = self.numbers.add(sum, own);
        }
        let rest = self.remainder(&other);
        sum = self.numbers.add(sum, rest);
        for (var, c) in &other.terms {
            let rate = self.true_rate(*var);
            let part = self.numbers.mul(*c, rate);
            sum = self.numbers.add(sum, part);
        }
        sum
    }

    /// Whether the velocity of a point has a component of its own along a direction, of which the acceleration is made.
    fn has_own_rate(&self, point: usize, along: &Vec3) -> bool {
        (0..3).any(|q| !along[q].is_zero() && self.is_by_component(self.variables.velocity(point, q)))
    }

    /// Returns the rate of a form less the accelerations of its variables.
    pub(super) fn remainder(&mut self, row: &Functional) -> Num {
        let mut sum = Num::ZERO;
        for (part, direction, along) in &row.parts {
            let own = match part {
                Part::Point { point } => {
                    let velocity = self.velocity(*point);
                    let axes = self.tree.points[*point].axes;
                    self.by_direction(row, *direction, axes, along, &velocity)
                }
                Part::Arm { axes, body, arm } => {
                    let (spin, extra) = self.lever_spin(*axes, *body);
                    let rates = arm.map(|e| self.slope(e));
                    let carrier = self.spin(*axes);
                    let carried = cross(self.numbers, &carrier, arm);
                    let moving = plus(self.numbers, &rates, &carried);
                    let first = cross(self.numbers, &spin, &moving);
                    let second = cross(self.numbers, &extra, arm);
                    let whole = plus(self.numbers, &first, &second);
                    let own = self.numbers.dot(along, &whole);
                    let velocity = cross(self.numbers, &spin, arm);
                    let turned = self.by_direction(row, *direction, *axes, along, &velocity);
                    self.numbers.add(own, turned)
                }
                Part::Spin { axes } => {
                    let spin = self.spin(*axes);
                    self.by_direction(row, *direction, *axes, along, &spin)
                }
                Part::Given { axes, vector } => {
                    let rates = vector.map(|e| self.slope(e));
                    let carrier = self.spin(*axes);
                    let carried = cross(self.numbers, &carrier, vector);
                    let whole = plus(self.numbers, &rates, &carried);
                    let own = self.numbers.dot(along, &whole);
                    let turned = self.by_direction(row, *direction, *axes, along, vector);
                    self.numbers.add(own, turned)
                }
                // What has no rate but that of the parameters.
                Part::Known { .. } | Part::Strained { .. } => Num::ZERO,
                Part::Plain { terms, offset } => {
                    let mut own = self.slope(*offset);
                    for (var, c) in terms {
                        let slope = self.slope(*c);
                        if !slope.is_zero() {
                            let value = self.value(*var);
                            let part = self.numbers.mul(slope, value);
                            own = self.numbers.add(own, part);
                        }
                    }
                    own
                }
            };
            sum = self.numbers.add(sum, own);
        }
        sum
    }

    /// The angular velocity of a body in the axes of its lever, and what its rate has beside those of its components.
    pub(super) fn lever_spin(&mut self, axes: usize, body: usize) -> (Vec3, Vec3) {
        let mut spin = self.spin(axes);
        let mut extra = [Num::ZERO; 3];
        if let Turn::About { axis, .. } = self.tree.axes[body].turn
            && body != axes
        {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let whole = self.value(self.variables.spin(body, axis));
            let relative = self.numbers.sub(whole, spin[axis]);
            extra[i] = self.numbers.mul(relative, spin[j]);
            extra[j] = self.numbers.mul(relative, spin[i]).neg();
            spin[axis] = whole;
        }
        (spin, extra)
    }

    /// The rate of a direction along a velocity.
    pub(super) fn by_direction(
        &mut self,
        row: &Functional,
        direction: usize,
        axes: usize,
        along: &Vec3,
        velocity: &Vec3,
    ) -> Num {
        let own = row.directions[direction].clone();
        if own.is_free || velocity.iter().all(|e| e.is_zero()) {
            return Num::ZERO;
        }
        if own.axes == axes && own.vector.iter().all(|e| self.numbers.is_constant(*e)) {
            // d' . v = (omega x d) . v
            let spin = self.spin(axes);
            let turning = cross(self.numbers, &spin, along);
            return self.numbers.dot(&turning, velocity);
        }
        let rates = own.vector.map(|e| self.slope(e));
        let spin = self.spin(own.axes);
        let carried = cross(self.numbers, &spin, &own.vector);
        let whole = plus(self.numbers, &rates, &carried);
        if whole.iter().all(|e| e.is_zero()) {
            return Num::ZERO;
        }
        // A part may have a constant factor.
        let scale = (0..3).find_map(|q| {
            let seen = self.tree.seen_in(self.numbers, axes, own.axes, &own.vector);
            (!seen[q].is_zero()).then(|| self.numbers.div(along[q], seen[q]))
        });
        let seen = self.tree.seen_in(self.numbers, axes, own.axes, &whole);
        let product = self.numbers.dot(&seen, velocity);
        self.numbers.mul(scale.unwrap_or(Num::ONE), product)
    }
}
