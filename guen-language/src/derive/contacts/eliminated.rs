//! The rates of modes by the elimination that solves smooth systems: of scenes with few modes.
//!
//! The declaration of the mode is written as for a scene in one mode, and its equations are solved. The rates of the parameters that follow
//! there are those of the expressions that they follow by, in the rates of the others. Friction along a line is solved for with its loads; a
//! slip in space is left to the common program.

use guen_symbolic::{Contracted, Dependence, Derivation, ExprId, Flow, Operation, Programs, Role, SymbolId};

use super::{ContactFacts, friction, one_mode};
use crate::derive::brackets::readable::polish;
use crate::derive::function;
use crate::derive::level::DerivedLevel;
use crate::derive::quantities::domain::{CHART, constant_pivots, domain};
use crate::derive::quantities::formulas;
use crate::derive::quantities::programs::{extend, programs};
use crate::derive::selections::selection::{Selection, StateIndex};
use crate::derive::thresholds::ELIMINATED_MODES;
use crate::diagnostics::collect;
use crate::model::{self, ContactState, Contacts, Model, SceneEntry, SceneModes};
use crate::syntax::{Declaration, Name, Scene};

/// Adds the rates of the modes of scenes with few modes, without switches, and with no constants fixed.
pub(in crate::derive) fn add(model: &mut Model<'_>, system: &DerivedLevel, scenes: &mut [DerivedLevel]) {
    let Some(contacts) = model.contacts.take() else { return };
    let entries = std::mem::take(&mut model.scenes);
    let is_plain = model.functions.is_empty() && !model.declaration.is_outline;
    for level in scenes.iter_mut().filter(|_| is_plain) {
        let Some(entry) = level.scene.as_ref().map(|scene| &entries[scene.index]) else { continue };
        let (Some(own), Some(whole)) = (level.contacts.clone(), &system.contacts) else { continue };
        let is_smooth = own.switches.is_empty() && own.branches.is_empty();
        let is_whole = entry.fixes.is_empty() && level.selection.held.is_empty();
        if own.modes.len() > ELIMINATED_MODES || !is_smooth || !is_whole {
            continue;
        }
        let mut eliminated = Vec::new();
        for (place, mode) in own.modes.iter().enumerate().filter(|(_, mode)| is_held(&contacts, mode)) {
            let selection = &level.selection;
            // Velocities of the best condition first; then those that the scene has.
            let kept = selection.parameters.iter().map(|s| model.forms[*s].own_name()).collect();
            let found = [Vec::new(), kept].into_iter().find_map(|tracks: Vec<Name>| {
                rates(model, system, (&contacts, whole), (entry, mode, tracks), selection)
            });
            let Some(mut rates) = found else { continue };
            rates.functions.iter_mut().for_each(|f| f.name = function::mode_rates(eliminated.len()));
            level.programs.append(rates);
            eliminated.push(place);
        }
        if let Some(facts) = &mut level.contacts {
            facts.eliminated = eliminated;
        }
    }
    model.scenes = entries;
    model.contacts = Some(contacts);
}

/// Whether something is closed in a mode, and nothing slips in space: the direction of such a slip is none of the state where it begins.
fn is_held(contacts: &Contacts<'_>, mode: &[usize]) -> bool {
    use ContactState::{Closed, Locked, Slip, SlipMinus, SlipPlus, Stick};
    let states = || contacts.entries.iter().zip(mode).map(|(entry, state)| entry.states()[*state]);
    let holds = |state| matches!(state, Closed | Stick | Locked | SlipPlus | SlipMinus);
    states().any(holds) && !states().any(|state| state == Slip)
}

