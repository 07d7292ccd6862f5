//! Motion in the frame of the operators: velocities on the constraints, flows along `X_0..X_n` and along the motion.

use crate::algebra::{ExprId, Flow, Substitution};
use crate::geometry::{Brackets, Operators};
use crate::motion::Mechanics;
use crate::workbench::Workbench;

/// The operators, brackets and velocities that both routes to the equations need, each computed once.
pub struct Frame {
    /// The operators.
    pub operators: Operators,
    /// The brackets.
    pub brackets: Brackets,
    /// `x_i' = xi_0^i + sum_{s<=l} eta_s xi_s^i`, (1.8).
    pub velocities: Vec<ExprId>,
    /// `X_1..X_n` as derivatives, index from 0 for `X_1`.
    pub displacements: Vec<Flow>,
    /// The rate along the motion at fixed `eta`: `X_0 + sum_{s<=l} eta_s X_s`.
    pub motion: Flow,
    /// Puts an expression of `x'` and `eta` on the constraints: `x'` by (1.8), `eta_v = 0`.
    pub constrain: Substitution,
}

impl Frame {
    /// The frame of a system with known operators.
    pub fn new(bench: &mut Workbench, system: &Mechanics, operators: Operators) -> Self {
        let forms = &system.forms;
        let (n, l) = (forms.len(), forms.degrees);
        let brackets = Brackets::new(bench, forms, &operators);
        let velocities: Vec<ExprId> = (0..n)
            .map(|i| {
                let mut terms = vec![operators.xi[0][i]];
                for s in 1..=l {
                    terms.push(bench.graph.mul(system.etas[s - 1], operators.xi[s][i]));
                }
                let velocity = bench.graph.sum(terms);
                // Velocities are sums over all parameters: the rates of a quaternion are still written out.
                bench.keep_above(velocity, 60)
            })
            .collect();
        let displacements = (1..=n)
            .map(|j| {
                Flow::new(
                    &bench.graph,
                    forms.coordinates.iter().copied().zip(operators.xi[j].iter().copied()),
                )
            })
            .collect();
        let motion = Flow::new(
            &bench.graph,
            forms
                .coordinates
                .iter()
                .copied()
                .zip(velocities.iter().copied())
                .chain([(forms.time, bench.graph.one())]),
        );
        let zero = bench.graph.zero();
        let constrain = Substitution::new(
            system
                .velocities
                .iter()
                .copied()
                .zip(velocities.iter().copied())
                .chain(system.etas[l..].iter().map(|eta| (*eta, zero))),
        );
        Frame { operators, brackets, velocities, displacements, motion, constrain }
    }

    /// Returns `beta_s`, the component of a velocity form along `X_s`; the generalised forces are `Q_s = sum F beta_s`.
    pub fn component(&self, bench: &mut Workbench, form: &crate::motion::VelocityForm, s: usize) -> ExprId {
        // beta_s = sum_i b_i xi_s^i + c_s; for s = 0: sum_i b_i xi_0^i + u_0
        let mut terms: Vec<ExprId> =
            form.on_velocities.iter().map(|(i, b)| bench.graph.mul(*b, self.operators.xi[s][*i])).collect();
        if s == 0 {
            terms.push(form.offset);
        } else {
            terms.extend(form.on_etas.iter().filter(|(j, _)| *j + 1 == s).map(|(_, c)| *c));
        }
        bench.graph.sum(terms)
    }
}
