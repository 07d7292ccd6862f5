//! The quadratic form and the forces of all bodies, and the way back from the leaves to the parameters.

use std::collections::BTreeMap;

use super::beside::Row;
use super::form::Form;
use crate::motion::Mechanics;
use crate::motion::formulations::multibody::outwards::kinematics::Kinematics;
use crate::motion::formulations::multibody::places::tree::{Content, Tree, Turn};
use crate::motion::formulations::multibody::planning::core::Core;
use crate::motion::formulations::multibody::velocities::definitions::{Def, Equation, Plan};
use crate::motion::formulations::multibody::velocities::forms::Functional;
use crate::motion::formulations::multibody::velocities::relations::{definition, order, reduced};
use crate::motion::formulations::multibody::velocities::variables::{Class, Kind, Var, Variables};
use crate::motion::thresholds::WRITTEN_OUT_PARAMETERS;
use crate::numbering::{Num, Numbering};

/// Returns the velocities that the energies of the bodies depend on.
pub(in crate::motion) fn needed(tree: &Tree, variables: &Variables) -> Vec<Var> {
    let mut found = Vec::new();
    for content in &tree.contents {
        if let Some(axis) = axial(tree, content) {
            found.push(variables.spin(content.axes, axis));
            let parent = tree.axes[content.axes].parent;
            found.extend((0..3).filter(|q| *q != axis).map(|q| variables.spin(parent, q)));
            continue;
        }
        let has_inertia = content.inertia.iter().chain(&content.moment).any(|e| !e.is_zero());
        if has_inertia {
            found.extend((0..3).map(|q| variables.spin(content.axes, q)));
        }
        if let Some(point) = content.point
            && (!content.mass.is_zero() || content.moment.iter().any(|e| !e.is_zero()))
        {
            found.extend((0..3).map(|q| variables.velocity(point, q)));
        }
    }
    found
}

/// The axis of a joint about which alone a content has inertia: a rotor, or what is left of a wheel.
fn axial(tree: &Tree, content: &Content) -> Option<usize> {
    let Turn::About { axis, .. } = tree.axes[content.axes].turn else { return None };
    let others = (0..6).filter(|q| *q != axis).map(|q| content.inertia[q]);
    let mut others = others.chain(content.moment).chain([content.mass]);
    others.all(|e| e.is_zero()).then_some(axis)
}

/// An order in which velocities leave the equations.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::motion) struct Order {
    parameters: Leaving,
    /// Whether velocities that are shifted along levers are eliminated before those that a joint turns.
    shifts_first: bool,
}

/// The time at which a parameter leaves the equations.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Leaving {
    /// After all velocities: the mass matrix of the parameters is factored.
    AtTheRoot,
    /// As soon as all velocities that follow from it have left: the inertia of articulated bodies.
    OnTheWay,
}

/// All orders that are tried, those to the root first.
pub(in crate::motion) const ORDERS: [Order; 4] = [
    Order { parameters: Leaving::AtTheRoot, shifts_first: false },
    Order { parameters: Leaving::AtTheRoot, shifts_first: true },
    Order { parameters: Leaving::OnTheWay, shifts_first: false },
    Order { parameters: Leaving::OnTheWay, shifts_first: true },
];

/// Equations with the numbering in which they are.
pub(in crate::motion) struct Root {
    pub(in crate::motion) table: Numbering,
    /// The mass matrix of the parameters.
    pub(in crate::motion) mass: Vec<Vec<Num>>,
    /// The forces along the parameters.
    pub(in crate::motion) forces: Vec<Num>,
}

impl Root {
    pub(super) fn cost(&self) -> usize {
        let entries: Vec<Num> = self.mass.iter().flatten().chain(&self.forces).copied().collect();
        self.table.cost(&entries)
    }
}

/// The rates of velocities beyond those at resting parameters, once the rates of the parameters are known.
struct Outwards<'a, 'b> {
    tree: &'a Tree,
    variables: &'a Variables,
    plan: &'a Plan,
    core: &'a Core,
    /// The accelerations of the core's unknowns at resting parameters.
    bias: &'a [Num],
    found: &'b BTreeMap<Var, Num>,
    known: &'b mut BTreeMap<Var, Num>,
}

