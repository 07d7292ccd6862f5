//! Proofs of what was found in different ways against the definition (2.7): before anything is emitted, at points modulo p.

use super::fault::DerivationError;
use super::{Equations, Frame, Mechanics, poincare};
use crate::algebra::{ExprId, Flow, Role};
use crate::workbench::Workbench;
use crate::zero::POINTS_WITH_ROOTS;
use crate::zero::field::{add, mul};

/// Points of a proof; at each of them a displacement is drawn, too.
const POINTS: usize = 3;

/// The equations (2.7) by definition.
pub(super) struct Definition {
    rows: Rows,
    /// The generalised force of each row.
    generalised_forces: Vec<ExprId>,
}

/// Without the generalised forces, which are the same in all equations: not every one has values modulo p.
enum Rows {
    /// One for each `X_s`.
    Each(Equations),
    /// Their sum along one displacement.
    Along(Along),
}

/// `sum_s w_s (2.7)_s`, with symbols for the `w_s`. At a point modulo p these are numbers like all others, so that such a sum
/// tells of every displacement, at the cost of one.
struct Along {
    /// `w_1..w_l`.
    weights: Vec<ExprId>,
    /// `eta_1'..eta_l'`, symbols too.
    accelerations: Vec<ExprId>,
    /// `eta_1..eta_l`.
    etas: Vec<ExprId>,
    equation: poincare::Along,
}

impl Along {
    /// `sum_st w_s M_st eta_t'` with these `eta_t'`.
    fn inertia(&self, bench: &mut Workbench, accelerations: &[ExprId]) -> ExprId {
        let rates = self.etas.iter().copied().zip(accelerations.iter().copied());
        Flow::new(&bench.graph, rates).of(&mut bench.graph, self.equation.momentum)
    }

    /// Inertia and force of equations along the displacement, at a point or as expressions.
    fn sum<T: Copy>(
        (weights, accelerations): (&[T], &[T]),
        rows: &[Vec<T>],
        mut dot: impl FnMut(&[T], &[T]) -> T,
    ) -> (T, T) {
        let l = accelerations.len();
        let inertias: Vec<T> = rows.iter().map(|row| dot(&row[..l], accelerations)).collect();
        let forces: Vec<T> = rows.iter().map(|row| row[l]).collect();
        (dot(weights, &inertias), dot(weights, &forces))
    }
}

impl Definition {
    /// All equations.
    pub(super) fn whole(equations: Equations, generalised_forces: &[ExprId]) -> Self {
        let generalised_forces = generalised_forces[..equations.forces.len()].to_vec();
        Definition { rows: Rows::Each(equations), generalised_forces }
    }

    /// Their sum along a displacement that is drawn.
    pub(super) fn along(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        generalised_forces: &[ExprId],
    ) -> Self {
        let l = system.forms.degrees;
        // No declaration has names with a blank.
        let weight = |s: usize| bench.graph.symbol(&format!("w {s}"), Role::Input);
        let weights: Vec<ExprId> = (1..=l).map(weight).collect();
        let equation = poincare::along(bench, system, frame, &weights);
        let generalised_forces = vec![bench.dot(&weights, &generalised_forces[..l])];
        let [accelerations, etas] =
            [&system.accelerations, &system.etas].map(|symbols| symbols[..l].to_vec());
        Definition { rows: Rows::Along(Along { weights, accelerations, etas, equation }), generalised_forces }
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
        let (own, others) = match &self.rows {
            Rows::Each(own) => {
                let own = own.rows();
                if same(bench, &own.concat(), &rows.concat(), on_manifold) {
                    return Ok(true);
                }
                (own, rows)
            }
            Rows::Along(along) => {
                let (weights, accelerations) = (&along.weights, &along.accelerations);
                let own = vec![along.inertia(bench, accelerations), along.equation.force];
                let l = weights.len();
                let is_met = |values: &[u64]| {
                    let (drawn, values) = values.split_at(2 * l);
                    let (own, others) = values.split_at(2);
                    let rows: Vec<Vec<u64>> = others.chunks(l + 1).map(<[u64]>::to_vec).collect();
                    let dot = |a: &[u64], b: &[u64]| a.iter().zip(b).map(|(a, b)| mul(*a, *b)).fold(0, add);
                    Along::sum(drawn.split_at(l), &rows, dot) == (own[0], own[1])
                };
                let all = [&weights[..], accelerations, &own, &rows.concat()].concat();
                if hold(bench, &all, on_manifold, is_met) {
                    return Ok(true);
                }
                let (inertia, force) = Along::sum((weights, accelerations), &rows, |a, b| bench.dot(a, b));
                (vec![own], vec![vec![inertia, force]])
            }
        };
        for (equation, (own, others)) in own.iter().zip(&others).enumerate() {
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
        let (moving, accelerations) = rates.split_at(velocities.len());
        let is_solved = same(bench, velocities, moving, true)
            && match &self.rows {
                Rows::Each(Equations { mass, forces }) => {
                    let (l, rows) = (accelerations.len(), forces.len());
                    let all = [accelerations, &mass.concat(), forces, &self.generalised_forces].concat();
                    hold(bench, &all, true, |values| {
                        let (accelerations, values) = values.split_at(l);
                        let (mass, values) = values.split_at(rows * l);
                        let (forces, generalised_forces) = values.split_at(rows);
                        let inertia = |s: usize| {
                            let row = mass[s * l..][..l].iter();
                            row.zip(accelerations).map(|(m, a)| mul(*m, *a)).fold(0, add)
                        };
                        (0..rows).all(|s| inertia(s) == add(forces[s], generalised_forces[s]))
                    })
                }
                Rows::Along(along) => {
                    let inertia = along.inertia(bench, accelerations);
                    let all = [inertia, along.equation.force, self.generalised_forces[0]];
                    hold(bench, &all, true, |values| values[0] == add(values[1], values[2]))
                }
            };
        if is_solved {
            return Ok(true);
        }
        for (own, other) in velocities.iter().zip(moving) {
            let difference = bench.graph.sub(*own, *other);
            refuse(bench, difference, true, 0)?;
        }
        let (inertias, forces) = match &self.rows {
            Rows::Each(Equations { mass, forces }) => {
                (mass.iter().map(|row| bench.dot(row, accelerations)).collect(), forces.clone())
            }
            Rows::Along(along) => (vec![along.inertia(bench, accelerations)], vec![along.equation.force]),
        };
        for (equation, inertia) in inertias.into_iter().enumerate() {
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
        drawn(bench, &["w1"], equations)
    }

    /// Equations along a displacement that is drawn.
    fn drawn(bench: &mut Workbench, weights: &[&str], equations: &Equations) -> Definition {
        let symbols = |bench: &mut Workbench, kind: &str| -> Vec<ExprId> {
            weights.iter().map(|w| bench.graph.symbol(&format!("{kind}{w}"), Role::QuasiVelocity)).collect()
        };
        let [weights, accelerations, etas] = ["", "rate of ", "speed "].map(|kind| symbols(bench, kind));
        let momenta: Vec<ExprId> = equations.mass.iter().map(|row| bench.dot(row, &etas)).collect();
        let momentum = bench.dot(&weights, &momenta);
        let equation = poincare::Along { momentum, force: bench.dot(&weights, &equations.forces) };
        let rows = Rows::Along(Along { weights, accelerations, etas, equation });
        Definition { rows, generalised_forces: vec![bench.graph.zero()] }
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
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let mass = vec![vec![one, zero], vec![zero, one]];
        let own = Equations { mass: mass.clone(), forces: vec![x, y] };
        let definition = drawn(&mut bench, &["w1", "w2"], &own);
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
