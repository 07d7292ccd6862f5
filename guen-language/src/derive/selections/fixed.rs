//! The system at the values that a scene fixes: derived anew, or refused at the word.

use guen_symbolic::{Derivation, DerivationError, ExprId, Mechanics, Node, Substitution, Workbench};

use super::selection::{Held, StateIndex, StatePart};
use crate::derive::faults::short;
use crate::diagnostics::{Fault, Faults};
use crate::model::{Contacts, FixedConstant, Model, SceneEntry};
use crate::syntax::Name;

/// The reason why fixed values cannot be.
enum Trouble {
    Forms,
    Inertia,
    Division,
}

impl Trouble {
    fn text(&self) -> &'static str {
        match self {
            Trouble::Forms => "makes the forms linearly dependent",
            Trouble::Inertia => "leaves a parameter without inertia",
            Trouble::Division => "makes the system divide by zero",
        }
    }
}

/// Derives the system with constants at their values. A system that becomes singular is reported at the constant.
pub(in crate::derive) fn derivation(
    model: &mut Model<'_>,
    whole: &Derivation,
    scene: &SceneEntry<'_>,
    faults: &mut Faults,
) -> Option<Derivation> {
    let values: Vec<(ExprId, ExprId)> = scene.fixes.iter().map(|fix| (fix.symbol, fix.value)).collect();
    let singular = |fix: &FixedConstant<'_>, trouble: &Trouble| {
        Fault::new(fix.name.span(), format!("fixing `{}` at this value {}", fix.name, trouble.text()))
            .note("the scene would have no equations of motion")
    };
    if let Some((fix, trouble)) = culprit(model, whole, &scene.fixes) {
        faults.report(singular(fix, &trouble));
        return None;
    }
    let bench = &mut model.bench;
    bench.begin_another();
    let mechanics = at_values(bench, &whole.system, whole, &values);
    let name = &scene.scene.name;
    match Derivation::new(bench, mechanics) {
        Ok(derivation) => return Some(derivation),
        Err(DerivationError::SingularForms(_)) => {
            scene.fixes.last().map(|fix| faults.report(singular(fix, &Trouble::Forms)));
        }
        Err(DerivationError::SingularMass(_)) => {
            scene.fixes.last().map(|fix| faults.report(singular(fix, &Trouble::Inertia)));
        }
        Err(DerivationError::TooLarge | DerivationError::TooManyCoordinates) => {
            let text = format!("the equations of scene `{name}` are too large to derive");
            faults.report(Fault::new(name.span(), text));
        }
        Err(DerivationError::NotQuadratic(_) | DerivationError::RoutesDisagree { .. }) => {
            let text = format!(
                "guen cannot derive scene `{name}`, though it derives the system: this is a bug of guen"
            );
            faults.report(Fault::new(name.span(), text).help("please report it with this declaration"));
        }
    }
    None
}

/// Mechanics with the forms and energies of a whole system, with constants at their values.
pub(in crate::derive) fn at_values(
    bench: &mut Workbench,
    mechanics: &Mechanics,
    whole: &Derivation,
    values: &[(ExprId, ExprId)],
) -> Mechanics {
    let mut mechanics = mechanics.with_values(bench, values);
    // A momentum that the values make vanish is truly zero, and was not left out.
    for (stated, without) in mechanics.stated.iter_mut().zip(&whole.without_momentum) {
        *stated |= !without;
    }
    mechanics
}

/// The first fixed constant that is trouble by itself, or the last one if only all together are.
fn culprit<'s, 'a>(
    model: &mut Model<'_>,
    whole: &Derivation,
    fixes: &'s [FixedConstant<'a>],
) -> Option<(&'s FixedConstant<'a>, Trouble)> {
    let bench = &mut model.bench;
    let pairs: Vec<(ExprId, ExprId)> = fixes.iter().map(|fix| (fix.symbol, fix.value)).collect();
    let together = trouble(bench, whole, &pairs)?;
    for (fix, pair) in fixes.iter().zip(pairs) {
        if let Some(own) = trouble(bench, whole, &[pair]) {
            return Some((fix, own));
        }
    }
    Some((fixes.last()?, together))
}

fn trouble(bench: &mut Workbench, whole: &Derivation, fixed: &[(ExprId, ExprId)]) -> Option<Trouble> {
    let mut values = Substitution::new(fixed.iter().copied());
    let mut at_values = |bench: &mut Workbench, rows: &[Vec<ExprId>]| -> Option<Vec<Vec<ExprId>>> {
        let mut image = Vec::new();
        for row in rows {
            let row: Vec<ExprId> = row.iter().map(|e| values.of(&mut bench.graph, *e)).collect();
            if row.iter().any(|e| is_undefined(bench, *e)) {
                return None;
            }
            image.push(row);
        }
        Some(image)
    };
    let system = &whole.system;
    let forms: Vec<Vec<ExprId>> = system.forms.forms.iter().map(|form| form.row.clone()).collect();
    let everything = vec![
        [system.kinetic_energy, system.force_function]
            .into_iter()
            .chain(system.outputs.iter().copied())
            .chain(system.states.iter().map(|state| state.rate))
            .collect(),
        system.forces.iter().flat_map(|force| [force.magnitude, force.along]).collect(),
        system.forms.forms.iter().map(|form| form.offset).collect(),
    ];
    if at_values(bench, &everything).is_none() {
        return Some(Trouble::Division);
    }
    for (rows, trouble) in [(forms, Trouble::Forms), (whole.equations.mass.clone(), Trouble::Inertia)] {
        let Some(rows) = at_values(bench, &rows) else { return Some(Trouble::Division) };
        if let Some(rank) = bench.zero.rank(&mut bench.graph, &rows, true)
            && rank < rows.len()
        {
            return Some(trouble);
        }
    }
    None
}

