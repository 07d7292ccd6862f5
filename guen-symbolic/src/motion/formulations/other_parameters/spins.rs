//! Accelerations by the spins of bodies, where the parameters, or their mass matrix, have an edge that the spins have not.
//!
//! With the rates of three entries of a quaternion as parameters, `w = 0` is an edge. Next to it the fourth rate, and with it the
//! spins, are large, like `1/w`; in the declared parameters the mass matrix is as `1/w^2` and forces are as `1/w^3`, and what is
//! left of them is as `1/w^2`. With the rates of angles the mass matrix is singular at their pole. The equations in spins
//! `sigma = S(t, x) x'` know of neither. So the rates of the spins are found there, and turned back by the parameters
//! `eta = A(t, x) x'` and the rows `C x'` of the constraints:
//!
//! ```text
//! eta' = A x'' + A' x',   x'' = (S, C)^-1 (sigma' - S' x', -C' x')
//! ```
//!
//! For a quaternion this divides by nothing, `S' x'` is zero, and `C' x' = 2 |q'|^2`; for angles it divides once by what vanishes at
//! their pole. Terms of the forms without velocities are left out here.

use super::restated::{self, Restated, over};
use crate::algebra::{ExprId, Flow, Role, Substitution};
use crate::geometry::{Form, Operators};
use crate::motion::coordinates::constancy::rests;
use crate::motion::coordinates::restriction::{self, Restriction};
use crate::motion::formulations::body_axes;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::{Frame, Mechanics};
use crate::workbench::Workbench;

/// The rates of the state, one list for each set of equations; none where spins have the same edges as the parameters, or no body
/// turns freely.
pub(in crate::motion) fn rates(
    bench: &mut Workbench,
    declared: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
) -> Option<Vec<Vec<ExprId>>> {
    let change = Change::new(bench, declared, partials)?;
    let system = change.system(bench, declared);
    let operators = Operators::new(bench, &system.forms).ok()?;
    let [own, others] =
        [&operators, &frame.operators].map(|operators| edges(bench, declared, frame, operators));
    let is_known = |pivot: &ExprId| frame.operators.constant_pivots.contains(pivot);
    let is_same = own.len() == others.len() && own.iter().all(|edge| is_among(bench, *edge, &others));
    if is_same || !operators.constant_pivots.iter().all(is_known) {
        return None;
    }
    let mut restated = Restated::new(bench, system, operators)?;
    let Restated { system, frame: by_spins, forces, projected } = &mut restated;
    let turned = body_axes::in_any_chart(bench, system, by_spins, &projected.forms)?;
    // Where it divides by an edge of the spins, a mass matrix in other parameters may be regular there.
    let divisors = bench.graph.divisors(&turned.equations.mass.concat());
    if divisors.into_iter().any(|divisor| is_among(bench, divisor, &own)) {
        return None;
    }
    let lists = turned.rates(bench, system, forces, true);
    let (system, operators) = (&restated.system, &restated.frame.operators);
    let back = |rates| change.turned_back(bench, declared, frame, (system, operators), rates);
    Some(lists.into_iter().map(back).collect())
}

/// Whether a body turns freely whose spins are not among the parameters: it may have no edge where these have one.
pub(in crate::motion) fn are_others(
    bench: &mut Workbench,
    system: &Mechanics,
    partials: &mut VelocityPartials,
) -> bool {
    Change::new(bench, system, partials).is_some()
}

/// The functions that must not vanish, without those that are constant wherever the constraints on positions hold.
fn edges(bench: &mut Workbench, declared: &Mechanics, frame: &Frame, operators: &Operators) -> Vec<ExprId> {
    let mut restriction = Restriction::new(bench, declared);
    let mut edges = operators.chart.clone();
    edges.retain(|edge| declared.holonomic.is_empty() || !rests(bench, declared, frame, *edge));
    edges.into_iter().map(|edge| restriction.tidy(bench, edge)).collect()
}

/// Whether a function is a constant multiple of one of these.
fn is_among(bench: &mut Workbench, e: ExprId, others: &[ExprId]) -> bool {
    others.iter().any(|other| {
        let quotient = bench.graph.div(e, *other);
        let quotient = bench.tidy(quotient);
        bench.graph.roles(quotient).is_constant()
    })
}

