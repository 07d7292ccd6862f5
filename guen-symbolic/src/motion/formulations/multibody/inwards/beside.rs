//! Energies beside those of the bodies, of rotors and springs say: Lagrange's equations in the rates of the coordinates.
//!
//! ```text
//! D_ij = d2T / dx_i' dx_j',   f_i = d(T + U)/dx_i - D(dT/dx_i')
//! ```
//!
//! with the rate `D` at `x'' = 0`. Both go to the rates of the coordinates, as velocities among the others.

use crate::algebra::{ExprId, Flow, Substitution};
use crate::motion::Mechanics;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::workbench::Workbench;

/// The inertia and the force of the energies beside those of the bodies, for the rate of one coordinate.
pub(in crate::motion) struct Row {
    /// `i`.
    pub(in crate::motion) coordinate: usize,
    /// `(j, D_ij)`.
    pub(in crate::motion) inertia: Vec<(usize, ExprId)>,
    /// `f_i`.
    pub(super) force: ExprId,
}

/// The rows that do not vanish; `None` where the energy is not quadratic by itself.
pub(in crate::motion) fn rows(
    bench: &mut Workbench,
    system: &Mechanics,
    partials: &mut VelocityPartials,
) -> Option<Vec<Row>> {
    let multibody = system.multibody.as_ref()?;
    let mut written = Vec::new();
    for (eta, form) in system.etas.iter().zip(&system.forms.forms) {
        let linear = bench.dot(&form.row, &system.velocities);
        written.push((*eta, bench.graph.add(linear, form.offset)));
    }
    let energy = Substitution::new(written).of(&mut bench.graph, multibody.other_energy);
    let coordinates = &system.forms.coordinates;
    let rates = coordinates.iter().copied().zip(system.velocities.iter().copied());
    let one = bench.graph.one();
    let mut motion = Flow::new(&bench.graph, rates.chain([(system.forms.time, one)]));
    let whole = bench.graph.add(energy, multibody.other_force_function);
    let mut rows = Vec::new();
    for (i, x) in coordinates.iter().enumerate() {
        let momentum = partials.by(bench, i, energy);
        let inertia = partials.affine(bench, momentum)?.on_velocities;
        let slope = bench.partial(whole, *x);
        let rate = motion.of(&mut bench.graph, momentum);
        let force = bench.graph.sub(slope, rate);
        if !inertia.is_empty() || !bench.graph.is_zero(force) {
            rows.push(Row { coordinate: i, inertia, force });
        }
    }
    Some(rows)
}
