//! Functions that are constant where the holonomic constraints hold.

use crate::algebra::{ExprId, Role, Roles};
use crate::motion::{Frame, Mechanics};
use crate::workbench::Workbench;

/// Whether a function is constant on the holonomic constraints: `X_j f = 0` there for all `j` whose displacement stays on them.
pub(in crate::motion) fn rests(bench: &mut Workbench, system: &Mechanics, frame: &Frame, e: ExprId) -> bool {
    // Where it vanishes on all of them it rests, and its derivatives may be large.
    if bench.is_seen_to_vanish(e) {
        return true;
    }
    let forms = &system.forms;
    let by_time = bench.partial(e, forms.time);
    let gradient: Vec<ExprId> = forms.coordinates.iter().map(|x| bench.partial(e, *x)).collect();
    (0..=forms.len()).filter(|j| system.holonomic.iter().all(|h| h.form + 1 != *j)).all(|j| {
        let rate = bench.dot(&frame.operators.xi[j], &gradient);
        let rate = if j == 0 { bench.graph.add(by_time, rate) } else { rate };
        bench.is_seen_to_vanish(rate)
    })
}

/// Whether all derivatives by the variables vanish where the holonomic constraints hold.
pub(in crate::motion) fn is_constant(bench: &mut Workbench, e: ExprId, variables: &[ExprId]) -> bool {
    variables.iter().all(|x| {
        let slope = bench.partial(e, *x);
        bench.graph.is_zero(slope) || bench.is_seen_to_vanish(slope)
    })
}

/// Whether a function that is constant wherever it has derivatives is another constant elsewhere, as `sign(x)` is.
pub(in crate::motion) fn jumps(bench: &mut Workbench, e: ExprId) -> bool {
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    bench.graph.roles(e).meets(moving) && bench.zero.has_several_values(&bench.graph, e)
}
