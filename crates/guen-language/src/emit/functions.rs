//! The private module of straight-line functions.

use std::fmt::Write;

use guen_symbolic::{Role, SymbolId};
use proc_macro2::TokenStream;

use super::code::{Loads, body};
use super::{Layout, tokens};
use crate::derive::{Derived, function};

/// Where the values of symbols are: in the arrays that a function takes.
struct Places(Vec<String>);

impl Loads for Places {
    fn symbol(&self, symbol: SymbolId) -> String {
        self.0[symbol.index()].clone()
    }
}

impl Places {
    fn new(derived: &Derived<'_>) -> Self {
        let graph = &derived.model.bench.graph;
        let n = derived.model.coordinates.len();
        let mut counts = [0_usize; 8];
        Places(
            graph
                .symbols()
                .map(|symbol| {
                    let role = graph.symbol_info(symbol).role;
                    let i = counts[role as usize];
                    counts[role as usize] += 1;
                    match role {
                        Role::Time => "t".to_owned(),
                        Role::Constant => format!("c[{i}]"),
                        Role::Coordinate => format!("s[{i}]"),
                        Role::Velocity => format!("w[{i}]"),
                        Role::QuasiVelocity => derived
                            .model
                            .mechanics
                            .etas
                            .iter()
                            .position(|eta| graph.as_symbol(*eta) == Some(symbol))
                            .map_or_else(|| "unknown_form".to_owned(), |s| format!("s[{}]", n + s)),
                        Role::QuasiAcceleration => derived
                            .model
                            .mechanics
                            .accelerations
                            .iter()
                            .position(|a| graph.as_symbol(*a) == Some(symbol))
                            .map_or_else(|| "unknown_acceleration".to_owned(), |s| format!("a[{s}]")),
                        Role::Input => format!("u[{i}]"),
                    }
                })
                .collect(),
        )
    }
}

/// The start of a call that has the closure after it compiled with the instructions of the real: see
/// `Real::vectorize`.
const VECTORIZED: &str = "<R as __guen::Real>::vectorize(#[inline(always)] ||";

/// What a function of the state is given.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Signature {
    /// Prepared values alone.
    Constants,
    /// Time and coordinates.
    Position,
    /// Time, coordinates and velocities.
    Velocities,
    /// Time and the whole state.
    State,
    /// Time, the whole state and the inputs.
    Driven,
    /// Time, the whole state, the inputs and the accelerations.
    Accelerated,
}

/// The signature of a function by its name.
pub(super) fn signature(name: &str) -> Signature {
    match name {
        function::PIVOTS => Signature::Constants,
        function::FORMS => Signature::Velocities,
        function::RHS
        | function::OUTPUTS
        | function::MASS_FORM
        | function::LINEARIZATION
        | function::OUTPUT_LINEARIZATION => Signature::Driven,
        function::REACTIONS | function::REACTION_COVECTOR | function::POWER => Signature::Accelerated,
        function::VELOCITIES | function::ENERGY | function::KINETIC_ENERGY | function::MOMENTA => {
            Signature::State
        }
        function::DOMAIN => Signature::State,
        _ => Signature::Position,
    }
}

/// The module: `prepare` and every function, generic over the real.
pub(super) fn module(derived: &Derived<'_>, layout: &Layout) -> TokenStream {
    let places = Places::new(derived);
    let Layout { n, l, size, constants, hoisted, inputs, .. } = layout;
    let mut text = String::from(
        "#[allow(unused_variables, reason = \"every function has the signature of its kind\")]
        #[allow(clippy::all, clippy::pedantic, clippy::nursery, clippy::restriction, reason = \"straight-line code for the compiler\")]
        mod program { use super::__guen;",
    );
    let _ = write!(
        text,
        "#[inline] pub(super) fn prepare<R: __guen::Real>(c: &[R; {constants}]) -> [R; {hoisted}] {{ {} }}",
        body(&derived.programs.prepare, &derived.programs.prepared, &places),
    );
    for program in &derived.programs.functions {
        let given = match signature(&program.name) {
            Signature::Constants => String::new(),
            Signature::Position => format!(", t: R, s: &[R; {n}]"),
            Signature::Velocities => format!(", t: R, s: &[R; {n}], w: &[R; {n}]"),
            Signature::State => format!(", t: R, s: &[R; {size}]"),
            Signature::Driven => format!(", t: R, s: &[R; {size}], u: &[R; {inputs}]"),
            Signature::Accelerated => format!(", t: R, s: &[R; {size}], u: &[R; {inputs}], a: &[R; {l}]"),
        };
        let _ = write!(
            text,
            "#[inline] pub(super) fn {}<R: __guen::Real>(c: &[R; {constants}], k: &[R; {hoisted}]{given}) -> [R; {}] {{ {VECTORIZED} {{ {} }}) }}",
            program.name,
            program.outputs.len(),
            body(&program.instructions, &program.outputs, &places),
        );
    }
    text.push('}');
    tokens(&text)
}