impl Outwards<'_, '_> {
    fn rate(&mut self, numbers: &mut Numbering, var: Var) -> Num {
        if let Some(rate) = self.found.get(&var).or_else(|| self.known.get(&var)) {
            return *rate;
        }
        let (terms, mut sum) = match self.plan.def(var) {
            Some(Def::Core(index)) => (self.core.solutions[index].clone(), self.bias[index]),
            _ => {
                let found = definition(numbers, self.tree, self.variables, self.plan, var);
                (found.map(|(terms, _)| terms).unwrap_or_default(), Num::ZERO)
            }
        };
        for (other, c) in terms {
            let rate = self.rate(numbers, other);
            let part = numbers.mul(c, rate);
            sum = numbers.add(sum, part);
        }
        self.known.insert(var, sum);
        sum
    }
}

/// The equations of a tree while they are put up and solved.
pub(in crate::motion) struct Assembly<'a> {
    pub(in crate::motion) kinematics: Kinematics<'a>,
    pub(in crate::motion) form: Form,
    /// The parameters as declared, where the system is stated in others.
    pub(in crate::motion) declared: Vec<Functional>,
}

impl<'a> Assembly<'a> {
    pub(in crate::motion) fn new(kinematics: Kinematics<'a>) -> Self {
        Assembly { kinematics, form: Form::default(), declared: Vec::new() }
    }

    /// A product of two velocities in the energy.
    pub(super) fn add(&mut self, i: Var, j: Var, e: Num) {
        let variables = self.kinematics.variables;
        self.form.add(self.kinematics.numbers, variables, i, j, e);
    }

    /// A force along a variable.
    pub(super) fn push(&mut self, i: Var, e: Num) {
        let variables = self.kinematics.variables;
        self.form.push(self.kinematics.numbers, variables, i, e);
    }

    /// Inertias and inertial forces of all bodies.
    pub(in crate::motion) fn bodies(&mut self) {
        let tree = self.kinematics.tree;
        for content in &tree.contents {
            match axial(tree, content) {
                Some(axis) => self.rotor(content, axis),
                None => self.body(content),
            }
        }
    }

    /// A moment of inertia about the axis of a joint: in the axes of the carrier.
    fn rotor(&mut self, content: &Content, k: usize) {
        let (tree, variables) = (self.kinematics.tree, self.kinematics.variables);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let parent = tree.axes[content.axes].parent;
        let moment = content.inertia[k];
        let own = variables.spin(content.axes, k);
        self.add(own, own, moment);
        let rate = self.kinematics.rate(own);
        let numbers = &mut *self.kinematics.numbers;
        let back = numbers.mul(moment, rate);
        self.push(own, back.neg());
        let value = self.kinematics.value(own);
        let momentum = self.kinematics.numbers.mul(moment, value);
        let [w_i, w_j] = [i, j].map(|q| self.kinematics.value(variables.spin(parent, q)));
        let numbers = &mut *self.kinematics.numbers;
        let (first, second) = (numbers.mul(momentum, w_j), numbers.mul(momentum, w_i));
        self.push(variables.spin(parent, i), first.neg());
        self.push(variables.spin(parent, j), second);
    }

    fn body(&mut self, content: &Content) {
        let variables = self.kinematics.variables;
        let spin = [0, 1, 2].map(|q| variables.spin(content.axes, q));
        let (h, inertia) = (content.moment, content.inertia);
        let turns = inertia.iter().chain(&h).any(|e| !e.is_zero());
        let mut acceleration = [Num::ZERO; 3];
        if let Some(point) = content.point
            && (!content.mass.is_zero() || h.iter().any(|e| !e.is_zero()))
        {
            acceleration = [0, 1, 2].map(|q| self.kinematics.acceleration(point, q));
            let velocity = [0, 1, 2].map(|q| variables.velocity(point, q));
            for (q, own) in velocity.into_iter().enumerate() {
                let (j, k) = ((q + 1) % 3, (q + 2) % 3);
                self.add(own, own, content.mass);
                self.add(own, spin[j], h[k]);
                self.add(own, spin[k], h[j].neg());
            }
            let gradient = if turns { self.kinematics.gradient(content.axes) } else { [[Num::ZERO; 3]; 3] };
            for (q, own) in velocity.into_iter().enumerate() {
                let numbers = &mut *self.kinematics.numbers;
                let straight = numbers.mul(content.mass, acceleration[q]);
                let turning = numbers.dot(&gradient[q], &h);
                let force = numbers.add(straight, turning);
                self.push(own, force.neg());
            }
        }
        if !turns {
            return;
        }
        for q in 0..3 {
            self.add(spin[q], spin[q], inertia[q]);
            self.add(spin[q], spin[(q + 1) % 3], inertia[3 + q]);
        }
        let torque = self.torque(content);
        let numbers = &mut *self.kinematics.numbers;
        let lever = crate::motion::formulations::multibody::places::tree::cross(numbers, &h, &acceleration);
        for q in 0..3 {
            let whole = self.kinematics.numbers.add(torque[q], lever[q]);
            self.push(spin[q], whole.neg());
        }
    }

