//! The reason why a system is called rheonomic, acatastatic or not conservative.

use crate::derive::Subject;
use crate::names::quoted;

/// A line for each of these properties that a system does not have.
pub(super) fn of(subject: &Subject<'_, '_>) -> Vec<String> {
    let d = &subject.level.derivation;
    let graph = &subject.model.bench.graph;
    let (system, l) = (&d.system, d.system.forms.degrees);
    let named = |holds: &dyn Fn(usize) -> bool| -> Vec<&str> {
        let found = (l..system.forms.forms.len()).filter(|v| holds(*v));
        found.map(|v| subject.model.forms[v].name.as_str()).collect()
    };
    let mut lines = Vec::new();
    if !d.scleronomic {
        let moving = named(&|v| {
            let form = &system.forms.forms[v];
            let all: Vec<_> = form.row.iter().chain([&form.offset]).copied().collect();
            graph.reachable(&all, |_| false).contains(&system.forms.time)
        });
        lines.push(match moving.is_empty() {
            true => "rheonomic: time occurs in T or U".to_owned(),
            false => format!("rheonomic: time occurs in {}", quoted(moving.into_iter())),
        });
    }
    if !d.catastatic {
        let offset = named(&|v| !graph.is_zero(system.forms.forms[v].offset));
        lines.push(format!("acatastatic: a part without velocities is in {}", quoted(offset.into_iter())));
    }
    if !d.conservative {
        let forced = d.generalised_forces.iter().any(|q| !graph.is_zero(*q));
        let causes = [(forced, "forces"), (!d.catastatic, "constraints that move"), (!d.scleronomic, "time")];
        let causes: Vec<&str> = causes.iter().filter(|(holds, _)| *holds).map(|(_, cause)| *cause).collect();
        lines.push(format!("not conservative: h changes, by {}", causes.join(", ")));
    }
    lines
}
