//! Switches of a level: the functions at whose zeros its rates change their formula.

use guen_symbolic::{Contracted, ExprId, ProgramBuilder, Programs, Role, Roles};
use proc_macro2::Span;

use super::domain::written;
use crate::derive::function;
use crate::diagnostics::{Fault, Faults};
use crate::limits::MAX_SWITCHES;
use crate::model::Model;

/// Returns the switching functions of the piecewise functions in some rates, each once, with their texts, and adds their program.
pub(in crate::derive) fn add(
    model: &mut Model<'_>,
    rates: &[ExprId],
    shown: &Contracted,
    programs: &mut Programs,
    (place, faults): (Span, &mut Faults),
) -> Vec<String> {
    let moving = Roles::of(Role::Time).or(Roles::of(Role::Coordinate)).or(Roles::of(Role::QuasiVelocity));
    let moving = moving.or(Roles::of(Role::State));
    let graph = &mut model.bench.graph;
    let mut switches: Vec<ExprId> = Vec::new();
    for id in graph.reachable(rates, |_| false) {
        let Some(switch) = graph.switching_function(id) else { continue };
        let opposite = graph.neg(switch);
        // A function of inputs alone jumps only where they do, and inputs are held during a step.
        if graph.roles(switch).meets(moving) && !switches.contains(&switch) && !switches.contains(&opposite) {
            // Of both the one that reads better.
            let reads_worse = graph.text_limited(switch, 80).is_some_and(|text| text.starts_with('-'));
            switches.push(if reads_worse { opposite } else { switch });
        }
    }
    if switches.is_empty() {
        return Vec::new();
    }
    if switches.len() > MAX_SWITCHES {
        let text = format!(
            "the rates change their formula at the zeros of {} functions, and {MAX_SWITCHES} are allowed",
            switches.len()
        );
        faults.report(
            Fault::new(place, text).help("use fewer of `min`, `max`, `select` and other piecewise functions"),
        );
        return Vec::new();
    }
    let mut builder = ProgramBuilder::new(graph);
    builder.add_cold(function::SWITCHES, &switches);
    programs.append(builder.finish());
    switches.iter().map(|e| written(model, shown.image(*e), "a long switching function")).collect()
}