    /// The torque `I alpha + omega x I omega`, from the products of spins that the gradient has already.
    fn torque(&mut self, content: &Content) -> [Num; 3] {
        let [xx, yy, zz, xy, yz, zx] = content.inertia;
        if content.inertia.iter().all(|e| e.is_zero()) {
            return [Num::ZERO; 3];
        }
        let w = self.kinematics.spin(content.axes);
        let alpha = self.kinematics.spin_rates(content.axes);
        let u = self.kinematics.gradient(content.axes);
        let n = &mut *self.kinematics.numbers;
        let squares = w.map(|e| n.square(e));
        let diagonal = [xx, yy, zz];
        let off = [[Num::ZERO, xy, zx], [xy, Num::ZERO, yz], [zx, yz, Num::ZERO]];
        [0, 1, 2].map(|q| {
            let (j, k) = ((q + 1) % 3, (q + 2) % 3);
            let own = n.mul(diagonal[q], alpha[q]);
            let difference = n.sub(diagonal[k], diagonal[j]);
            let product = n.mul(w[j], w[k]);
            let gyroscopic = n.mul(difference, product);
            let first = n.mul(off[q][j], u[k][q]);
            let second = n.mul(off[q][k], u[j][q]);
            let spread = n.sub(squares[j], squares[k]);
            let third = n.mul(off[j][k], spread);
            n.sum([own, gyroscopic, first.neg(), second, third])
        })
    }

    /// Adds the inertia and the forces of the energies beside those of the bodies.
    pub(in crate::motion) fn beside(&mut self, rows: &[Row]) {
        let variables = self.kinematics.variables;
        for Row { coordinate: i, inertia, force } in rows {
            let own = variables.rate(*i);
            let Kinematics { bench, numbers, .. } = &mut self.kinematics;
            let force = numbers.import(bench, *force);
            self.push(own, force);
            for (j, entry) in inertia {
                let other = variables.rate(*j);
                let Kinematics { bench, numbers, .. } = &mut self.kinematics;
                let entry = numbers.import(bench, *entry);
                if i <= j {
                    self.add(own, other, entry);
                }
                let rate = self.kinematics.rate(other);
                let back = self.kinematics.numbers.mul(entry, rate);
                self.push(own, back.neg());
            }
        }
    }

    /// Takes everything back to the parameters, and solves: the rates of the declared parameters, what was divided by, and the equations
    /// at the root.
    pub(in crate::motion) fn solve(&mut self) -> Option<(Vec<Num>, Vec<Num>, Option<Root>)> {
        let bias = self.core_bias();
        let declared = std::mem::take(&mut self.declared);
        let declared: Vec<(Functional, Num)> = declared
            .into_iter()
            .map(|form| {
                let bias = self.kinematics.form_bias(&form);
                (form, bias)
            })
            .collect();
        let mut root: Option<Root> = None;
        let is_large = has_many_parameters(self.kinematics.system);
        // Of many parameters the matrix at the root has an entry for each pair; without it there is nothing to differentiate.
        let orders = match (is_large, self.kinematics.is_at_rest) {
            (true, _) => &ORDERS[2..],
            (_, true) => &ORDERS[..2],
            _ => &ORDERS[..],
        };
        let (rates, pivots) = self.cheapest(
            orders,
            |this, order| {
                let etas = this.reach_parameters(&bias, order)?;
                if order.parameters == Leaving::AtTheRoot {
                    let own = this.left_of(&etas);
                    if root.as_ref().is_none_or(|known| own.cost() < known.cost()) {
                        root = Some(own);
                    }
                }
                this.eliminated(&etas, &bias, &declared)
            },
            |numbers, (rates, _)| numbers.cost(rates),
        )?;
        Some((rates, pivots, root))
    }

