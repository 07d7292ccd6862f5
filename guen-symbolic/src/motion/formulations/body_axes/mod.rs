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
//! What comes out is one more list of rates for the optimiser, proved equal to the others. Where there are constraints on
//! positions everything is as it is on these (`restriction`): with a quaternion `R^T R = 1` holds there only.

mod slopes;
mod spin;

use self::spin::{Flows, Spin, column, in_parameters};
use crate::algebra::{ExprId, Flow, Rational};
use crate::motion::coordinates::restriction::{self, Restriction};
use crate::motion::definition::projection::{self, MeasuredForms};
use crate::motion::{Frame, KineticTerm, Mechanics, MotionEquations, RigidBody, Solution};
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// The equations in the axes of the bodies, and what the rates of coordinates are there.
pub(super) struct InBodyAxes {
    /// The equations without the generalised forces.
    pub(super) equations: MotionEquations,
    velocities: Vec<ExprId>,
}

impl InBodyAxes {
    /// The rates of the state, velocities first. Next to an edge of the parameters the products of a constant determinant cancel: by spins, which
    /// are there for digits at edges, what is divided by depends on the state.
    pub(super) fn rates(
        self,
        bench: &mut Workbench,
        system: &Mechanics,
        generalised_forces: &[ExprId],
        is_by_spins: bool,
    ) -> Vec<Vec<ExprId>> {
        let equations = self.equations.driven(bench, generalised_forces);
        let MotionEquations { mass, forces } = restriction::restricted(bench, system, equations);
        let mut solutions =
            vec![Solution::new(bench, &mass, &forces).ok(), Solution::shared(bench, &mass, &forces)];
        if !is_by_spins {
            solutions.push(Solution::by_constant_determinants(bench, &mass, &forces));
        }
        let lists = solutions.into_iter().flatten();
        lists.map(|solution| [&self.velocities[..], &solution.accelerations].concat()).collect()
    }
}

/// The equations in the axes of bodies; none where no chart has an edge, or no body is turned.
pub(super) fn equations(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    forms: &MeasuredForms,
) -> Option<InBodyAxes> {
    if frame.operators.chart.is_empty() {
        return None;
    }
    in_any_chart(bench, system, frame, forms)
}

/// The equations in the axes of bodies, whatever the chart; none where no body is turned.
pub(super) fn in_any_chart(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    forms: &MeasuredForms,
) -> Option<InBodyAxes> {
    let multibody = system.multibody.as_ref()?;
    if !bench.graph.is_zero(multibody.other_energy) {
        return None;
    }
    let mut restriction = Restriction::new(bench, system);
    let l = system.forms.degrees;
    let mut turned = Turned {
        terms: Vec::new(),
        forms: forms.clone(),
        velocities: frame.velocities.clone(),
        operators: frame.operators.xi[1..=l].to_vec(),
    };
    let is_constant = |bench: &Workbench, rows: &[[ExprId; 3]; 3]| {
        rows.iter().flatten().all(|e| bench.graph.roles(*e).is_constant())
    };
    let mut is_turned = false;
    for body in &multibody.bodies {
        match &body.orientation {
            Some(rows) if !is_constant(bench, rows) => {
                turned.turn(bench, system, frame, &mut restriction, body, rows)?;
                is_turned = true;
            }
            _ => turned.carry(bench, system, body)?,
        }
    }
    if !is_turned {
        return None;
    }
    let Turned { terms, forms, velocities, operators } = turned;
    let mut displacements: Vec<Flow> = operators
        .into_iter()
        .map(|xi| Flow::new(&bench.graph, system.forms.coordinates.iter().copied().zip(xi)))
        .collect();
    let (equations, _) =
        projection::assemble(bench, system, (0, &mut displacements), &mut frame.motion, &terms, &forms);
    let velocities =
        if restriction::stay(bench, system, &velocities) { velocities } else { frame.velocities.clone() };
    Some(InBodyAxes { equations, velocities })
}

/// The kinetic energy with the velocities of bodies in their own axes.
struct Turned {
    terms: Vec<KineticTerm>,
    forms: MeasuredForms,
    velocities: Vec<ExprId>,
    /// `xi_s` for `s = 1..l`.
    operators: Vec<Vec<ExprId>>,
}

impl Turned {
    /// A body that does not turn, in the forms that are known; `None` where they are others.
    fn carry(&mut self, bench: &mut Workbench, system: &Mechanics, body: &RigidBody) -> Option<()> {
        let Some(center) = body.center else { return Some(()) };
        for v in velocity(bench, system, center) {
            let (factor, form) = bench.graph.split_content(v);
            if bench.graph.is_zero(v) {
                continue;
            }
            if !self.forms.contains_key(&form) {
                return None;
            }
            let half = &(&factor * &factor) * &Rational::new(1, 2);
            let weight = bench.graph.scale(body.mass, &half);
            self.terms.push(KineticTerm { weight, forms: vec![form, form] });
        }
        Some(())
    }