/// The program of the rates of what a scene keeps in a mode; `None` where it needs something else, or divides by what the system does not.
fn rates(
    model: &mut Model<'_>,
    system: &DerivedLevel,
    (contacts, facts): (&Contacts<'_>, &ContactFacts),
    (entry, mode, tracks): (&SceneEntry<'_>, &[usize], Vec<Name>),
    selection: &Selection,
) -> Option<Programs> {
    let scene = Scene { tracks, provides: Vec::new(), fixes: Vec::new(), ..entry.scene.clone() };
    let modes = SceneModes::One(mode.to_vec());
    let entry = SceneEntry { scene: &scene, fixes: Vec::new(), held: Vec::new(), modes };
    let (declaration, report) =
        collect(|faults| one_mode::declaration(model, (contacts, facts), &entry, faults));
    let declaration: Declaration = declaration.filter(|_| report.is_empty())?;
    let (own, report) = collect(|faults| model::resolve(&declaration, faults));
    let mut own = own.filter(|_| report.is_empty())?;
    let (solved, report) = collect(|faults| friction::solve_loads(&mut own, faults));
    // A magnitude has a kink, and the runs hold its sign.
    solved.filter(|()| report.is_empty() && !own.loads.iter().any(|load| load.is_magnitude))?;
    let mut derivation = Derivation::new(&mut own.bench, own.mechanics.clone()).ok()?;
    derivation.restate_by_bodies(&mut own.bench);
    polish(&mut own.bench, &mut derivation);
    if !divides_by_known(model, system, &own, &derivation) {
        return None;
    }
    let given = given(&mut own, model, &system.derivation, selection);
    let mut lists: Vec<Vec<ExprId>> = Vec::new();
    for list in formulas::rates(&derivation) {
        // Rates of what follows are shorter in terms of the other rates than multiplied out, or longer.
        let whole: Vec<ExprId> = list.iter().map(|rate| own.bench.graph.keep_sums(*rate)).collect();
        for list in [list, whole] {
            lists.extend(kept(&mut own, &derivation, &list, (model, selection), &given));
        }
    }
    if lists.is_empty() {
        return None;
    }
    extend(&mut own.bench, &mut lists);
    let mut found = programs(&mut own.bench, &lists, &[]);
    renamed(&mut found, &own, model, &given)?;
    Some(found)
}

/// A coordinate whose rate is a parameter of the state that follows from others in the mode, and needs no computation.
struct Given {
    /// The coordinate and the parameter, by their places in the whole state.
    coordinate: StateIndex,
    parameter: StateIndex,
    /// The parameter in the mode.
    symbol: ExprId,
}

fn given(
    own: &mut Model<'_>,
    whole: &Model<'_>,
    derivation: &Derivation,
    selection: &Selection,
) -> Vec<Given> {
    let rates = formulas::rates(derivation).into_iter().next().unwrap_or_default();
    let mut all = Vec::new();
    for coordinate in &selection.coordinates {
        let is_rate = |place: &&StateIndex| whole.variable(**place) == rates[*coordinate];
        let Some(parameter) = selection.variables.iter().find(is_rate) else { continue };
        let name = whole.variable_name(*parameter);
        if own.followers.iter().any(|follower| follower.name == name) {
            let symbol = own.bench.graph.symbol(name, Role::QuasiVelocity);
            all.push(Given { coordinate: *coordinate, parameter: *parameter, symbol });
        }
    }
    all
}

/// Whether the velocities of the mode are a chart wherever those of the system are. Its mass matrix is singular where that of the system is, or the
/// matrix of the reactions: there the common program divides by zero, too.
fn divides_by_known(
    model: &Model<'_>,
    system: &DerivedLevel,
    own: &Model<'_>,
    derivation: &Derivation,
) -> bool {
    let texts = |model: &Model<'_>, derivation: &Derivation| {
        let functions = domain(model, derivation, &Contracted::default()).into_iter();
        functions.filter(|function| function.words == CHART).map(|function| function.text).collect()
    };
    let known: Vec<String> = texts(model, &system.derivation);
    let needed: Vec<String> = texts(own, derivation);
    let constants: Vec<String> =
        constant_pivots(&system.derivation).into_iter().map(|e| model.bench.graph.text(e)).collect();
    let graph = &own.bench.graph;
    let is_known = |e: &ExprId| graph.manifestly_nonzero(*e) || constants.contains(&graph.text(*e));
    needed.iter().all(|text| known.contains(text)) && constant_pivots(derivation).iter().all(is_known)
}

/// The rates of what a scene keeps, from those of the system in the mode; `None` where they depend on more.
fn kept(
    own: &mut Model<'_>,
    derivation: &Derivation,
    list: &[ExprId],
    (whole, selection): (&Model<'_>, &Selection),
    given: &[Given],
) -> Option<Vec<ExprId>> {
    let (_, size) = own.sizes();
    let variables: Vec<ExprId> = (0..size).map(|place| own.variable(place)).collect();
    let one = own.bench.graph.one();
    let moving = variables.iter().copied().zip(list.iter().copied());
    let moving = moving.chain([(own.mechanics.forms.time, one)]).collect::<Vec<_>>();
    let mut along = Flow::new(&own.bench.graph, moving);
    let mut rates = Vec::new();
    for place in &selection.variables {
        if let Some(rate) = given.iter().find(|given| given.coordinate == *place) {
            rates.push(rate.symbol);
            continue;
        }
        let name = whole.variable_name(*place);
        if let Some(place) = (0..size).find(|place| own.variable_name(*place) == name) {
            rates.push(list[place]);
            continue;
        }
        let output = own.followers.iter().find(|follower| follower.name == name)?.output;
        let rate = along.of(&mut own.bench.graph, derivation.outputs[output]);
        rates.push(own.bench.tidy(rate));
    }
    let names: Vec<&str> = selection.variables.iter().map(|place| whole.variable_name(*place)).collect();
    let left = (0..size).filter(|place| !names.contains(&own.variable_name(*place)));
    let inputs = own.inputs.iter().enumerate().filter(|(u, _)| !selection.inputs.contains(u));
    let idle: Vec<ExprId> =
        left.map(|place| variables[place]).chain(inputs.map(|(_, input)| input.symbol)).collect();
    let mut dependence = Dependence::default();
    let bench = &mut own.bench;
    for rate in &mut rates {
        *rate = dependence.without_idle(bench, *rate, &idle);
    }
    let occurring: Vec<ExprId> =
        bench.graph.symbols_in(&rates).into_iter().map(|symbol| bench.graph.symbol_expr(symbol)).collect();
    occurring.iter().all(|symbol| !idle.contains(symbol)).then_some(rates)
}

/// Puts the symbols of the whole system in place of those of the mode, by their names; `None` where one has none.
fn renamed(programs: &mut Programs, own: &Model<'_>, whole: &Model<'_>, given: &[Given]) -> Option<()> {
    let instructions = programs.functions.iter_mut().flat_map(|function| &mut function.instructions);
    for instruction in programs.prepare.iter_mut().chain(instructions) {
        if let Operation::Symbol(symbol) = &mut instruction.operation {
            *symbol = in_whole(*symbol, own, whole, given)?;
        }
    }
    Some(())
}

fn in_whole(symbol: SymbolId, own: &Model<'_>, whole: &Model<'_>, given: &[Given]) -> Option<SymbolId> {
    let e = own.bench.graph.symbol_expr(symbol);
    let variable =
        |model: &Model<'_>, is: &dyn Fn(usize) -> bool| (0..model.sizes().1).find(|place| is(*place));
    let found = if e == own.mechanics.forms.time {
        whole.mechanics.forms.time
    } else if let Some(c) = own.constants.iter().position(|constant| constant.symbol == e) {
        whole.constants[c].symbol
    } else if let Some(u) = own.inputs.iter().position(|input| input.symbol == e) {
        whole.inputs[u].symbol
    } else if let Some(given) = given.iter().find(|given| given.symbol == e) {
        whole.variable(given.parameter)
    } else {
        let place = variable(own, &|place| own.variable(place) == e)?;
        let name = own.variable_name(place);
        whole.variable(variable(whole, &|place| whole.variable_name(place) == name)?)
    };
    whole.bench.graph.as_symbol(found)
}
