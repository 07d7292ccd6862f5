//! The equations with the velocities of rigid bodies in the bodies' own axes.
//!
//! `|v|^2 = |R^T v|^2`: the velocity of a mass centre may be taken apart along the axes of its body. What rolls has shorter
//! velocities there, for the contact belongs to the body; they do not know of the heading; and where the angles of `R` have a
//! pole the body does not. In the world's axes the acceleration of the centre is found from the rates of the angles, by
//! terms that grow like the inverse square of the distance from that pole, and cancel. Here it is
//!
//! ```text
//! u' + omega x u,   u = R^T v,
//! ```
//!
//! with the angular velocity of the body along the motion and along every `X_s`, each in normal form.
//!
//! What comes out is one more list of rates for the optimiser, proved equal to the others.

mod spin;

use self::spin::{Flows, Spin, Triple, column, in_parameters};
use super::projection::{self, MeasuredForms};
use super::{Frame, KineticTerm, Mechanics, RigidBody, Solution};
use crate::algebra::{ExprId, Rational};
use crate::workbench::Workbench;

/// The rates of the state, velocities first; none where no chart has an edge, or no body is turned.
pub(super) fn rates(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    terms: &[KineticTerm],
    forms: &MeasuredForms,
    generalised_forces: &[ExprId],
) -> Vec<Vec<ExprId>> {
    if frame.operators.chart.is_empty() {
        return Vec::new();
    }
    let l = system.forms.degrees;
    let mut turned =
        Turned { terms: terms.to_vec(), forms: forms.clone(), velocities: frame.velocities.clone() };
    let mut found = false;
    for body in &system.bodies {
        found |= turned.turn(bench, system, frame, body).is_some();
    }
    if !found {
        return Vec::new();
    }
    turned.terms.retain(|term| !bench.graph.is_zero(term.weight));
    let Turned { terms, forms, velocities } = turned;
    let (equations, _) =
        projection::assemble(bench, system, &mut frame.displacements[..l], &mut frame.motion, &terms, &forms);
    let forces: Vec<ExprId> =
        equations.forces.iter().zip(generalised_forces).map(|(f, q)| bench.graph.add(*f, *q)).collect();
    let solutions = [
        Solution::new(bench, &equations.mass, &forces).ok(),
        Solution::shared(bench, &equations.mass, &forces),
    ];
    let lists = solutions.into_iter().flatten();
    lists.map(|solution| [&velocities[..], &solution.accelerations].concat()).collect()
}

/// The kinetic energy with some bodies' velocities in their own axes.
struct Turned {
    terms: Vec<KineticTerm>,
    forms: MeasuredForms,
    velocities: Vec<ExprId>,
}

impl Turned {
    /// Takes the velocity of one body apart along its axes; `None` where that is not possible, or promises nothing.
    fn turn(
        &mut self,
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        body: &RigidBody,
    ) -> Option<()> {
        let l = system.forms.degrees;
        let rows = &body.orientation;
        if rows.iter().flatten().all(|e| bench.graph.roles(*e).is_constant()) || !is_orthogonal(bench, rows) {
            return None;
        }
        // The places of the velocity's squares, each with its factor.
        let mut squares: Vec<(usize, usize, Rational, ExprId)> = Vec::new();
        for (i, v) in body.velocity.iter().enumerate() {
            if bench.graph.is_zero(*v) {
                continue;
            }
            let (factor, form) = bench.graph.split_content(*v);
            let place = self.terms.iter().position(|term| term.forms[..] == [form, form])?;
            // A true velocity is a closed form.
            if !self.forms[&form].turning.iter().all(|e| bench.graph.is_zero(*e)) {
                return None;
            }
            squares.push((i, place, factor, form));
        }
        if squares.is_empty() {
            return None;
        }
        let mut flows = Flows::new(bench, system, frame);
        let spin = Spin::new(bench, system, &mut flows, rows);
        let mut world = vec![[bench.graph.zero(); 3]; l + 1];
        for (i, _, factor, form) in &squares {
            let form = &self.forms[form];
            for (s, world) in world.iter_mut().enumerate() {
                let component = if s == 0 { form.drift } else { form.components[s - 1] };
                world[*i] = bench.graph.scale(component, factor);
            }
        }
        let moving = match spin.by_spin(bench, system, &mut flows, rows, &world) {
            Some(own) => own,
            None => in_parameters(bench, system, &mut flows, rows, &world)?,
        };
        let rates = spin.rates(bench, system, &mut flows);
        let own = Triple { along: spin.along.clone(), values: spin.values, rates };
        let half = bench.graph.scale(body.mass, &Rational::new(1, 2));
        for (_, place, factor, _) in &squares {
            let share = bench.graph.scale(half, &(factor * factor));
            self.terms[*place].weight = bench.graph.sub(self.terms[*place].weight, share);
        }
        for a in 0..3 {
            let form = bench.dot(&column(rows, a), &body.velocity);
            // The exterior derivative of R^T v on (motion, X_s): omega_s x u - omega x u_s.
            let turning = spin.crossed(bench, a, &moving);
            self.forms.insert(form, moving.measured(a, turning));
            self.terms.push(KineticTerm { weight: half, forms: vec![form, form] });
            // That of the angular velocity itself is omega_s x omega.
            let (factor, form) = bench.graph.split_content(body.spin[a]);
            if let (Some(inverse), true) = (factor.recip(), self.forms.contains_key(&form)) {
                let turning = spin.crossed_with_itself(bench, a);
                let measured = own.measured(a, turning).scaled(bench, &inverse);
                self.forms.insert(form, measured);
            }
        }
        // What is a coordinate's rate is known from them.
        for (i, _, _, form) in squares {
            if let Some(k) = system.velocities.iter().position(|x| *x == form && *x == body.velocity[i]) {
                self.velocities[k] = bench.dot(&rows[i], &moving.values);
            }
        }
        Some(())
    }
}

/// Whether `R^T R = 1` as a function of everything.
fn is_orthogonal(bench: &mut Workbench, rows: &[[ExprId; 3]; 3]) -> bool {
    (0..3).all(|a| {
        (0..=a).all(|b| {
            let [first, second] = [a, b].map(|a| column(rows, a));
            let product = bench.dot(&first, &second);
            let expected = if a == b { bench.graph.one() } else { bench.graph.zero() };
            let difference = bench.graph.sub(product, expected);
            bench.vanishes(difference)
        })
    })
}
