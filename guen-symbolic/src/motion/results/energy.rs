//! Energies and momenta of the motion, and what is conserved.

use core::ops::Range;

use crate::algebra::{ExprId, Rational};
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::{Frame, KineticTerm, Mechanics};
use crate::workbench::Workbench;

/// Energies and momenta as functions of `t, x, eta_1..eta_l`.
#[derive(Clone, Debug)]
pub struct Energies {
    /// `T`, the kinetic energy on the constraints.
    pub kinetic: ExprId,
    /// `h = sum_i x_i' dT°/dx_i' - T° - U`, the energy integral.
    pub integral: ExprId,
    /// `dT/d eta_s` for `s <= l`, then `(dT°/d eta_v)` for `v > l`, (2.8); none where the equations are not written out.
    pub momenta: Vec<ExprId>,
}

impl Energies {
    /// Makes `h = sum w (u v - u v_c - v u_c) - U` from the terms `w u v` of `T°`, where `u_c` is the part of `u`
    /// that does not depend on `x'`. Momenta are those of the forms that are wanted, the first ones.
    pub fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        partials: &mut VelocityPartials,
        terms: &[KineticTerm],
        wanted: Range<usize>,
    ) -> Self {
        let mut kinetic = Vec::new();
        let mut integral = vec![bench.graph.neg(system.force_function)];
        let mut momenta: Vec<Vec<ExprId>> = vec![Vec::new(); wanted.len()];
        let is_catastatic = system.forms.forms.iter().all(|form| bench.graph.is_zero(form.offset));
        for term in terms {
            let mut values = Vec::new();
            let mut resting = Vec::new();
            for u in &term.forms {
                values.push(frame.constrain.of(&mut bench.graph, *u));
                if wanted.is_empty() && is_catastatic {
                    // The part without velocities is all that is needed of the form.
                    let offset = partials.at_rest(bench, *u);
                    resting.push(bench.tidy(offset));
                    continue;
                }
                let form = partials.affine(bench, *u).expect("the decomposition yields affine forms");
                // eta_j = sum a_ji x_i' + a_j0: the offset of the form joins the part without velocity.
                let mut offset = vec![form.offset];
                for (j, c) in &form.on_etas {
                    offset.push(bench.graph.mul(*c, system.forms.forms[*j].offset));
                }
                let offset = bench.graph.sum(offset);
                resting.push(bench.tidy(offset));
                let others: Vec<ExprId> = term.forms.clone();
                // dT°/d eta_j of w u v: w v beta^u_j for this factor u.
                let place = values.len() - 1;
                for (j, momentum) in momenta.iter_mut().enumerate() {
                    let beta = frame.component(bench, &form, j + 1);
                    if bench.graph.is_zero(beta) {
                        continue;
                    }
                    let mut factors = vec![(term.weight, 1), (beta, 1)];
                    for (k, other) in others.iter().enumerate() {
                        if k != place {
                            factors.push((frame.constrain.of(&mut bench.graph, *other), 1));
                        }
                    }
                    momentum.push(bench.graph.product(&factors));
                }
            }
            let product = |bench: &mut Workbench, factors: &[ExprId]| {
                let factors: Vec<_> = factors.iter().copied().chain([term.weight]).map(|f| (f, 1)).collect();
                bench.graph.product(&factors)
            };
            kinetic.push(product(bench, &values));
            match (&values[..], &resting[..]) {
                ([u, v], [uc, vc]) => {
                    integral.push(product(bench, &[*u, *v]));
                    for (moving, fixed) in [(*u, *vc), (*v, *uc)] {
                        let cross = product(bench, &[moving, fixed]);
                        integral.push(bench.graph.scale(cross, &Rational::MINUS_ONE));
                    }
                }
                // w u with u = u_lin + u_c contributes -w u_c, a constant w contributes -w.
                ([_], [uc]) => {
                    let part = product(bench, &[*uc]);
                    integral.push(bench.graph.neg(part));
                }
                _ => integral.push(bench.graph.neg(term.weight)),
            }
        }
        Energies {
            kinetic: bench.graph.sum(kinetic),
            integral: bench.graph.sum(integral),
            momenta: momenta.into_iter().map(|terms| bench.graph.sum(terms)).collect(),
        }
    }
}
