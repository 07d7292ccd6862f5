//! Proofs of what was found in different ways against the definition (2.7): before anything is emitted, at points modulo p.

use super::fault::DerivationError;
use super::{Equations, Frame, Mechanics, poincare};
use crate::algebra::{ExprId, Role};
use crate::workbench::Workbench;
use crate::zero::POINTS_WITH_ROOTS;
use crate::zero::field::{add, mul};

/// Points of a proof; at each of them a displacement is drawn, too.
const POINTS: usize = 3;

/// The equations (2.7) by definition: all of them, or their sum along one displacement
/// `sum_s w_s X_s` with symbols for the `w_s`. At a point modulo p these are numbers like all others, so that such a sum tells of
/// every displacement, at the cost of one.
pub(super) struct Definition {
    /// `w_1..w_l`; none where there is a row for each `X_s`.
    weights: Vec<ExprId>,
    /// Without the generalised forces, which are the same in all equations: not every one has values modulo p.
    equations: Equations,
    /// The generalised force of each row.
    generalised_forces: Vec<ExprId>,
}

impl Definition {
    /// All equations.
    pub(super) fn whole(equations: Equations, generalised_forces: &[ExprId]) -> Self {
        let generalised_forces = generalised_forces[..equations.forces.len()].to_vec();
        Definition { weights: Vec::new(), equations, generalised_forces }
    }

    /// Their sum along a displacement that is drawn.
    pub(super) fn along(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        generalised_forces: &[ExprId],
    ) -> Self {
        let weight = |s: usize| bench.graph.symbol(&format!("w{s}"), Role::Input);
        let weights: Vec<ExprId> = (1..=system.forms.degrees).map(weight).collect();
        let (mass, force) = poincare::along(bench, system, frame, &weights);
        let generalised_forces = vec![bench.dot(&weights, generalised_forces)];
        let equations = Equations { mass: vec![mass], forces: vec![force] };
        Definition { weights, equations, generalised_forces }
    }

    /// Whether equations without generalised forces are these, everywhere or wherever constraints on positions hold, but for roots of
    /// other sign. A proved difference is a mistake of ours.
    pub(super) fn is(
        &self,
        bench: &mut Workbench,
        equations: &Equations,
        on_manifold: bool,
    ) -> Result<bool, DerivationError> {
        let rows = equations.rows();
        let own = self.equations.rows();
        let is_met = if self.weights.is_empty() {
            same(bench, &own.concat(), &rows.concat(), on_manifold)
        } else {
            let (l, columns) = (rows.len(), own[0].len());
            let all = [&self.weights[..], &own[0], &rows.concat()].concat();
            hold(bench, &all, on_manifold, |values| {
                let (weights, values) = values.split_at(l);
                let (own, others) = values.split_at(columns);
                let entry = |s: usize, t: usize| mul(weights[s], others[s * columns + t]);
                (0..columns).all(|t| own[t] == (0..l).map(|s| entry(s, t)).fold(0, add))
            })
        };
        if is_met {
            return Ok(true);
        }
        let rows = match self.weights[..] {
            [] => rows,
            _ => {
                let column = |t: usize| -> Vec<ExprId> { rows.iter().map(|row| row[t]).collect() };
                vec![(0..own[0].len()).map(|t| bench.dot(&self.weights, &column(t))).collect()]
            }
        };
        for (equation, (own, others)) in own.iter().zip(&rows).enumerate() {
            for (a, b) in own.iter().zip(others) {
                let difference = bench.graph.sub(*a, *b);
                refuse(bench, difference, on_manifold, equation)?;
            }
        }
        Ok(false)
    }

    /// Whether rates of the state are those of the operators and solve the equations, wherever constraints on positions hold.
    /// Where only the sign of a root may differ they are not taken; a proved difference is a mistake of ours.
    pub(super) fn is_solved_by(
        &self,
        bench: &mut Workbench,
        velocities: &[ExprId],
        rates: &[ExprId],
    ) -> Result<bool, DerivationError> {
        let Equations { mass, forces } = &self.equations;
        let (moving, accelerations) = rates.split_at(velocities.len());
        let (l, rows) = (accelerations.len(), forces.len());
        let all = [accelerations, &mass.concat(), forces, &self.generalised_forces].concat();
        let is_solved = |values: &[u64]| {
            let (accelerations, values) = values.split_at(l);
            let (mass, values) = values.split_at(rows * l);
            let (forces, generalised_forces) = values.split_at(rows);
            let inertia = |s: usize| {
                let row = mass[s * l..][..l].iter();
                row.zip(accelerations).map(|(m, a)| mul(*m, *a)).fold(0, add)
            };
            (0..rows).all(|s| inertia(s) == add(forces[s], generalised_forces[s]))
        };
        if same(bench, velocities, moving, true) && hold(bench, &all, true, is_solved) {
            return Ok(true);
        }
        for (own, other) in velocities.iter().zip(moving) {
            let difference = bench.graph.sub(*own, *other);
            refuse(bench, difference, true, 0)?;
        }
        for (equation, row) in mass.iter().enumerate() {
            let inertia = bench.dot(row, accelerations);
            let force = bench.graph.add(forces[equation], self.generalised_forces[equation]);
            let difference = bench.graph.sub(inertia, force);
            refuse(bench, difference, true, equation)?;
        }
        Ok(false)
    }
}

/// Whether expressions are others at all points; what they have in common needs no values.
fn same(bench: &mut Workbench, a: &[ExprId], b: &[ExprId], on_manifold: bool) -> bool {
    let differences: Vec<ExprId> = a.iter().zip(b).map(|(a, b)| bench.graph.sub(*a, *b)).collect();
    hold(bench, &differences, on_manifold, |values| values.iter().all(|value| *value == 0))
}