/// The place of a declared parameter in the system of spins.
enum Parameter {
    /// A declared parameter that stays.
    Kept(usize),
    Spin(Form),
}

struct Change {
    parameters: Vec<Parameter>,
    symbols: Vec<ExprId>,
}

impl Change {
    /// The spins of all bodies that turn freely; declared parameters beside them. None where these are all.
    fn new(bench: &mut Workbench, system: &Mechanics, partials: &mut VelocityPartials) -> Option<Self> {
        let l = system.forms.degrees;
        let mut rows: Vec<Vec<ExprId>> =
            system.forms.forms[l..].iter().map(|form| form.row.clone()).collect();
        let mut joins = |bench: &mut Workbench, more: &[Form]| {
            let count = rows.len();
            rows.extend(more.iter().map(|form| form.row.clone()));
            let is_independent = bench.zero.rank(&mut bench.graph, &rows, true) == Some(rows.len());
            if !is_independent {
                rows.truncate(count);
            }
            is_independent
        };
        let mut parameters = Vec::new();
        let (mut free, mut bound): (Vec<Vec<ExprId>>, Vec<Vec<ExprId>>) = Default::default();
        for Turning { by, spin } in turning(bench, system, partials)? {
            if free.contains(&by) {
                continue;
            }
            // In a gimbal that has inertia itself the spins of what it carries have edges that the equations have not.
            let hangs = bound.iter().any(|other| other.iter().all(|x| by.contains(x)));
            match spin {
                Some(spin) if !hangs && joins(bench, &spin) => {
                    parameters.extend(spin.map(Parameter::Spin));
                    free.push(by);
                }
                _ => bound.push(by),
            }
        }
        for s in 0..l {
            if joins(bench, std::slice::from_ref(&system.forms.forms[s])) {
                parameters.push(Parameter::Kept(s));
            }
        }
        if parameters.len() != l
            || !parameters.iter().any(|parameter| matches!(parameter, Parameter::Spin(_)))
        {
            return None;
        }
        let symbols = parameters.iter().enumerate().map(|(k, parameter)| match parameter {
            Parameter::Kept(s) => system.etas[*s],
            Parameter::Spin(_) => bench.graph.symbol(&format!("sigma{}", k + 1), Role::QuasiVelocity),
        });
        let symbols = symbols.collect();
        Some(Change { parameters, symbols })
    }

    /// The system in the other parameters.
    fn system(&self, bench: &mut Workbench, declared: &Mechanics) -> Mechanics {
        let parameters = self.parameters.iter().zip(&self.symbols).map(|(parameter, symbol)| {
            let form = match parameter {
                Parameter::Kept(s) => &declared.forms.forms[*s],
                Parameter::Spin(form) => form,
            };
            restated::Parameter { symbol: *symbol, form: form.clone(), shape: None }
        });
        restated::in_parameters(bench, declared, parameters.collect())
    }

