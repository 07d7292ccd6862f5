//! Plans the velocities: kinematics outwards, constraints where they are met, and the rest as a small core.
//!
//! A rate that nothing determines on the way from the root to the leaves is taken as an unknown; what is then left of the
//! forms determines all of these. For a train each axle determines the turn of its own link and nothing is left; for a
//! bicycle the contact of the front wheel determines yaw, pitch and the turn of the wheel.

use super::safety::is_safe;
use crate::algebra::FastMap;
use crate::geometry::Form;
use crate::motion::formulations::multibody::places::tree::{RateForm, Tree, Turn};
use crate::motion::formulations::multibody::velocities::declared::Group;
use crate::motion::formulations::multibody::velocities::definitions::{Def, Equation, Plan};
use crate::motion::formulations::multibody::velocities::forms::Functional;
use crate::motion::formulations::multibody::velocities::relations::{
    Linear, back, link, raw_kinematic, reduced, solved, turned_components,
};
use crate::motion::formulations::multibody::velocities::variables::{Class, Kind, Var, Variables};
use crate::numbering::{Num, Numbering};
use crate::workbench::Workbench;
use crate::zero::field;

/// The context in which a plan is made.
pub(in crate::motion) struct Planner<'a> {
    pub(in crate::motion) bench: &'a mut Workbench,
    pub(in crate::motion) numbers: &'a mut Numbering,
    pub(in crate::motion) tree: &'a Tree,
    pub(in crate::motion) variables: &'a Variables,
    /// The forms of the system, dependent where no rates are.
    pub(in crate::motion) forms: &'a [Form],
    /// Divisors that were looked at, and whether they are safe.
    pub(in crate::motion) known: FastMap<Num, bool>,
}

/// The equations that a core may have.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Equations {
    /// Forms, the kinematics of vanishing velocities, and that of velocities that forms determine.
    OfForms,
    /// The kinematics of all velocities that are not defined by it, too.
    Further,
    /// The same, with all velocities from which vanishing ones follow among the unknowns.
    OfAllSources,
}

/// A way to plan.
#[derive(Clone, Copy)]
struct Way {
    /// Whether the kinematics of vanishing velocities may define others on the way to the leaves; else they are equations of the core alone.
    on_the_way: bool,
    core: Equations,
}

