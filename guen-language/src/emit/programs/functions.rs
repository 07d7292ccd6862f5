//! The private module of straight-line functions.

use std::fmt::Write;

use guen_symbolic::{ArrayIndex, Arrays, ExprId, Programs, SymbolId};
use proc_macro2::TokenStream;

use super::code::{Loads, Parts, SUPPLIED, body};
use super::unpacked::indexed;
use crate::derive::{DerivedLevel, Subject, function};
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::text::tokens;
use crate::emit::methods::motion::has_power;

/// The places of the values of symbols, in the arrays that a function takes.
pub(super) struct Places {
    symbols: Vec<String>,
    functions: usize,
}

impl Loads for Places {
    fn symbol(&self, symbol: SymbolId) -> String {
        self.symbols[symbol.index()].clone()
    }

    fn functions(&self) -> usize {
        self.functions
    }
}

impl Arrays for Places {
    fn symbol(&self, symbol: SymbolId) -> Option<ArrayIndex> {
        let (array, index) = indexed(&self.symbols[symbol.index()])?;
        Some((array.chars().next()?, index))
    }
}

impl Places {
    /// The places of a level; with all coordinates of the system for what does not belong to the state.
    pub(super) fn new(subject: &Subject<'_, '_>, everywhere: bool) -> Self {
        let Subject { model, level, .. } = subject;
        let (graph, selection) = (&model.bench.graph, &level.selection);
        let mut places = vec![String::from("unknown_symbol"); graph.symbols().count()];
        let mut put = |e: ExprId, place: String| {
            if let Some(symbol) = graph.as_symbol(e) {
                places[symbol.index()] = place;
            }
        };
        let mechanics = &model.mechanics;
        put(mechanics.forms.time, "t".to_owned());
        let constants = selection.constants.iter().map(|c| model.constants[*c].symbol);
        let constants = constants.chain(selection.held.iter().map(|held| held.symbol));
        constants.enumerate().for_each(|(i, symbol)| put(symbol, format!("c[{i}]")));
        if everywhere {
            let coordinates = mechanics.forms.coordinates.iter().enumerate();
            coordinates.for_each(|(i, x)| put(*x, format!("s[{i}]")));
        } else {
            let variables = selection.variables.iter().enumerate();
            variables.for_each(|(i, place)| put(model.variable(*place), format!("s[{i}]")));
            let carried = selection.carried.iter().map(|function| function.symbol);
            let first = selection.variables.len();
            carried.enumerate().for_each(|(i, symbol)| put(symbol, format!("s[{}]", first + i)));
        }
        mechanics.velocities.iter().enumerate().for_each(|(i, w)| put(*w, format!("w[{i}]")));
        let accelerations = selection.parameters.iter().enumerate();
        accelerations.for_each(|(i, s)| put(mechanics.accelerations[*s], format!("a[{i}]")));
        let inputs = selection.inputs.iter().enumerate();
        inputs.for_each(|(i, u)| put(mechanics.inputs[*u], format!("u[{i}]")));
        if let (Some(contacts), Some(facts)) = (&model.contacts, &level.contacts) {
            let switches = facts.switches.iter().map(|s| contacts.switches[*s].symbol);
            switches.enumerate().for_each(|(i, symbol)| put(symbol, format!("b[{i}]")));
            let first = facts.switches.len() + facts.resets.len();
            let branches = facts.branches.iter().map(|branch| branch.symbol).zip(first..);
            branches.for_each(|(symbol, i)| put(symbol, format!("b[{i}]")));
            let forces = contacts.rows().enumerate();
            forces.for_each(|(i, row)| put(row.force, format!("f[{i}]")));
            let speeds = contacts.entries.iter().map(|entry| entry.speed).enumerate();
            speeds.for_each(|(i, speed)| speed.into_iter().for_each(|speed| put(speed, format!("m[{i}]"))));
        }
        Places { symbols: places, functions: subject.whole.functions.len() }
    }
}

/// The arguments of a function of the state.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Signature {
    /// Prepared values alone.
    Constants,
    /// Time and the coordinates of the state.
    Position,
    /// Time and all coordinates of the system.
    Everywhere,
    /// Time, coordinates and velocities.
    Velocities,
    /// Time and the whole state.
    State,
    /// Time, the whole state and the inputs.
    Driven,
    /// Time, the whole state, the inputs and the accelerations.
    Accelerated,
    /// Time, the whole state, the inputs, the switches and the magnitudes of slips.
    Contacts,
    /// Time, the whole state, the inputs, the switches, the magnitudes of slips and the forces of contacts.
    Pressed,
}

