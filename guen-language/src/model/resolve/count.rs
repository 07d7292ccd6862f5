//! Counts the coordinates and the forms: as many forms as coordinates, and one at least.

use guen_symbolic::{ExprId, Form, Role, Workbench};

use super::redundant::Taken;
use crate::diagnostics::Fault;
use crate::model::FormKind;
use crate::model::evaluate::Evaluator;
use crate::model::forms::RawForm;
use crate::names::quoted;

/// Parameters, constraints and holonomic constraints together number `n`; of too few the macro completes the parameters.
pub(super) fn check(
    eval: &mut Evaluator<'_>,
    raw: &[RawForm<'_>],
    forms: Option<&[(Form, ExprId)]>,
    redundant: &[Taken<'_>],
    velocities: &[ExprId],
    idle: usize,
    place: proc_macro2::Span,
) {
    let n = velocities.len();
    if n == 0 {
        // The section is there, and it or its arrays are empty.
        let fault = Fault::new(place, "the system has no coordinates");
        eval.faults.report(fault.help("declare one at least, `coordinates { q }`"));
        return;
    }
    // Parameters without a velocity were reported already: without them the count may be right.
    if raw.len() <= n + idle {
        return;
    }
    let count = |kind| raw.iter().filter(|form| form.entry.kind == kind).count();
    let plural = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    let degrees = count(FormKind::Parameter);
    let (constraints, holonomic) = (count(FormKind::Constraint), count(FormKind::Holonomic));
    let mut found = vec![plural(degrees, "parameter"), plural(constraints, "constraint")];
    if holonomic > 0 {
        found.push(plural(holonomic, "holonomic constraint"));
    }
    let need = if n == 1 { "needs" } else { "need" };
    let are = if raw.len() == 1 { "is" } else { "are" };
    let mut fault = Fault::new(
        place,
        format!("{} {need} {}, and {} {are} declared", plural(n, "coordinate"), plural(n, "form"), raw.len()),
    )
    .note(format!("found: {}", found.join(", ")));
    if !redundant.is_empty() {
        let names = quoted(redundant.iter().map(|taken| taken.entry.entry.name.as_str()));
        let follow = if redundant.len() == 1 { "follows" } else { "follow" };
        let count = if redundant.len() == 1 { "does not count" } else { "do not count" };
        let others = match redundant.iter().all(|taken| taken.equation.is_some()) {
            true => "the other holonomic constraints",
            false => "the other constraints",
        };
        fault = fault.note(format!("{names} {follow} from {others} wherever all of them hold, and {count}"));
    }
    let surplus = raw.len() - n;
    let combinations = forms.map_or_else(Vec::new, |forms| combinations(&mut eval.bench, forms, degrees));
    for (form, beside) in &combinations {
        let entry = &raw[*form].entry;
        let (name, others) = (&entry.name, quoted(beside.iter().map(|k| raw[*k].entry.name.as_str())));
        fault = fault.note(format!(
            "the velocities of `{name}` are those of {others}: it repeats or contradicts them"
        ));
        let whole = &entry.written.text;
        if name != whole {
            fault = fault.help(format!(
                "impose the other components of `{whole}` one by one, as `{}: inner(e, vec(1, 0, 0)) = 0;`",
                crate::names::suffixed(whole, "_x")
            ));
        }
    }
    let positions: Vec<ExprId> = raw.iter().filter_map(|form| form.position).collect();
    if holonomic > 1 && combinations.is_empty() && forms.is_some() {
        fault =
            fault.note("no holonomic constraint is seen to follow from the others where all of them hold");
        if positions.iter().any(|e| eval.bench.graph.roles(*e).has(Role::Constant)) {
            fault = fault.note(
                "one that follows for particular values of constants only needs these as numbers, or as one constant where \
                 they are equal",
            );
        }
    }
    eval.faults.report(fault.help(format!(
        "remove {}, or declare {} more",
        plural(surplus, "form"),
        plural(surplus, "coordinate")
    )));
}

/// Constraints that are linear combinations of earlier constraints, each with those earlier ones.
fn combinations(bench: &mut Workbench, forms: &[(Form, ExprId)], degrees: usize) -> Vec<(usize, Vec<usize>)> {
    /// The number of forms above which the message says less.
    const EXAMINED_FORMS: usize = 24;
    let mut found = Vec::new();
    let mut independent: Vec<usize> = Vec::new();
    let mut depend = |own: &[usize]| {
        let rows: Vec<Vec<ExprId>> = own.iter().map(|k| forms[*k].0.row.clone()).collect();
        bench.zero.rank(&mut bench.graph, &rows, false).is_some_and(|rank| rank < rows.len())
    };
    for form in (degrees..forms.len()).take(EXAMINED_FORMS) {
        if !depend(&[&independent[..], &[form]].concat()) {
            independent.push(form);
            continue;
        }
        let mut beside = independent.clone();
        for k in &independent {
            let without: Vec<usize> = beside.iter().copied().filter(|other| other != k).collect();
            if depend(&[&without[..], &[form]].concat()) {
                beside = without;
            }
        }
        // Independent forms, as many as coordinates, span every form: then it is no fault that this one depends on them.
        if beside.len() < forms[form].0.row.len() {
            found.push((form, beside));
        }
    }
    found
}