impl Planner<'_> {
    /// A plan for what is needed; `None` where forms and unknowns do not fit.
    pub(in crate::motion) fn plan(
        &mut self,
        rows: Vec<Functional>,
        groups: &[Group],
        needed: &[Var],
    ) -> Option<Plan> {
        let links = self.links();
        // The kinematics of vanishing velocities may be missing in the core if they define others on the way. A velocity that is turned back has
        // kinematics of its own, which a core may need. And a vanishing velocity may follow from more than is needed: a plate that three legs
        // carry is part of one of them.
        let ways = [(true, Equations::OfForms), (false, Equations::OfForms)].into_iter().chain([
            (true, Equations::Further),
            (false, Equations::Further),
            (true, Equations::OfAllSources),
        ]);
        let mut ways = ways.map(|(on_the_way, core)| Way { on_the_way, core });
        ways.find_map(|way| self.planned(rows.clone(), groups, needed, (&links, way)))
    }

    fn planned(
        &mut self,
        rows: Vec<Functional>,
        groups: &[Group],
        needed: &[Var],
        (links, way): (&[(Var, Linear)], Way),
    ) -> Option<Plan> {
        let used = vec![false; rows.len()];
        let mut plan = Plan {
            defs: vec![None; self.variables.len()],
            rows,
            core: Vec::new(),
            unknowns: Vec::new(),
            used,
        };
        for index in 0..self.variables.len() {
            let var = Var(index as u32);
            if matches!(self.variables.kind(var), Kind::Eta(_)) {
                plan.defs[index] = Some(Def::Known);
            }
        }
        let wanted: Vec<Var> = needed.iter().filter_map(|var| self.representative(*var)).collect();
        let terms = plan.rows.iter().flat_map(|row| &row.terms);
        let spoken: Vec<Var> = terms.filter_map(|(var, _)| self.representative(*var)).collect();
        let (used, further) = if way.on_the_way { (links, &[][..]) } else { (&[][..], links) };
        let further = further.iter().flat_map(|(_, terms)| terms).map(|(var, _)| var);
        let all = self.closure(wanted.iter().chain(&spoken).chain(further).copied().collect());
        self.advance(&mut plan, &all, used, true);
        // What is still open becomes an unknown, from the root on; then all forms that are left determine them.
        while let Some(var) = self.next_unknown(&plan, &wanted) {
            plan.defs[var.0 as usize] = Some(Def::Core(plan.unknowns.len()));
            plan.unknowns.push(var);
            self.advance(&mut plan, &all, used, false);
        }
        loop {
            let mut trial = plan.clone();
            self.turn_directions(&mut trial, groups);
            if self.choose_core(&mut trial, links, way.core).is_some() {
                self.finish(&mut trial, used);
                return Some(trial);
            }
            // The forms speak of more than is needed.
            let sources =
                links.iter().filter(|_| way.core == Equations::OfAllSources).flat_map(|(_, terms)| terms);
            let sources = self.closure(sources.map(|(var, _)| *var).collect());
            let further: Vec<Var> = spoken.iter().chain(&sources).copied().collect();
            let var = self.next_unknown(&plan, &further)?;
            plan.defs[var.0 as usize] = Some(Def::Core(plan.unknowns.len()));
            plan.unknowns.push(var);
            self.advance(&mut plan, &all, used, false);
        }
    }

    /// The next unknown: the rate of the first joint that something open follows from; where there is none, a component of
    /// a velocity itself.
    fn next_unknown(&mut self, plan: &Plan, wanted: &[Var]) -> Option<Var> {
        let open: Vec<Var> = wanted.iter().copied().filter(|var| plan.def(*var).is_none()).collect();
        let first = open.iter().min()?;
        let sources = self.closure(open.clone());
        for axes in self.tree.axes.iter() {
            let forms: &[RateForm] = match &axes.turn {
                Turn::World => &[],
                Turn::About { rate, .. } => core::slice::from_ref(rate),
                Turn::By { spin, .. } => spin,
            };
            for (i, _) in forms.iter().flat_map(|form| &form.terms) {
                if let Some(var) = self.representative(self.variables.rate(*i))
                    && sources.contains(&var)
                    && plan.def(var).is_none()
                {
                    return Some(var);
                }
            }
        }
        Some(*first)
    }

    /// The rates of coordinates that nothing needs, where they follow.
    fn finish(&mut self, plan: &mut Plan, links: &[(Var, Linear)]) {
        let all: Vec<Var> = (0..self.variables.len()).map(|index| Var(index as u32)).collect();
        let all: Vec<Var> = all.into_iter().filter(|var| self.representative(*var) == Some(*var)).collect();
        self.advance(plan, &all, links, true);
    }

    fn representative(&self, var: Var) -> Option<Var> {
        match self.variables.class(var) {
            Class::Zero => None,
            Class::Of(representative, _) => Some(representative),
        }
    }

    /// Returns all variables that some variables follow from, outwards, in the order of the list.
    fn closure(&mut self, mut stack: Vec<Var>) -> Vec<Var> {
        let mut seen = vec![false; self.variables.len()];
        while let Some(var) = stack.pop() {
            if std::mem::replace(&mut seen[var.0 as usize], true) {
                continue;
            }
            if let Some((terms, _)) = self.kinematic(var) {
                stack.extend(terms.into_iter().map(|(var, _)| var));
            }
        }
        (0..seen.len()).filter(|index| seen[*index]).map(|index| Var(index as u32)).collect()
    }

    /// A variable by those from which it is one step outwards.
    pub(super) fn kinematic(&mut self, var: Var) -> Option<(Linear, Num)> {
        let (terms, offset) = raw_kinematic(self.tree, self.variables, var)?;
        Some((self.reduced(&terms), offset))
    }

    /// A combination over the variables that stand for their classes.
    pub(super) fn reduced(&mut self, terms: &[(Var, Num)]) -> Linear {
        reduced(self.numbers, self.variables, terms)
    }

    /// Determines what follows without an unknown of the core.
    fn advance(&mut self, plan: &mut Plan, wanted: &[Var], links: &[(Var, Linear)], by_rows: bool) {
        loop {
            let mut progress = false;
            for var in wanted {
                if plan.def(*var).is_some() {
                    continue;
                }
                if let Some((terms, _)) = self.kinematic(*var)
                    && terms.iter().all(|(var, _)| plan.def(*var).is_some())
                {
                    plan.defs[var.0 as usize] = Some(Def::Kinematic);
                    progress = true;
                }
            }
            if progress {
                continue;
            }
            for index in 0..plan.rows.len() {
                if plan.used[index] || !by_rows {
                    continue;
                }
                let terms = plan.rows[index].terms.clone();
                let terms = self.reduced(&terms);
                let open: Vec<&(Var, Num)> =
                    terms.iter().filter(|(var, _)| plan.def(*var).is_none()).collect();
                if let [(var, pivot)] = open[..]
                    && self.is_safe(*pivot)
                {
                    plan.defs[var.0 as usize] = Some(Def::Row(index));
                    plan.used[index] = true;
                    progress = true;
                    break;
                }
            }
            if progress {
                continue;
            }
            for (var, terms) in links {
                let open: Vec<&(Var, Num)> =
                    terms.iter().filter(|(var, _)| plan.def(*var).is_none()).collect();
                if let [(other, pivot)] = open[..]
                    && self.is_safe(*pivot)
                {
                    plan.defs[other.0 as usize] = Some(Def::Link(*var));
                    progress = true;
                    break;
                }
            }
            if !progress && !self.turn_back(plan) {
                return;
            }
        }
    }

    /// Determines pairs, or all three, of components that are turned into known ones.
    fn turn_back(&self, plan: &mut Plan) -> bool {
        for index in 0..self.variables.len() {
            let first = Var(index as u32);
            let Some((images, sources)) = turned_components(self.tree, self.variables, first) else {
                continue;
            };
            if images[0] != first {
                continue;
            }
            let is_known = |var: &Var| self.representative(*var).is_none_or(|var| plan.def(var).is_some());
            let open: Vec<Var> = sources.iter().filter_map(|var| self.representative(*var)).collect();
            let is_open =
                |(place, var): (usize, &Var)| plan.def(*var).is_none() && !open[..place].contains(var);
            if images.iter().all(is_known)
                && open.len() == sources.len()
                && open.iter().enumerate().all(is_open)
            {
                for (image, source) in images.iter().zip(open) {
                    plan.defs[source.0 as usize] = Some(Def::Back(*image));
                }
                return true;
            }
        }
        false
    }

    /// Returns an equation for each velocity that vanishes or is a multiple of another one: its kinematics.
    fn links(&mut self) -> Vec<(Var, Linear)> {
        let mut found = Vec::new();
        for index in 0..self.variables.len() {
            let var = Var(index as u32);
            if self.variables.class(var) == Class::Of(var, Num::ONE) {
                continue;
            }
            // The forms that speak of it say the same.
            if let Kind::Before(point, _) | Kind::Velocity(point, _) = self.variables.kind(var)
                && self.tree.is_end(point)
            {
                continue;
            }
            if let Some((terms, _)) = link(self.numbers, self.tree, self.variables, var)
                && !terms.is_empty()
            {
                found.push((var, terms));
            }
        }
        found
    }

    /// Returns the kinematics of the velocities that forms determine, or that follow from others: equations that nothing has used.
    fn determined_otherwise(&mut self, plan: &Plan, of: Equations) -> Vec<(Equation, Linear)> {
        let mut found = Vec::new();
        for index in 0..self.variables.len() {
            let var = Var(index as u32);
            // The kinematics of spins is not used: they are made of rates of angles, which are large next to poles.
            let is_straight = matches!(self.variables.kind(var), Kind::Before(..) | Kind::Velocity(..));
            let is_open = match plan.def(var) {
                None | Some(Def::Known | Def::Kinematic) => false,
                Some(Def::Row(_)) => true,
                Some(Def::Link(_) | Def::Back(_) | Def::Core(_)) => is_straight && of != Equations::OfForms,
            };
            if is_open && let Some((terms, _)) = link(self.numbers, self.tree, self.variables, var) {
                found.push((Equation::Link(var), terms));
            }
        }
        found
    }

    /// Whether a divisor does not vanish at the rest position, nor elsewhere for all that is seen.
    pub(super) fn is_safe(&mut self, pivot: Num) -> bool {
        if self.numbers.is_constant(pivot) {
            return true;
        }
        let Planner { bench, numbers, known, forms, .. } = self;
        *known.or_insert_with(pivot, || is_safe(bench, numbers, forms, pivot))
    }

    /// The vector of a variable over parameters and unknowns of the core, modulo the prime.
    fn expanded(&mut self, plan: &Plan, var: Var, known: &mut Vec<Option<Vec<u64>>>) -> Vec<u64> {
        let (etas, unknowns) = (self.variables.columns[0].len() - 1, plan.unknowns.len());
        if let Some(known) = &known[var.0 as usize] {
            return known.clone();
        }
        let mut vector = vec![0; etas + unknowns];
        let terms = match plan.def(var) {
            Some(Def::Known) => {
                vector[var.0 as usize] = 1;
                Vec::new()
            }
            Some(Def::Core(index)) => {
                vector[etas + index] = 1;
                Vec::new()
            }
            Some(Def::Row(row)) => self.solved(plan, row, var),
            Some(Def::Link(other)) => {
                let terms = link(self.numbers, self.tree, self.variables, other);
                terms.map_or_else(Linear::new, |(terms, _)| solved(self.numbers, terms, var))
            }
            Some(Def::Back(image)) => {
                back(self.numbers, self.tree, self.variables, image).unwrap_or_default()
            }
            Some(Def::Kinematic) | None => self.kinematic(var).map_or_else(Vec::new, |(terms, _)| terms),
        };
        for (other, c) in terms {
            let other = self.expanded(plan, other, known);
            let c = self.numbers.residue(c);
            for (entry, other) in vector.iter_mut().zip(other) {
                *entry = field::add(*entry, field::mul(c, other));
            }
        }
        known[var.0 as usize] = Some(vector.clone());
        vector
    }

    /// A form solved for a variable.
    pub(super) fn solved(&mut self, plan: &Plan, row: usize, var: Var) -> Linear {
        let terms = plan.rows[row].terms.clone();
        let terms = self.reduced(&terms);
        solved(self.numbers, terms, var)
    }

    pub(super) fn expanded_terms(
        &mut self,
        plan: &Plan,
        terms: &Linear,
        known: &mut Vec<Option<Vec<u64>>>,
    ) -> Vec<u64> {
        let (etas, unknowns) = (self.variables.columns[0].len() - 1, plan.unknowns.len());
        let mut vector = vec![0; etas + unknowns];
        for (var, c) in terms.iter().copied() {
            let other = self.expanded(plan, var, known);
            let c = self.numbers.residue(c);
            for (entry, other) in vector.iter_mut().zip(other) {
                *entry = field::add(*entry, field::mul(c, other));
            }
        }
        vector
    }

    /// Chooses as many equations as there are unknowns, which determine them: forms first, short ones before long
    /// ones.
    fn choose_core(&mut self, plan: &mut Plan, links: &[(Var, Linear)], of: Equations) -> Option<()> {
        let etas = self.variables.columns[0].len() - 1;
        let mut known = vec![None; self.variables.len()];
        let mut equations: Vec<(Equation, Linear)> = Vec::new();
        for index in 0..plan.rows.len() {
            if !plan.used[index] {
                let terms = plan.rows[index].terms.clone();
                equations.push((Equation::Row(index), self.reduced(&terms)));
            }
        }
        equations.extend(links.iter().map(|(var, terms)| (Equation::Link(*var), terms.clone())));
        equations.extend(self.determined_otherwise(plan, of));
        let mut list: Vec<(bool, usize, Equation, Vec<u64>)> = Vec::new();
        for (equation, terms) in equations {
            if terms.iter().any(|(var, _)| plan.def(*var).is_none()) {
                continue;
            }
            let vector = self.expanded_terms(plan, &terms, &mut known);
            let count = vector.iter().filter(|entry| **entry != 0).count();
            if vector[etas..].iter().any(|entry| *entry != 0) {
                let is_link = matches!(equation, Equation::Link(_));
                list.push((is_link, count, equation, vector[etas..].to_vec()));
            }
        }
        list.sort_unstable();
        let mut vectors: Vec<Vec<u64>> = Vec::new();
        for (.., equation, vector) in list {
            let mut trial = vectors.clone();
            trial.push(vector);
            if field::rank(&trial) == trial.len() {
                vectors = trial;
                plan.core.push(equation);
                if let Equation::Row(index) = equation {
                    plan.used[index] = true;
                }
            }
        }
        (plan.core.len() == plan.unknowns.len()).then_some(())
    }
}

impl Plan {
    pub(in crate::motion) fn def(&self, var: Var) -> Option<Def> {
        self.defs[var.0 as usize]
    }
}