    /// The mass matrix of the parameters and their forces, at the root.
    pub(in crate::motion) fn at_the_root(&mut self) -> Option<(Vec<Vec<Num>>, Vec<Num>)> {
        let bias = self.core_bias();
        let orders = ORDERS.iter().filter(|order| order.parameters == Leaving::AtTheRoot);
        let orders: Vec<Order> = orders.copied().collect();
        let root = self.cheapest(
            &orders,
            |this, order| {
                let etas = this.reach_parameters(&bias, order)?;
                Some(this.left_of(&etas))
            },
            |_, root| root.cost(),
        )?;
        Some((root.mass, root.forces))
    }

    /// The cheapest result of several orders, each in a numbering of its own: they have the same values, and a later one would
    /// find those of an earlier one.
    fn cheapest<T>(
        &mut self,
        orders: &[Order],
        mut result: impl FnMut(&mut Self, Order) -> Option<T>,
        cost: impl Fn(&Numbering, &T) -> usize,
    ) -> Option<T> {
        let (form, table) = (self.form.clone(), self.kinematics.numbers.clone());
        let mut best: Option<(usize, T, Numbering)> = None;
        for order in orders {
            self.form = form.clone();
            *self.kinematics.numbers = table.clone();
            let Some(found) = result(self, *order).filter(|_| self.kinematics.numbers.is_sound()) else {
                continue;
            };
            let own = cost(self.kinematics.numbers, &found);
            if best.as_ref().is_none_or(|(least, ..)| own < *least) {
                best = Some((own, found, self.kinematics.numbers.clone()));
            }
        }
        let (_, found, table) = best?;
        *self.kinematics.numbers = table;
        Some(found)
    }

    /// The form and the forces of some variables.
    fn left_of(&self, vars: &[Var]) -> Root {
        let row = |i: &Var| vars.iter().map(|j| self.form.entry(*i, *j)).collect();
        Root {
            table: self.kinematics.numbers.clone(),
            mass: vars.iter().map(row).collect(),
            forces: vars.iter().map(|i| self.form.force(*i)).collect(),
        }
    }

    /// Substitutes everything by the parameters, which it returns.
    fn reach_parameters(&mut self, bias: &[Num], order: Order) -> Option<Vec<Var>> {
        let (variables, plan) = (self.kinematics.variables, self.kinematics.plan);
        self.inwards(order, bias)?;
        for (index, var) in plan.unknowns.iter().enumerate().rev() {
            let solution = self.kinematics.core.solutions[index].clone();
            self.form.substitute(self.kinematics.numbers, *var, &solution, bias[index]);
        }
        let l = self.kinematics.system.forms.degrees;
        let etas: Vec<Var> = (0..l).map(|s| variables.eta(s)).collect();
        if !self.form.variables().iter().all(|var| etas.contains(var)) {
            return None;
        }
        if self.kinematics.is_at_rest {
            self.inertial_forces(&etas);
        }
        Some(etas)
    }

    /// The rates of the parameters that are left, by their own equations, and what was divided by; of the declared ones where the system is
    /// stated in others.
    fn eliminated(
        &mut self,
        etas: &[Var],
        bias: &[Num],
        declared: &[(Functional, Num)],
    ) -> Option<(Vec<Num>, Vec<Num>)> {
        let (variables, plan) = (self.kinematics.variables, self.kinematics.plan);
        let mut left: Vec<Var> = etas.iter().copied().filter(|var| !self.form.is_eliminated(*var)).collect();
        while !left.is_empty() {
            let numbers = &mut *self.kinematics.numbers;
            let next = left
                .iter()
                .enumerate()
                .min_by_key(|(place, var)| {
                    let own = self.form.entry(**var, **var);
                    (!numbers.is_constant(own), self.form.neighbours(**var), usize::MAX - place)
                })
                .map(|(place, _)| place)?;
            let var = left.remove(next);
            if self.form.entry(var, var).is_zero() {
                return None;
            }
            self.form.eliminate(numbers, var);
        }
        let (tree, core) = (self.kinematics.tree, self.kinematics.core);
        let mut known = BTreeMap::new();
        let found = self.form.solved(self.kinematics.numbers, |numbers, found, var| {
            let mut outwards = Outwards { tree, variables, plan, core, bias, found, known: &mut known };
            outwards.rate(numbers, var)
        });
        let mut rates: Vec<Num> =
            etas.iter().map(|var| found.get(var).copied().unwrap_or(Num::ZERO)).collect();
        if !declared.is_empty() {
            let numbers = &mut *self.kinematics.numbers;
            rates.clear();
            for (form, bias_of_form) in declared {
                let mut sum = *bias_of_form;
                for (var, c) in reduced(numbers, variables, &form.terms) {
                    let mut outwards =
                        Outwards { tree, variables, plan, core, bias, found: &found, known: &mut known };
                    let rate = outwards.rate(numbers, var);
                    let part = numbers.mul(c, rate);
                    sum = numbers.add(sum, part);
                }
                rates.push(sum);
            }
        }
        Some((rates, std::mem::take(&mut self.form.pivots)))
    }

