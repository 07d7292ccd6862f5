//! Derives a checked model: the derivation, its faults in the user's names, and the programs.
//!
//! In the order of the data: `brackets` of the operators, and the written form; `selections`, the part of a system that a level has; `quantities` of a level, as formulas
//! and programs; `contacts`, for which the system is derived once more; `provided`, further forms of a level; `scenes`, which use all of these. `level` holds the result.

mod brackets;
mod contacts;
mod faults;
pub mod function;
mod level;
mod provided;
mod quantities;
mod scenes;
mod selections;
mod thresholds;

use std::rc::Rc;

use guen_symbolic::{Derivation, ExprId};

use crate::diagnostics::Faults;
use crate::model::Model;
use brackets::commutators::commutators;
use brackets::readable::{equations, polish, shown};
use contacts::{eliminated, friction, one_mode};
use provided::{carried, series, source, supplied};
use quantities::domain::{constant_pivots, domain, reason};
use quantities::formulas::Quantity;
use quantities::programs::{add_mass, extend, programs};
use quantities::{control, formulas, missing_bounds, switches};
use scenes::scene;

pub use brackets::commutator::Commutator;
pub use contacts::branches::Branch;
pub use contacts::{ContactFacts, Painleve, ResetFacts};
pub(crate) use level::Subject;
pub use level::{DerivedLevel, DerivedSystem, Series};
pub(crate) use quantities::control::{has_covector, known_combinations};
pub use quantities::jacobians::Jacobians;
pub use quantities::missing_bounds::MissingBounds;
pub use selections::closure::{Quadrature, Reason};
pub use selections::facts::SceneFacts;
pub use selections::selection::{Held, Selection, StateIndex, StatePart};

/// Derives a checked model and its scenes; a system without equations of motion is reported.
pub fn derive<'a>(mut model: Model<'a>, faults: &mut Faults) -> Option<DerivedSystem<'a>> {
    let before = faults.count();
    friction::solve_loads(&mut model, faults)?;
    let derivation = match Derivation::new(&mut model.bench, model.mechanics.clone()) {
        Ok(derivation) => Some(derivation),
        Err(error) => {
            faults::report(&mut model, error, faults);
            None
        }
    };
    let mut derivation = derivation?;
    faults::report_missing_momenta(&mut model, &mut derivation, faults);
    faults::report_unknown_reactions(&model, &derivation, faults);
    if faults.count() > before || model.is_partial {
        contacts::check(&mut model, faults);
        return None;
    }
    derivation.restate_by_bodies(&mut model.bench);
    polish(&mut model.bench, &mut derivation);
    let brackets = commutators(&mut model, &mut derivation);
    let mut system = whole(&mut model, Rc::new(derivation), Rc::new(brackets), faults);
    if let Some(word) = model.provides_taylor {
        system.series = series::of(&model, &system.selection, &system.programs, word.span(), faults);
    }
    if let Some(word) = model.provides_source {
        source::check(&model, &system.programs, model.contacts.is_some(), word, faults);
        system.provides_source = true;
    }
    let mut equations = None;
    if let Some((programs, facts, of_contacts)) = contacts::derive(&mut model, faults) {
        system.programs.append(programs);
        system.contacts = Some(facts);
        equations = Some(of_contacts);
    }
    let mut scenes = scene::derive(&mut model, &system, equations, faults);
    eliminated::add(&mut model, &system, &mut scenes);
    let in_modes = one_mode::derive(&mut model, &system, faults);
    let levels: Vec<&DerivedLevel> = std::iter::once(&system).chain(&scenes).collect();
    supplied::check(&model, &levels, faults);
    (faults.count() == before).then_some(DerivedSystem { model, system, scenes, in_modes })
}

/// The system itself, with everything that follows from its derivation.
fn whole(
    model: &mut Model<'_>,
    derivation: Rc<Derivation>,
    brackets: Rc<Vec<Commutator>>,
    faults: &mut Faults,
) -> DerivedLevel {
    let (_, size) = model.sizes();
    let l = model.mechanics.forms.degrees;
    let forms = 0..model.forms.len();
    let mut selection = Selection {
        constants: (0..model.constants.len()).collect(),
        held: Vec::new(),
        inputs: (0..model.inputs.len()).collect(),
        holonomic: (0..derivation.system.holonomic.len()).collect(),
        redundant: (0..derivation.system.redundant.len()).collect(),
        momenta: forms.clone().filter(|j| derivation.known_momentum[*j]).collect(),
        reactions: forms.skip(l).filter(|v| derivation.reactions[v - l].is_some()).collect(),
        outputs: (0..model.outputs.len()).collect(),
        energy: true,
        linearization: true,
        operators: true,
        ..Selection::default()
    };
    selection.take(model, (0..size).collect());
    let equations = equations(&mut model.bench, &derivation);
    let rates = derivation.formulations[0].rates.clone();
    let written = [&equations[..], &rates[model.coordinates.len() + l..]].concat();
    let shown = shown(model, &derivation, &brackets, &written);
    let singularities = domain(model, &derivation, &shown);
    let reasons = singularities.iter().map(|singularity| {
        reason(&model.bench.graph, shown.image(singularity.function), &singularity.origin)
    });
    let domain_reasons = reasons.collect();
    let singularities = singularities.into_iter().map(|singularity| (singularity.function, singularity.text));
    let (domain, domain_names): (Vec<ExprId>, Vec<String>) = singularities.unzip();
    let constant_pivots = constant_pivots(&derivation);
    let quantities = formulas::whole(model, &derivation, &brackets, domain.clone(), constant_pivots.clone());
    let control = control::quantities(&mut model.bench, &derivation);
    let quantities: Vec<Quantity> = quantities.into_iter().chain(control).collect();
    let mut lists = formulas::rates(&derivation);
    extend(&mut model.bench, &mut lists);
    let placed = formulas::placed(model);
    let placed = (!placed.is_empty()).then(|| programs(&mut model.bench, &[], &[(function::BODIES, placed)]));
    let mut programs = programs(&mut model.bench, &lists, &quantities);
    add_mass(&mut programs, model, &derivation);
    let singularities = domain_names.len() - derivation.solution.determinants.len();
    let missing_bounds = missing_bounds::missing_bounds(model, &derivation, &programs);
    let jacobians = Jacobians::add(&mut programs, model, &selection);
    let name = model.declaration.name.span();
    let switches = switches::add(model, &rates, &shown, &mut programs, (name, &mut *faults));
    let energy = derivation.energies.integral;
    let mut level = DerivedLevel {
        selection,
        derivation,
        brackets,
        rates,
        equations,
        energy,
        programs,
        placed,
        domain,
        domain_names,
        domain_reasons,
        singularities,
        switches,
        constant_pivots,
        missing_bounds,
        series: None,
        jacobians,
        shown,
        scene: None,
        contacts: None,
        provides_source: false,
        carried: None,
    };
    if let Some(word) = model.provides_carried {
        level.carried = carried::derive(model, &level, &formulas::rates(&level.derivation), word, faults);
    }
    level
}