    /// A body in its own axes; `None` where that is not possible.
    fn turn(
        &mut self,
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        restriction: &mut Restriction,
        body: &RigidBody,
        rows: &[[ExprId; 3]; 3],
    ) -> Option<()> {
        if !is_orthogonal(bench, rows) {
            return None;
        }
        let mut flows = Flows::new(bench, system, frame);
        let spin = Spin::new(bench, system, restriction, &mut flows, rows);
        if let Some(center) = body.center {
            let world: Vec<[ExprId; 3]> = (0..=system.forms.degrees)
                .map(|s| {
                    center.map(|x| {
                        let component = flows.along(bench, s, x);
                        restriction.tidy(bench, component)
                    })
                })
                .collect();
            let own = match spin.by_spin(bench, system, restriction, &mut flows, rows, &world) {
                Some(own) => own,
                None => in_parameters(bench, system, restriction, &mut flows, rows, &world)?,
            };
            let velocity = velocity(bench, system, center);
            let half = bench.graph.scale(body.mass, &Rational::new(1, 2));
            for a in 0..3 {
                // The exterior derivative of R^T v on (motion, X_s): omega_s x u - omega x u_s.
                let turning = spin.crossed(bench, a, &own);
                let form = bench.dot(&column(rows, a), &velocity);
                self.forms.insert(form, own.measured(a, turning));
                self.terms.push(KineticTerm { weight: half, forms: vec![form, form] });
            }
            // What is a coordinate's rate is known from them.
            for (row, v) in rows.iter().zip(velocity) {
                if let Some(k) = system.velocities.iter().position(|x| *x == v) {
                    self.velocities[k] = bench.dot(row, &own.values);
                    for (xi, along) in self.operators.iter_mut().zip(&own.along[1..]) {
                        xi[k] = bench.dot(row, along);
                    }
                }
            }
        }
        // The form of the angular velocity: [omega]x = R^T R'.
        let rates: Vec<[ExprId; 3]> = rows.iter().map(|row| velocity(bench, system, *row)).collect();
        let own = spin.triple(bench, system, restriction, &mut flows);
        let forms: [ExprId; 3] = std::array::from_fn(|a| {
            let (j, k) = ((a + 1) % 3, (a + 2) % 3);
            let form = bench.dot(&column(rows, k), &[rates[0][j], rates[1][j], rates[2][j]]);
            // That of the angular velocity is omega_s x omega.
            let turning = spin.crossed_with_itself(bench, a);
            self.forms.insert(form, own.measured(a, turning));
            form
        });
        let [x, y, z] = forms;
        let pairs = [(x, x), (y, y), (z, z), (x, y), (y, z), (z, x)];
        for (place, (moment, (u, v))) in body.inertia.iter().zip(pairs).enumerate() {
            if !bench.graph.is_zero(*moment) {
                // Products of inertia are in the energy twice.
                let weight =
                    if place < 3 { bench.graph.scale(*moment, &Rational::new(1, 2)) } else { *moment };
                self.terms.push(KineticTerm { weight, forms: vec![u, v] });
            }
        }
        Some(())
    }
}

/// The angular velocity of a body in its own axes, over velocities: half the antisymmetric part of `R^T R'`.
pub(super) fn spin(bench: &mut Workbench, system: &Mechanics, rows: &[[ExprId; 3]; 3]) -> [ExprId; 3] {
    let rates: Vec<[ExprId; 3]> = rows.iter().map(|row| velocity(bench, system, *row)).collect();
    std::array::from_fn(|a| {
        let (j, k) = ((a + 1) % 3, (a + 2) % 3);
        let [first, second] = [(k, j), (j, k)]
            .map(|(of, by)| bench.dot(&column(rows, of), &[rates[0][by], rates[1][by], rates[2][by]]));
        let difference = bench.graph.sub(first, second);
        bench.graph.scale(difference, &Rational::new(1, 2))
    })
}

/// The rates of functions of the coordinates, over velocities.
fn velocity(bench: &mut Workbench, system: &Mechanics, position: [ExprId; 3]) -> [ExprId; 3] {
    let coordinates = system.forms.coordinates.iter().copied().zip(system.velocities.iter().copied());
    let mut rate = Flow::new(&bench.graph, coordinates.chain([(system.forms.time, bench.graph.one())]));
    position.map(|x| rate.of(&mut bench.graph, x))
}

/// Whether `R^T R = 1` wherever constraints on positions hold.
fn is_orthogonal(bench: &mut Workbench, rows: &[[ExprId; 3]; 3]) -> bool {
    (0..3).all(|a| {
        (0..=a).all(|b| {
            let [first, second] = [a, b].map(|a| column(rows, a));
            let product = bench.dot(&first, &second);
            let expected = if a == b { bench.graph.one() } else { bench.graph.zero() };
            let difference = bench.graph.sub(product, expected);
            bench.verdict_on_manifold(difference) == Verdict::Zero
        })
    })
}