    /// The rates of the core's unknowns at zero rates of the parameters.
    pub(in crate::motion) fn core_bias(&mut self) -> Vec<Num> {
        let plan = self.kinematics.plan;
        let mut right = Vec::new();
        for equation in &plan.core {
            right.push(match equation {
                Equation::Row(row) => {
                    let row = plan.rows[*row].clone();
                    self.kinematics.form_bias(&row)
                }
                Equation::Link(var) => self.kinematics.link_bias(*var, None).0,
            });
        }
        let core = self.kinematics.core;
        core.solve(self.kinematics.numbers, right)
    }

    /// Substitutes every velocity by those from which it follows, the youngest first; pairs are turned together.
    pub(in crate::motion) fn inwards(&mut self, when: Order, bias: &[Num]) -> Option<()> {
        let (tree, variables, plan) = (self.kinematics.tree, self.kinematics.variables, self.kinematics.plan);
        let roots = self.form.variables();
        let order = order(self.kinematics.numbers, tree, variables, plan, &roots);
        // How many of those that are left follow from each.
        let mut users: BTreeMap<Var, usize> = BTreeMap::new();
        let mut definitions: BTreeMap<Var, (Vec<(Var, Num)>, Num)> = BTreeMap::new();
        for var in &order {
            let found = match plan.def(*var) {
                // An unknown leaves as soon as nothing follows from it.
                Some(Def::Core(index)) if when.parameters == Leaving::OnTheWay => {
                    Some((self.kinematics.core.solutions[index].clone(), bias[index]))
                }
                Some(Def::Core(_)) => None,
                _ => {
                    let found = definition(self.kinematics.numbers, tree, variables, plan, *var);
                    found.map(|(terms, _)| (terms, Num::ZERO))
                }
            };
            if let Some(found) = found {
                found.0.iter().for_each(|(other, _)| *users.entry(*other).or_default() += 1);
                definitions.insert(*var, found);
            } else if !matches!(plan.def(*var), Some(Def::Known | Def::Core(_))) {
                return None;
            }
        }
        let etas: Vec<Var> = (0..self.kinematics.system.forms.degrees).map(|s| variables.eta(s)).collect();
        let mut left: Vec<Var> = order.iter().copied().filter(|var| definitions.contains_key(var)).collect();
        while !left.is_empty() {
            if when.parameters == Leaving::OnTheWay {
                self.eliminate_free(&etas, &users);
            }
            let is_ready = |var: &Var| users.get(var).copied().unwrap_or(0) == 0;
            let is_plain = |var: &Var| is_ready(var) && self.pair(*var, &left).is_none();
            // What is a sum of others costs nothing at any time.
            let is_first =
                |var: &Var| when.shifts_first || definitions[var].0.iter().all(|(_, c)| c.abs() == Num::ONE);
            let age = |place: &usize| (self.general_axes(left[*place]), *place);
            let youngest =
                |is: &dyn Fn(&Var) -> bool| (0..left.len()).filter(|place| is(&left[*place])).max_by_key(age);
            let mut next = youngest(&|var| is_plain(var) && is_first(var));
            let mut pairs = Vec::new();
            if next.is_none() {
                let (ready, in_use) = self.youngest_pairs(&left, is_ready);
                next = if in_use || ready.is_empty() { youngest(&is_plain) } else { None };
                pairs = ready;
            }
            if next.is_none() && pairs.is_empty() {
                // A pair one of which is still in use: each by itself.
                next = Some(left.iter().rposition(is_ready)?);
            }
            let mut gone: Vec<Var> = Vec::new();
            match (next, pairs.first()) {
                (None, Some((axes, _))) => {
                    let Turn::About { cosine, sine, .. } = tree.axes[*axes].turn else { return None };
                    let pairs: Vec<[Var; 4]> = pairs.into_iter().map(|(_, pair)| pair).collect();
                    self.form.turn(self.kinematics.numbers, variables, &pairs, (cosine, sine));
                    gone.extend(pairs.iter().flat_map(|[x, y, ..]| [*x, *y]));
                }
                (next, _) => {
                    let var = left[next?];
                    let (terms, bias) = definitions[&var].clone();
                    self.form.substitute(self.kinematics.numbers, var, &terms, bias);
                    gone.push(var);
                }
            }
            left.retain(|var| !gone.contains(var));
            for var in gone {
                for (other, _) in &definitions[&var].0 {
                    *users.get_mut(other)? -= 1;
                }
            }
        }
        Some(())
    }

