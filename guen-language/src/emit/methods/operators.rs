//! The operators of displacement and their brackets.

use std::fmt::Write;

use guen_symbolic::{ExprId, Graph, Role, Roles};
use proc_macro2::TokenStream;

use crate::derive::Subject;
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::text::tokens;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    if !subject.level.selection.operators {
        return TokenStream::new();
    }
    let n = layout.all;
    let last = subject.model.last_operator();
    let mut text = format!("__guen::operators! {{ {n} {last}");
    let supplied = &layout.supplied;
    let mut aliases = String::new();
    for j in 0..=n {
        let docs = match j {
            0 => "The operator `X_0 = d/dt + sum_i xi_0^i d/dx_i`: what happens by itself, (1.7).".to_owned(),
            _ => format!("The operator `X_{j}` of the form `{}`, (1.4).", subject.model.forms[j - 1].name),
        };
        if supplied.is_empty() {
            let _ = match j {
                0 => write!(text, " X0 {docs:?}"),
                _ => write!(text, "{:?} X{j} {j}", subject.model.forms[j - 1].name),
            };
            continue;
        }
        // A constant has no parameters, and a function finds out which.
        let (declared, parameters, kinds) =
            (supplied.declared(), supplied.parameters(), supplied.arguments());
        let [declared, parameters, kinds] =
            [declared, parameters, kinds].map(|list| list.into_iter().skip(1).collect::<TokenStream>());
        let _ = write!(
            aliases,
            "#[doc = {docs:?}] pub type X{j}<{declared}> = __guen::Displacement<Prepared<::core::primitive::f64>, {j}>;
            #[doc = {docs:?}] pub const fn X{j}<{parameters}>() -> X{j}<{kinds}> {{ __guen::Displacement::NEW }}"
        );
    }
    text.push(';');
    let graph = &subject.model.bench.graph;
    for bracket in &*subject.level.brackets {
        let known: Vec<String> = bracket.coefficients.iter().map(|c| knowledge(graph, *c)).collect();
        let _ = write!(text, "{} {} [{}]", bracket.r, bracket.s, known.join(","));
    }
    text.push('}');
    text.push_str(&aliases);
    tokens(&text)
}

/// Returns a coefficient as far as it is known at compile time.
fn knowledge(graph: &Graph, c: ExprId) -> String {
    if let Some(value) = graph.as_number(c) {
        if value.is_zero() {
            return "Zero".to_owned();
        }
        if let Some((numerator, denominator)) = value.to_i64_pair() {
            return format!("Number {{ numerator: {numerator}, denominator: {denominator} }}");
        }
    }
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    if graph.roles(c).meets(moving) { "Variable".to_owned() } else { "Constant".to_owned() }
}