/// The fault of a fixed constant at whose value a contact, a switch or a reset divides by zero.
pub(in crate::derive) fn undefined_contacts(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    fixes: &[FixedConstant<'_>],
) -> Option<Fault> {
    let entries = contacts.entries.iter().map(|entry| {
        let values = [entry.gap, entry.friction, entry.stiction, entry.limit, entry.when, entry.release];
        let rows = entry.rows.iter().map(|row| row.form);
        let values = values.into_iter().flatten().chain([entry.restitution]).chain(rows);
        (entry.name, values.collect::<Vec<ExprId>>())
    });
    let switches = contacts.switches.iter().map(|switch| (switch.name, vec![switch.function]));
    let resets = contacts.resets.iter().map(|reset| {
        let given = reset.assignments.iter().map(|(_, value)| *value);
        (reset.name, given.chain([reset.function]).collect())
    });
    let parts: Vec<(&Name, Vec<ExprId>)> = entries.chain(switches).chain(resets).collect();
    let mut undefined = |fixed: &[&FixedConstant<'_>]| {
        let mut values = Substitution::new(fixed.iter().map(|fix| (fix.symbol, fix.value)));
        let found = parts.iter().find(|(_, values_of_part)| {
            values_of_part.iter().any(|e| {
                let e = values.of(&mut bench.graph, *e);
                is_undefined(bench, e)
            })
        });
        found.map(|(name, _)| *name)
    };
    let all: Vec<&FixedConstant<'_>> = fixes.iter().collect();
    let together = undefined(&all)?;
    let alone = fixes.iter().find_map(|fix| Some((fix, undefined(&[fix])?)));
    let (fix, part) = alone.or_else(|| Some((fixes.last()?, together)))?;
    let text = format!("fixing `{}` at this value makes `{part}` divide by zero", fix.name);
    Some(Fault::new(fix.name.span(), text).note("the scene could not go from one mode to another"))
}

/// Whether something is divided by the number zero anywhere inside.
fn is_undefined(bench: &Workbench, e: ExprId) -> bool {
    let parts = bench.graph.reachable(&[e], |_| false);
    parts.iter().any(|part| matches!(bench.graph.node(*part), Node::Undefined))
}

/// The variables that a scene holds, each with the symbol of its constant; one that moves is reported with its rate.
pub(in crate::derive) fn held(
    model: &mut Model<'_>,
    rates: &[ExprId],
    names: &[&Name],
    faults: &mut Faults,
) -> Option<Vec<Held>> {
    let before = faults.count();
    let mut held = Vec::new();
    for name in names {
        for place in model.places(&name.text) {
            let rate = rates[place];
            if model.bench.verdict_on_manifold(rate) == guen_symbolic::Verdict::Zero {
                let variable = model.variable_name(place).to_owned();
                let symbol = model.bench.graph.symbol(&variable, guen_symbolic::Role::Constant);
                held.push(Held { place, symbol });
                continue;
            }
            let tidy = model.bench.tidy(rate);
            let (variable, rate) = (model.variable_name(place), short(model, tidy));
            faults.report(
                Fault::new(name.span(), format!("`{name}` cannot be fixed: it moves"))
                    .note(format!("its rate is `{variable}' = {rate}`"))
                    .help("fix the constants that make it rest, or leave it out: what nothing depends on is not kept"),
            );
            break;
        }
    }
    (faults.count() == before).then_some(held)
}

/// The rates of the variables when some are held.
pub(in crate::derive) struct Holding {
    substitution: Substitution,
}

impl Holding {
    pub(in crate::derive) fn new(model: &Model<'_>, held: &[Held]) -> Self {
        let zero = model.bench.graph.zero();
        let values = held.iter().map(|held| (model.variable(held.place), held.symbol));
        let resting = held.iter().filter_map(|held| match model.part(held.place) {
            StatePart::Parameter(s) => Some(s),
            _ => None,
        });
        let resting = resting.map(|s| (model.mechanics.accelerations[s], zero));
        Holding { substitution: Substitution::new(values.chain(resting)) }
    }

    pub(in crate::derive) fn of(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        self.substitution.of(&mut bench.graph, e)
    }
}

/// The places of held variables.
pub(in crate::derive) fn is_held(held: &[Held], place: StateIndex) -> bool {
    held.iter().any(|held| held.place == place)
}
