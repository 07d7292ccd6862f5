//! Equations, momenta and reactions of bodies, from the tree that hangs on nothing but its joints.
//!
//! Where the rates of a system are those of its bodies, the quadratic form of the bodies at the root gives everything else, too. With
//! the constraints taken for parameters that stay zero it is
//!
//! ```text
//! sum_t M_jt eta_t' = f_j + lambda_j,   dT°/d eta_j = sum_t M_jt eta_t,   j = 1..n,  t = 1..l
//! ```
//!
//! with `lambda_j = 0` for a parameter, and the second only where no velocity remains at `eta = 0`.

use crate::algebra::ExprId;
use crate::motion::MotionEquations;
use crate::motion::derivation::Derivation;
use crate::motion::formulations::multibody;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::results::agreement::agree;
use crate::motion::thresholds::RESTATED;
use crate::program::weighted_cost;
use crate::workbench::Workbench;

impl Derivation {
    /// Takes the momenta and the reactions from the quadratic form of the bodies where they are long and that is half as long, and the
    /// equations where the rates shown are those of the bodies.
    pub fn restate_by_bodies(&mut self, bench: &mut Workbench) {
        let is_long = |bench: &Workbench, es: &[ExprId]| weighted_cost(&bench.graph, es) > RESTATED;
        let known: Vec<ExprId> = self.reactions.iter().flatten().copied().collect();
        let is_shown = self.formulations.first().is_some_and(|first| first.name == "bodies");
        let is_asked = is_shown || is_long(bench, &known) || is_long(bench, &self.energies.momenta);
        if !is_asked || !self.is_by("bodies") || !self.is_written_out() {
            return;
        }
        let mut partials = VelocityPartials::of_system(bench, &self.system);
        let (before, forces) = (self.freed.take(), &self.generalised_forces);
        let freed =
            before.or_else(|| multibody::freed(bench, &self.system, &self.frame, &mut partials, forces));
        let Some(freed) = freed else { return };
        let l = self.system.forms.degrees;
        let is_proved = |bench: &mut Workbench, own: &[ExprId], other: &[ExprId], times: u64| {
            is_long(bench, own)
                && times * weighted_cost(&bench.graph, other) < weighted_cost(&bench.graph, own)
                && agree(bench, own, other)
        };
        let rows = MotionEquations { mass: freed.mass[..l].to_vec(), forces: freed.forces[..l].to_vec() };
        if is_shown && is_proved(bench, &self.equations.entries(), &rows.entries(), 1) {
            self.equations = rows;
        }
        // What is multiplied out becomes shorter when code is made of it than what bodies give: they must promise half.
        let momenta: Vec<ExprId> =
            freed.mass.iter().map(|row| bench.dot(row, &self.system.etas[..l])).collect();
        if is_proved(bench, &self.energies.momenta, &momenta, 2) {
            self.energies.momenta = momenta;
        }
        let reactions: Vec<ExprId> = freed.mass[l..]
            .iter()
            .zip(&freed.forces[l..])
            .map(|(row, force)| {
                let inertia = bench.dot(row, &self.system.accelerations);
                bench.graph.sub(inertia, *force)
            })
            .collect();
        let pairs = self.reactions.iter().zip(&reactions);
        let others: Vec<ExprId> = pairs.filter_map(|(own, other)| own.map(|_| *other)).collect();
        if is_proved(bench, &known, &others, 2) {
            for (own, other) in self.reactions.iter_mut().zip(reactions) {
                *own = own.map(|_| other);
            }
        }
    }
}
