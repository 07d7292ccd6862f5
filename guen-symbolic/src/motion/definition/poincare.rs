//! The equations of motion (2.7), literally: the definition, and the oracle for the other route.

use crate::algebra::{ExprId, Flow, Substitution};
use crate::motion::{Frame, Mechanics, MotionEquations};
use crate::workbench::Workbench;

/// `sum_t M_st eta_t' = f_s` for `s = 1..l` without the generalised forces `Q_s`, before any simplification, from
///
/// ```text
/// d/dt dT/d eta_s - X_s(T + U) - sum_{t<=l} (C_0st + sum_r eta_r C_rst) dT/d eta_t
///                              - sum_{v>l}  (C_0sv + sum_r eta_r C_rsv) (dT°/d eta_v) = Q_s.       (2.7)
/// ```
pub fn equations(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> MotionEquations {
    let l = system.forms.degrees;
    let Energy { kinetic, momenta } = Energy::new(bench, system, frame);
    let lagrangian = bench.graph.add(kinetic, system.force_function);
    let mut mass = Vec::with_capacity(l);
    let mut forces = Vec::with_capacity(l);
    for s in 1..=l {
        mass.push(
            (0..l)
                .map(|t| Flow::partial(&bench.graph, system.etas[t]).of(&mut bench.graph, momenta[s - 1]))
                .collect(),
        );
        let rate = frame.motion.of(&mut bench.graph, momenta[s - 1]);
        let mut terms =
            vec![bench.graph.neg(rate), frame.displacements[s - 1].of(&mut bench.graph, lagrangian)];
        for (t, momentum) in momenta.iter().enumerate() {
            let turning = frame.brackets.along_motion(bench, &system.etas, s, t + 1);
            terms.push(bench.graph.mul(turning, *momentum));
        }
        forces.push(bench.graph.sum(terms));
    }
    MotionEquations { mass, forces }
}

/// `T°`, with every parameter free, and `T`, on the constraints.
fn kinetic(bench: &mut Workbench, system: &Mechanics, frame: &Frame) -> (ExprId, ExprId) {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    // x' = xi_0 + sum_{j<=n} eta_j xi_j.
    let free: Vec<ExprId> = (0..n)
        .map(|i| {
            let mut terms = vec![frame.velocities[i]];
            for j in l + 1..=n {
                terms.push(bench.graph.mul(system.etas[j - 1], frame.operators.xi[j][i]));
            }
            bench.graph.sum(terms)
        })
        .collect();
    let mut release = Substitution::new(system.velocities.iter().copied().zip(free));
    let dropped = release.of(&mut bench.graph, system.kinetic_energy);
    (dropped, on_constraints(bench, system).of(&mut bench.graph, dropped))
}

/// `eta_v = 0`.
fn on_constraints(bench: &Workbench, system: &Mechanics) -> Substitution {
    let zero = bench.graph.zero();
    Substitution::new(system.etas[system.forms.degrees..].iter().map(|eta| (*eta, zero)))
}

/// `T` on the constraints, and the momenta `(dT°/d eta_j)` there.
struct Energy {
    kinetic: ExprId,
    momenta: Vec<ExprId>,
}

impl Energy {
    fn new(bench: &mut Workbench, system: &Mechanics, frame: &Frame) -> Self {
        let (dropped, kinetic) = kinetic(bench, system, frame);
        let mut constrain = on_constraints(bench, system);
        let momenta: Vec<ExprId> = system
            .etas
            .iter()
            .map(|eta| {
                // The momenta (dT°/d eta_v) are taken first and put on the constraints afterwards, (2.8).
                let momentum = Flow::partial(&bench.graph, *eta).of(&mut bench.graph, dropped);
                constrain.of(&mut bench.graph, momentum)
            })
            .collect();
        Energy { kinetic, momenta }
    }
}
