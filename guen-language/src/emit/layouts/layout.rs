//! Sizes, names and parameters that every part of the emission needs.

use guen_symbolic::{CarriedFunction, ExprId};
use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use super::fields::Fields;
use super::supplied::Supplied;
use crate::derive::{DerivedLevel, StateIndex, StatePart, Subject};
use crate::model::Model;
use crate::names::REAL;
use crate::syntax::{Declaration, Name};

/// The path of the facade in the user's crate.
pub(in crate::emit) fn facade(declaration: &Declaration) -> TokenStream {
    declaration.crate_path.clone().unwrap_or_else(|| quote!(::guen))
}

/// Sizes and names that every part of the emission needs.
pub(in crate::emit) struct Layout {
    /// The name of the struct, as the user wrote it: where it is declared and spoken of.
    pub(in crate::emit) declared: Ident,
    /// The name of the struct in code: an alias where the name is that of the real in generic code.
    pub(in crate::emit) system: Ident,
    /// Numbers: coordinates, parameters and state of the level, coordinates of the whole system, constants, hoisted
    /// values, inputs.
    pub(in crate::emit) n: usize,
    pub(in crate::emit) l: usize,
    pub(in crate::emit) size: usize,
    pub(in crate::emit) all: usize,
    pub(in crate::emit) constants: usize,
    pub(in crate::emit) hoisted: usize,
    pub(in crate::emit) inputs: usize,
    /// The constants that follow others until they are set, each behind those that its formula reads.
    pub(in crate::emit) derived: Vec<usize>,
    /// The functions that the program supplies.
    pub(in crate::emit) supplied: Supplied,
    /// Fields of the state.
    pub(in crate::emit) state: Fields,
    /// Whether this is the system itself.
    pub(in crate::emit) is_whole: bool,
}

impl Layout {
    pub(in crate::emit) fn new(subject: &Subject<'_, '_>) -> Self {
        let Subject { model, level, .. } = subject;
        let selection = &level.selection;
        let declared = subject.name().ident.clone();
        let system = if declared == REAL { format_ident!("__guen_system") } else { declared.clone() };
        Layout {
            declared,
            system,
            n: selection.coordinates.len(),
            l: selection.parameters.len(),
            size: selection.variables.len() + selection.carried.len(),
            all: model.coordinates.len(),
            constants: selection.constants.len() + selection.held.len(),
            hoisted: level.programs.prepared.len(),
            inputs: selection.inputs.len(),
            derived: derived(model, level),
            supplied: Supplied::new(subject.whole),
            state: {
                let variables = selection.variables.iter().map(|place| variable_name(model, *place));
                let names = variables.chain(selection.carried.iter().map(|f| carried_field(model, f)));
                Fields::new(&names.collect::<Vec<Name>>()).of_record("State")
            },
            is_whole: level.scene.is_none(),
        }
    }
}

/// The name of a variable, which is the way to its value.
pub(in crate::emit) fn variable_name(model: &Model<'_>, place: StateIndex) -> Name {
    match model.part(place) {
        StatePart::Coordinate(i) => model.coordinates[i].name.clone(),
        StatePart::Parameter(s) => model.forms[s].own_name(),
        StatePart::State(k) => model.states[k].name.clone(),
    }
}

/// The name of a function that is carried.
pub(in crate::emit) fn carried_field(model: &Model<'_>, function: &CarriedFunction) -> Name {
    Name::new(format_ident!("{}", carried_name(model, function), span = Span::call_site()))
}

/// The name of a function that is carried, as text: an identifier, whatever the function is of.
pub(in crate::emit) fn carried_name(model: &Model<'_>, function: &CarriedFunction) -> String {
    let text = model.bench.graph.text(function.symbol).replace(']', "");
    text.replace(['[', '.'], "_")
}

/// The parameter and the argument of inputs, where the system has some.
pub(in crate::emit) fn inputs(layout: &Layout) -> (TokenStream, TokenStream) {
    if layout.inputs == 0 {
        (quote!(), quote!(&[]))
    } else {
        (quote!(, inputs: &Inputs<R>), quote!(&::core::convert::From::from(*inputs)))
    }
}

/// `, inputs` where a macro of the runtime asks whether there are some.
pub(in crate::emit) fn given(layout: &Layout) -> TokenStream {
    let inputs = given_alone(layout);
    if layout.inputs == 0 { inputs } else { quote!(, #inputs) }
}

/// `inputs`, where the macro asks for nothing else.
pub(in crate::emit) fn given_alone(layout: &Layout) -> TokenStream {
    if layout.inputs == 0 { quote!() } else { quote!(inputs) }
}

/// The constants of a level that follow others, by place, each behind those that its formula reads. In a scene one that
/// another is fixed by is not among them if it would follow itself.
pub(super) fn derived(model: &Model<'_>, level: &DerivedLevel) -> Vec<usize> {
    let given = &level.selection.constants;
    let mut left: Vec<usize> = (0..given.len()).filter(|i| model.constants[given[*i]].is_derived).collect();
    let mut found = Vec::new();
    loop {
        let reads = |i: &usize| {
            let mut read = Vec::new();
            if let Some(default) = model.constants[given[*i]].default {
                reads(model, level, default, &mut read);
            }
            read
        };
        let Some(next) = left.iter().position(|i| !reads(i).iter().any(|read| left.contains(read))) else {
            return found;
        };
        found.push(left.remove(next));
    }
}

/// The constants of a level that an expression reads, those that a scene fixes at their values.
fn reads(model: &Model<'_>, level: &DerivedLevel, e: ExprId, read: &mut Vec<usize>) {
    let graph = &model.bench.graph;
    for symbol in graph.symbols_in(&[e]) {
        let is_it = |c: usize| graph.as_symbol(model.constants[c].symbol) == Some(symbol);
        let fixes = level.scene.iter().flat_map(|facts| &facts.fixes);
        match level.selection.constants.iter().position(|c| is_it(*c)) {
            Some(i) => read.push(i),
            None => fixes.filter(|(c, _)| is_it(*c)).for_each(|(_, value)| reads(model, level, *value, read)),
        }
    }
}