/// Whether something holds of the values of expressions at all points: at many, as far as they are found, where signs may be right by
/// chance.
fn hold(bench: &mut Workbench, es: &[ExprId], on_manifold: bool, holds: impl Fn(&[u64]) -> bool) -> bool {
    let signs = es.iter().any(|e| bench.zero.has_signs(&bench.graph, *e));
    for point in 0..if signs { POINTS_WITH_ROOTS } else { POINTS } {
        match bench.zero.residues(&mut bench.graph, point, es, on_manifold) {
            Some(values) if holds(&values) => {}
            Some(_) => return false,
            None => return point >= POINTS,
        }
    }
    true
}

/// Ends with a difference that is shown not to vanish.
fn refuse(
    bench: &mut Workbench,
    difference: ExprId,
    on_manifold: bool,
    equation: usize,
) -> Result<(), DerivationError> {
    if bench.zero.is_shown_nonzero(&mut bench.graph, difference, on_manifold) {
        return Err(DerivationError::RoutesDisagree { equation });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Graph, Rational};

    /// `(c^2 + s^2 n) a' = g s` for an angle with sine `s` and cosine `c`, by the numbers `n` and `g`, and a coordinate that is one
    /// on the constraint.
    fn equations(bench: &mut Workbench, x: ExprId, [n, g]: [i64; 2], factor: ExprId) -> Equations {
        let (sine, cosine) = bench.graph.sin_cos(x);
        let graph = &mut bench.graph;
        let (s2, c2) = (graph.powi(sine, 2), graph.powi(cosine, 2));
        let mass = graph.linear(&[(c2, Rational::ONE), (s2, Rational::integer(n))]);
        let force = graph.linear(&[(sine, Rational::integer(g))]);
        Equations { mass: vec![vec![graph.mul(mass, factor)]], forces: vec![graph.mul(force, factor)] }
    }

    /// The same along `w X_1`.
    fn along(bench: &mut Workbench, equations: &Equations) -> Definition {
        let w = bench.graph.symbol("w1", Role::Input);
        let mut times = |e: ExprId| bench.graph.mul(w, e);
        let (mass, force) = (times(equations.mass[0][0]), times(equations.forces[0]));
        let equations = Equations { mass: vec![vec![mass]], forces: vec![force] };
        Definition { weights: vec![w], equations, generalised_forces: vec![bench.graph.zero()] }
    }

    #[test]
    fn equal_equations_are_proved_and_others_refused() {
        let mut bench = Workbench::new(Graph::new());
        let x = bench.graph.symbol("x", Role::Coordinate);
        let one = bench.graph.one();
        let zero = bench.graph.zero();
        let own = equations(&mut bench, x, [1, 3], one);
        let same = Equations { mass: vec![vec![one]], forces: own.forces.clone() };
        for definition in [Definition::whole(own.clone(), &[zero]), along(&mut bench, &own)] {
            assert_eq!(definition.is(&mut bench, &same, true).ok(), Some(true));
            for wrong in [[2, 3], [1, -3], [1, 4]] {
                let other = equations(&mut bench, x, wrong, one);
                assert!(definition.is(&mut bench, &other, true).is_err(), "{wrong:?}");
                if own.forces != other.forces {
                    assert!(definition.is_solved_by(&mut bench, &[], &other.forces).is_err(), "{wrong:?}");
                }
            }
            assert_eq!(definition.is_solved_by(&mut bench, &[], &own.forces).ok(), Some(true));
            let moving = [&[x][..], &own.forces].concat();
            assert_eq!(definition.is_solved_by(&mut bench, &[x], &moving).ok(), Some(true));
            assert!(definition.is_solved_by(&mut bench, &[one], &moving).is_err());
        }
    }

    /// Entries that are exchanged have the same sum along `X_1 + X_2`, and no other displacement.
    #[test]
    fn all_displacements_are_looked_at() {
        let mut bench = Workbench::new(Graph::new());
        let [x, y] = ["x", "y"].map(|name| bench.graph.symbol(name, Role::Coordinate));
        let weights = ["w1", "w2"].map(|name| bench.graph.symbol(name, Role::Input)).to_vec();
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let mass = vec![vec![one, zero], vec![zero, one]];
        let force = bench.dot(&weights, &[x, y]);
        let equations = Equations { mass: vec![weights.clone()], forces: vec![force] };
        let definition = Definition { weights, equations, generalised_forces: vec![zero] };
        let right = Equations { mass: mass.clone(), forces: vec![x, y] };
        assert_eq!(definition.is(&mut bench, &right, true).ok(), Some(true));
        let wrong = Equations { mass, forces: vec![y, x] };
        assert!(definition.is(&mut bench, &wrong, true).is_err());
        assert!(definition.is_solved_by(&mut bench, &[], &[y, x]).is_err());
    }

    #[test]
    fn on_a_constraint_they_need_be_equal_there_only() {
        let mut bench = Workbench::new(Graph::new());
        let x = bench.graph.symbol("x", Role::Coordinate);
        let length = bench.graph.symbol("r", Role::Coordinate);
        let one = bench.graph.one();
        let constraint = bench.graph.sub(length, one);
        let (own, other) = (equations(&mut bench, x, [1, 3], one), equations(&mut bench, x, [1, 3], length));
        let definition = Definition::whole(own, &[bench.graph.zero()]);
        assert!(definition.is(&mut bench, &other, true).is_err());
        bench.zero.set_manifold(&mut bench.graph, &[constraint]);
        assert_eq!(definition.is(&mut bench, &other, true).ok(), Some(true));
        assert!(definition.is(&mut bench, &other, false).is_err());
        let wrong = equations(&mut bench, x, [1, -3], length);
        assert!(definition.is(&mut bench, &wrong, true).is_err());
    }
}
