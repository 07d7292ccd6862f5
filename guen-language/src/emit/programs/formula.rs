//! Expressions of constants as Rust: defaults, limits, masses.

use guen_symbolic::{ExprId, Graph, SymbolId};

use super::code::number;
use crate::derive::Subject;

/// An expression of constants as one of Rust over the locals `__guen_c0`, `__guen_c1`, .., one for each field; constants
/// that a scene fixes are at their values.
pub(in crate::emit) fn default_text(subject: &Subject<'_, '_>, e: ExprId) -> String {
    let graph = &subject.model.bench.graph;
    let constants = &subject.model.constants;
    text_of(graph, e, &|symbol| {
        let is_it = |c: &usize| graph.as_symbol(constants[*c].symbol) == Some(symbol);
        let fixes = subject.scene().map_or(&[][..], |(_, facts)| &facts.fixes);
        match subject.level.selection.constants.iter().position(is_it) {
            Some(i) => format!("__guen_c{i}"),
            None => {
                let value = fixes.iter().find(|(c, _)| is_it(c));
                value.map_or_else(String::new, |(_, value)| default_text(subject, *value))
            }
        }
    })
}

/// An expression as one of Rust, from what stands for its symbols.
pub(in crate::emit) fn text_of(graph: &Graph, e: ExprId, symbol: &dyn Fn(SymbolId) -> String) -> String {
    use guen_symbolic::Node;
    let of = |e| text_of(graph, e, symbol);
    match graph.node(e) {
        Node::Number(value) => number(value),
        Node::Pi => "R::pi()".to_owned(),
        Node::Symbol(known) => symbol(*known),
        Node::Sum { constant, terms } => {
            let mut parts = Vec::new();
            if !constant.is_zero() {
                parts.push(number(constant));
            }
            for (term, c) in terms {
                parts.push(match c {
                    c if c.is_one() => of(*term),
                    c if c.is_minus_one() => format!("(-{})", of(*term)),
                    c => format!("{} * {}", number(c), of(*term)),
                });
            }
            format!("({})", parts.join(" + "))
        }
        Node::Product(factors) => {
            let parts: Vec<String> = factors
                .iter()
                .map(|(base, e)| match e {
                    1 => of(*base),
                    e => format!("R::powi({}, {e}i32)", of(*base)),
                })
                .collect();
            format!("({})", parts.join(" * "))
        }
        Node::Function(guen_symbolic::Function::Root(q), x) => {
            format!("R::root({}, {q}u32)", of(*x))
        }
        Node::Function(function, x) => format!("R::{}({})", function.name(), of(*x)),
        Node::Multivariate(function, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(|e| of(*e)).collect();
            super::code::apply(*function, &arguments)
        }
        Node::Kept(x) => of(*x),
        // Divisions by zero are refused before.
        Node::Undefined => "R::zero()".to_owned(),
    }
}
