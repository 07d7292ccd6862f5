//! Generalised forces.

use super::velocity_forms::VelocityPartials;
use crate::algebra::ExprId;
use crate::motion::{Frame, Mechanics};
use crate::workbench::Workbench;

/// `Q_s = sum F beta_s`, with the force on the constraints.
pub(in crate::motion) fn generalised_forces(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
) -> Vec<ExprId> {
    let n = system.forms.len();
    let mut found: Vec<Vec<ExprId>> = vec![Vec::new(); n];
    for force in &system.forces {
        let magnitude = frame.constrain.of(&mut bench.graph, force.magnitude);
        // The caller has checked that `along` is a velocity form.
        let Some(form) = partials.affine(bench, force.along) else { continue };
        for (s, q) in found.iter_mut().enumerate() {
            let beta = frame.component(bench, &form, s + 1);
            let beta = bench.tidy(beta);
            q.push(bench.graph.mul(magnitude, beta));
        }
    }
    found.into_iter().map(|terms| bench.graph.sum(terms)).collect()
}