    /// Rates in the other parameters, turned back.
    fn turned_back(
        &self,
        bench: &mut Workbench,
        declared: &Mechanics,
        frame: &Frame,
        (system, operators): (&Mechanics, &Operators),
        rates: Vec<ExprId>,
    ) -> Vec<ExprId> {
        let forms = &declared.forms;
        let (n, l) = (forms.len(), forms.degrees);
        let (velocities, accelerations) = rates.split_at(n);
        // The rates that spins are made of are known as declared; others are shorter by spins.
        let is_of_spins = |i: usize| {
            self.parameters.iter().any(|parameter| match parameter {
                Parameter::Spin(form) => !bench.graph.is_zero(form.row[i]),
                Parameter::Kept(_) => false,
            })
        };
        let given: Vec<bool> = (0..n).map(is_of_spins).collect();
        let as_declared: Vec<ExprId> = frame.velocities.iter().map(|v| bench.graph.keep(*v)).collect();
        let mut images = Vec::new();
        for (parameter, symbol) in self.parameters.iter().zip(&self.symbols) {
            if let Parameter::Spin(form) = parameter {
                let spin = over(bench, form, &as_declared);
                images.push((*symbol, bench.graph.keep(spin)));
            }
        }
        let mut by_declared = Substitution::new(images);
        let mixed: Vec<ExprId> = (0..n)
            .map(|i| if given[i] { as_declared[i] } else { by_declared.of(&mut bench.graph, velocities[i]) })
            .collect();
        let moving = if restriction::stay(bench, declared, &mixed) { mixed } else { as_declared };

        let known: Vec<ExprId> = accelerations
            .iter()
            .map(|e| {
                let e = by_declared.of(&mut bench.graph, *e);
                bench.graph.keep(e)
            })
            .collect();
        let coordinates = forms.coordinates.iter().copied().zip(moving.iter().copied());
        let mut motion = Flow::new(&bench.graph, coordinates.chain([(forms.time, bench.graph.one())]));
        // What a form's rate has beside the accelerations: a' x' + a_0'.
        let mut bias = |bench: &mut Workbench, form: &Form| {
            let slopes: Vec<ExprId> = form.row.iter().map(|e| motion.of(&mut bench.graph, *e)).collect();
            let offset = motion.of(&mut bench.graph, form.offset);
            let linear = bench.dot(&slopes, &moving);
            bench.graph.add(linear, offset)
        };
        let mut restriction = Restriction::new(bench, declared);
        let mut back = Vec::with_capacity(l);
        for s in 0..l {
            let kept = |parameter: &Parameter| matches!(parameter, Parameter::Kept(k) if *k == s);
            if let Some(k) = self.parameters.iter().position(kept) {
                back.push(known[k]);
                continue;
            }
            let mut terms = vec![bias(bench, &forms.forms[s])];
            for (j, form) in system.forms.forms.iter().enumerate() {
                let along = bench.dot(&forms.forms[s].row, &operators.xi[j + 1]);
                let along = restriction.tidy(bench, along);
                if bench.graph.is_zero(along) {
                    continue;
                }
                let bias = bias(bench, form);
                let bias = bench.graph.keep(bias);
                let rate = match known.get(j) {
                    Some(rate) => bench.graph.sub(*rate, bias),
                    None => bench.graph.neg(bias),
                };
                terms.push(bench.graph.mul(along, rate));
            }
            back.push(bench.graph.sum(terms));
        }
        moving.into_iter().chain(back).collect()
    }
}

/// A body that turns.
struct Turning {
    /// The coordinates that its orientation depends on.
    by: Vec<ExprId>,
    /// The angular velocity in its own axes; none where these coordinates are too few for it to turn freely.
    spin: Option<[Form; 3]>,
}

/// The bodies that turn, those by few coordinates first; `None` where an angular velocity is no form.
fn turning(
    bench: &mut Workbench,
    system: &Mechanics,
    partials: &mut VelocityPartials,
) -> Option<Vec<Turning>> {
    let mut found: Vec<Turning> = Vec::new();
    for body in &system.multibody.as_ref()?.bodies {
        let Some(rows) = &body.orientation else { continue };
        let occurring = bench.graph.symbols_in(rows.as_flattened());
        let mut by = system.forms.coordinates.clone();
        by.retain(|x| bench.graph.as_symbol(*x).is_some_and(|symbol| occurring.contains(&symbol)));
        if by.len() < 3 {
            // What moves by itself, or not at all, carries nothing.
            if !by.is_empty() {
                found.push(Turning { by, spin: None });
            }
            continue;
        }
        let components = match body.spin {
            Some(spin) => spin,
            None => body_axes::spin(bench, system, rows),
        };
        let [x, y, z] = components.map(|component| {
            let form = partials.affine(bench, component)?;
            let mut row = vec![bench.graph.zero(); system.forms.len()];
            form.on_velocities.iter().for_each(|(i, e)| row[*i] = *e);
            form.on_etas.is_empty().then_some(Form { row, offset: form.offset })
        });
        found.push(Turning { by, spin: Some([x?, y?, z?]) });
    }
    found.sort_by_key(|body| body.by.len());
    Some(found)
}