/// The signature of a function by its name.
pub(super) fn signature(name: &str) -> Signature {
    match name {
        function::PIVOTS | function::RESTITUTIONS => Signature::Constants,
        function::FREE_MOTION
        | function::FREE_RATES
        | function::ROW_RATES
        | function::ROW_DRIFTS
        | function::CONDITIONS
        | function::LOADS
        | function::RESETS
        | function::SIGNALS => Signature::Contacts,
        function::CONTACT_OUTPUTS => Signature::Pressed,
        name if name.starts_with(function::MODE_RATES) => Signature::Driven,
        function::FORMS => Signature::Velocities,
        function::RHS
        | function::OUTPUTS
        | function::MASS_FORM
        | function::COASTING
        | function::LINEARIZATION
        | function::SWITCHES
        | function::OUTPUT_LINEARIZATION => Signature::Driven,
        function::REACTIONS | function::REACTION_COVECTOR | function::POWER => Signature::Accelerated,
        function::VELOCITIES | function::ENERGY | function::KINETIC_ENERGY | function::MOMENTA => {
            Signature::State
        }
        function::DOMAIN
        | function::DETERMINED
        | function::CARRY
        | function::INVARIANTS
        | function::RENORMALIZED => Signature::State,
        function::OPERATORS | function::BRACKETS => Signature::Everywhere,
        _ => Signature::Position,
    }
}

/// The modules: `prepare` and every function, generic over the real.
pub(in crate::emit) fn modules(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let DerivedLevel { programs, placed, series, .. } = subject.level;
    let places = Places::new(subject, false);
    let series = series.as_ref().map(|series| super::series::functions(series, &places, layout));
    let mut text = module("program", programs, &series.unwrap_or_default(), subject, layout);
    if let Some(placed) = placed {
        text.push_str(&module("placed", placed, "", subject, layout));
    }
    tokens(&text)
}

/// Writes a module, with further functions.
fn module(name: &str, programs: &Programs, more: &str, subject: &Subject<'_, '_>, layout: &Layout) -> String {
    let (places, everywhere) = (Places::new(subject, false), Places::new(subject, true));
    let Layout { n, l, size, all, constants, inputs, .. } = *layout;
    let hoisted = programs.prepared.len();
    let mut lengths = vec![
        ("c", constants),
        ("k", hoisted),
        ("s", size),
        ("x", n),
        ("y", all),
        ("w", n),
        ("u", inputs),
        ("a", l),
    ];
    if let (Some(contacts), Some(facts)) = (&subject.model.contacts, &subject.level.contacts) {
        lengths.extend([
            ("b", facts.switches.len() + facts.resets.len() + facts.branches.len()),
            ("m", contacts.entries.len()),
            ("f", contacts.rows().count()),
        ]);
    }
    let length_of =
        |kind: &str| lengths.iter().find(|(name, _)| *name == kind).map_or(0, |(_, length)| *length);
    // Long families have loops where these are found.
    let graph = &subject.model.bench.graph;
    let (rolled_prepare, rolled) = match graph.nests_sums() {
        true => programs.rolled(graph, &places),
        false => (None, vec![None; programs.functions.len()]),
    };
    let prepare = match rolled_prepare {
        Some(rolled) => {
            let code = (&programs.prepare[..], &programs.prepared[..], programs.prepare_values);
            super::rolled::body(&rolled, code, &places)
        }
        None => body(&programs.prepare, &programs.prepared, &places, Parts::Blocks, length_of),
    };
    let supplied = match layout.supplied.is_empty() {
        true => String::new(),
        false => format!("{} {SUPPLIED} {}", layout.supplied.list(), layout.supplied.members()),
    };
    let mut text = format!("__guen::program! {{ {name} {{ {more} }} {supplied} {{ {prepare} }}");
    for (kind, length) in &lengths {
        let _ = write!(text, " {kind} {length}");
    }
    text.push(';');
    let has_power = has_power(subject.level);
    for (program, rolled) in programs.functions.iter().zip(rolled) {
        if program.name == function::POWER && !has_power {
            continue;
        }
        let signature = signature(&program.name);
        let places = if signature == Signature::Everywhere { &everywhere } else { &places };
        let given = match signature {
            Signature::Constants => ";",
            Signature::Position => "t; s x",
            Signature::Everywhere => "t; s y",
            Signature::Velocities => "t; s x w w",
            Signature::State => "t; s s",
            Signature::Driven => "t; s s u u",
            Signature::Accelerated => "t; s s u u a a",
            Signature::Contacts => "t; s s u u b b m m",
            Signature::Pressed => "t; s s u u b b m m f f",
        };
        let _ = write!(
            text,
            "{}({given}) -> {} {{ {} }}",
            program.name,
            program.outputs.len(),
            match rolled.filter(|_| signature != Signature::Everywhere) {
                Some(rolled) => {
                    let code = (&program.instructions[..], &program.outputs[..], program.values);
                    super::rolled::body(&rolled, code, places)
                }
                None => {
                    // The kind of an array, whose name says what it is in the function.
                    let kind = |array: &str| match array {
                        "s" => given
                            .split([' ', ';'])
                            .skip_while(|word| *word != "s")
                            .nth(1)
                            .unwrap_or("s")
                            .to_owned(),
                        other => other.to_owned(),
                    };
                    // Nothing of contacts is computed in lanes.
                    let parts =
                        if program.name == function::FREE_MOTION { Parts::Closures } else { Parts::Blocks };
                    body(&program.instructions, &program.outputs, places, parts, |array| {
                        length_of(&kind(array))
                    })
                }
            },
        );
    }
    text.push('}');
    text
}