    /// The axes in which a velocity is, in a tree whose general axes hang on neighbours: of these no pairs are turned, and what belongs to
    /// the youngest leaves first.
    fn general_axes(&self, var: Var) -> usize {
        let (tree, variables) = (self.kinematics.tree, self.kinematics.variables);
        match variables.kind(var) {
            _ if !tree.has_neighbours() => 0,
            Kind::Spin(axes, _) => axes,
            Kind::Velocity(point, _) => tree.points[point].axes,
            Kind::Before(point, _) => tree.points[tree.points[point].parent].axes,
            Kind::Eta(_) | Kind::Rate(_) => 0,
        }
    }

    /// The pairs of the youngest axes that nothing uses, and whether others of these axes are still in use.
    fn youngest_pairs(
        &self,
        left: &[Var],
        is_ready: impl Fn(&Var) -> bool,
    ) -> (Vec<(usize, [Var; 4])>, bool) {
        let found = left.iter().filter_map(|var| self.pair(*var, left).filter(|(_, pair)| pair[0] == *var));
        let found = found.map(|pair| (is_ready(&pair.1[0]) && is_ready(&pair.1[1]), pair));
        let mut found: Vec<(bool, (usize, [Var; 4]))> = found.collect();
        let youngest = found.iter().filter(|(ready, _)| *ready).map(|(_, (axes, _))| *axes).max();
        found.retain(|(_, (axes, _))| Some(*axes) == youngest);
        let in_use = found.iter().any(|(ready, _)| !ready);
        (found.into_iter().filter(|(ready, _)| *ready).map(|(_, pair)| pair).collect(), in_use)
    }

    /// Eliminates the parameters from which nothing follows that is left.
    fn eliminate_free(&mut self, order: &[Var], users: &BTreeMap<Var, usize>) {
        for var in order {
            let is_free = self.kinematics.plan.def(*var) == Some(Def::Known)
                && users.get(var).copied().unwrap_or(0) == 0
                && !self.form.entry(*var, *var).is_zero();
            if is_free {
                self.form.eliminate(self.kinematics.numbers, *var);
            }
        }
    }

    /// The pair of which a variable is one, if both are turned and nothing else: axes, and `x, y, X, Y`.
    fn pair(&self, var: Var, left: &[Var]) -> Option<(usize, [Var; 4])> {
        let (tree, variables, plan) = (self.kinematics.tree, self.kinematics.variables, self.kinematics.plan);
        let is_own = |var: Var| {
            matches!(variables.class(var), Class::Of(own, _) if own == var)
                && plan.def(var) == Some(Def::Kinematic)
                && left.contains(&var)
        };
        let (axes, make): (usize, &dyn Fn(usize) -> (Var, Var)) = match variables.kind(var) {
            Kind::Spin(axes, _) => {
                let parent = tree.axes[axes].parent;
                (axes, &move |q| (variables.spin(axes, q), variables.spin(parent, q)))
            }
            Kind::Velocity(point, _) => {
                let node = &tree.points[point];
                if node.axes == tree.points[node.parent].axes {
                    return None;
                }
                (node.axes, &move |q| (variables.velocity(point, q), variables.before(point, q)))
            }
            _ => return None,
        };
        let Turn::About { axis, .. } = tree.axes[axes].turn else { return None };
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let ((x, wx), (y, wy)) = (make(i), make(j));
        (is_own(x) && is_own(y) && (var == x || var == y)).then_some((axes, [x, y, wx, wy]))
    }
}

/// Whether a system has no constraints and more parameters than a mass matrix is written out for.
fn has_many_parameters(system: &Mechanics) -> bool {
    let forms = &system.forms;
    forms.degrees > WRITTEN_OUT_PARAMETERS && forms.len() == forms.degrees
}
