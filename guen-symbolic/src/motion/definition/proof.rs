//! Proofs of what was found in different ways against the definition (2.7): before anything is emitted, at points modulo p.

use super::lagrange::{Lagrange, Point};
use super::poincare;
use crate::algebra::ExprId;
use crate::motion::fault::DerivationError;
use crate::motion::{Frame, Mechanics, MotionEquations};
use crate::workbench::Workbench;
use crate::zero::field::{add, mul, sub};
use crate::zero::{FEWEST_POINTS_WITH_ROOTS, REDRAWS};

/// Points of a proof.
const PROOF_POINTS: usize = 3;
/// Points of a proof where each may have a sign right by chance, and hardly any has all the roots.
const PROOF_POINTS_WITH_SIGNS: usize = 12;

/// The equations (2.7): their left sides at points, and where points do not decide, as expressions.
pub(in crate::motion) struct Definition {
    at_points: Lagrange,
    /// The equations by definition, without the generalised forces, once they were asked for.
    written: Option<MotionEquations>,
    /// The generalised force of each row.
    generalised_forces: Vec<ExprId>,
}

/// The verdict of points on equations.
enum Seen {
    /// The equations hold.
    Holds,
    /// Values differ in this row.
    Differs(usize),
    /// Too few points have values.
    Few,
}

impl Definition {
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        generalised_forces: &[ExprId],
    ) -> Self {
        let generalised_forces = generalised_forces[..system.forms.degrees].to_vec();
        Definition { at_points: Lagrange::new(bench, system), written: None, generalised_forces }
    }

    /// The equations by definition, without the generalised forces.
    pub(in crate::motion) fn written(
        &mut self,
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
    ) -> &MotionEquations {
        self.written.get_or_insert_with(|| poincare::equations(bench, system, frame))
    }

    /// Whether equations without generalised forces are these, with those of the reactions behind them or without, everywhere or
    /// wherever constraints on positions hold, but for roots of other sign. A proved difference is a mistake of ours.
    pub(in crate::motion) fn is(
        &mut self,
        bench: &mut Workbench,
        (system, frame): (&Mechanics, &mut Frame),
        equations: &MotionEquations,
        on_manifold: bool,
    ) -> Result<bool, DerivationError> {
        let l = system.forms.degrees;
        let rows = equations.rows();
        let all = [&system.accelerations[..l], &rows.concat()].concat();
        let seen = self.compare_values(bench, system, (&all, on_manifold), |point, values| {
            let (accelerations, values) = values.split_at(l);
            let left = point.left_sides(accelerations)?;
            let right = values.chunks(l + 1).map(|row| sub(dot(&row[..l], accelerations), row[l]));
            Some(left.into_iter().zip(right).position(|(left, right)| left != right))
        });
        if self.decided(bench, system, (&all, on_manifold), seen)? {
            return Ok(true);
        }
        let own = self.written(bench, system, frame).rows();
        for (equation, (own, others)) in own.iter().zip(&rows).enumerate() {
            for (a, b) in own.iter().zip(others) {
                let difference = bench.graph.sub(*a, *b);
                refuse(bench, difference, on_manifold, equation)?;
            }
        }
        Ok(false)
    }

    /// Whether rows, with the generalised forces and as many as there are forms, are these wherever constraints on positions hold.
    pub(in crate::motion) fn has(
        &self,
        bench: &mut Workbench,
        system: &Mechanics,
        rows: &MotionEquations,
        generalised_forces: &[ExprId],
    ) -> bool {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        let all = [&system.accelerations[..l], generalised_forces, &rows.rows().concat()].concat();
        let seen = self.compare_values(bench, system, (&all, true), |point, values| {
            let (accelerations, values) = values.split_at(l);
            let (forces, values) = values.split_at(n);
            let left = point.left_sides(accelerations)?.into_iter().zip(forces).map(|(e, q)| sub(e, *q));
            let right = values.chunks(l + 1).map(|row| sub(dot(&row[..l], accelerations), row[l]));
            Some(left.zip(right).position(|(left, right)| left != right))
        });
        matches!(seen, Seen::Holds)
    }

    /// Whether rates of the state are those of the operators and solve the equations, wherever constraints on positions hold.
    /// Where only the sign of a root may differ they are not taken; a proved difference is a mistake of ours.
    pub(in crate::motion) fn is_solved_by(
        &mut self,
        bench: &mut Workbench,
        (system, frame): (&Mechanics, &mut Frame),
        rates: &[ExprId],
    ) -> Result<bool, DerivationError> {
        let n = system.forms.len();
        let all = [rates, &self.generalised_forces].concat();
        let seen = self.compare_values(bench, system, (&all, true), |point, values| {
            let (rates, generalised_forces) = values.split_at(rates.len());
            let (moving, accelerations) = rates.split_at(n);
            if point.velocities != moving {
                return Some(Some(0));
            }
            let left = point.left_sides(accelerations)?;
            Some(left.iter().zip(generalised_forces).position(|(left, force)| left != force))
        });
        if self.decided(bench, system, (&all, true), seen)? {
            return Ok(true);
        }
        let (moving, accelerations) = rates.split_at(n);
        for (own, other) in frame.velocities.clone().iter().zip(moving) {
            let difference = bench.graph.sub(*own, *other);
            refuse(bench, difference, true, 0)?;
        }
        let MotionEquations { mass, forces } = self.written(bench, system, frame).clone();
        for (equation, row) in mass.iter().enumerate() {
            let inertia = bench.dot(row, accelerations);
            let force = bench.graph.add(forces[equation], self.generalised_forces[equation]);
            let difference = bench.graph.sub(inertia, force);
            refuse(bench, difference, true, equation)?;
        }
        Ok(false)
    }

    /// Compares values at as many points as it takes: where signs may be right by chance with drawn ones first, then at many. `differs` is given
    /// the values of some expressions, and returns the row that differs, if any.
    fn compare_values(
        &self,
        bench: &mut Workbench,
        system: &Mechanics,
        (es, on_manifold): (&[ExprId], bool),
        differs: impl Fn(&mut Point<'_>, &[u64]) -> Option<Option<usize>>,
    ) -> Seen {
        // Where no points of the constraints are found, any points do: equality everywhere is enough.
        let on_manifold = on_manifold && bench.zero.manifold_has_points();
        let all = [es, &system.expressions()].concat();
        let signs = all.iter().any(|e| bench.zero.has_signs_or_roots(&bench.graph, *e));
        let mut look = |wanted: usize, enough: usize, has_drawn_roots: bool| {
            let (mut seen, mut in_vain) = (0, 0);
            for number in 0.. {
                let Some(sample) = bench.zero.fresh(&bench.graph, number, on_manifold) else { break };
                let sample = if has_drawn_roots { sample.with_drawn_roots() } else { sample };
                let row = self.at_points.point(bench, system, sample).and_then(|mut point| {
                    let values = point.values(es)?;
                    differs(&mut point, &values)
                });
                match row {
                    Some(Some(row)) => return Seen::Differs(row),
                    Some(None) => (seen, in_vain) = (seen + 1, 0),
                    None => in_vain += 1,
                }
                if seen == wanted || in_vain > REDRAWS {
                    break;
                }
            }
            if seen >= enough { Seen::Holds } else { Seen::Few }
        };
        if !signs {
            return look(PROOF_POINTS, PROOF_POINTS, false);
        }
        match look(PROOF_POINTS, PROOF_POINTS, true) {
            Seen::Holds => Seen::Holds,
            // Without what roots are, equal values may differ.
            _ => look(FEWEST_POINTS_WITH_ROOTS, PROOF_POINTS_WITH_SIGNS, false),
        }
    }

    /// Whether equations hold, if points decide that: residues may differ where functions do not.
    fn decided(
        &self,
        bench: &mut Workbench,
        system: &Mechanics,
        (es, on_manifold): (&[ExprId], bool),
        seen: Seen,
    ) -> Result<bool, DerivationError> {
        match seen {
            Seen::Holds => Ok(true),
            Seen::Few => Ok(false),
            // The points were none of the constraints.
            Seen::Differs(_) if on_manifold && !bench.zero.manifold_is_solved() => Ok(false),
            Seen::Differs(equation) => {
                let all = [es, &system.expressions()].concat();
                match bench.zero.is_exact(&bench.graph, &all, on_manifold) {
                    true => Err(DerivationError::RoutesDisagree { equation }),
                    false => Ok(false),
                }
            }
        }
    }
}

fn dot(a: &[u64], b: &[u64]) -> u64 {
    a.iter().zip(b).fold(0, |sum, (a, b)| add(sum, mul(*a, *b)))
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
pub(in crate::motion) mod tests {
    use super::*;
    use crate::algebra::{Graph, Node, Rational, Role};
    use crate::geometry::{Form, Forms, Operators};
    use crate::motion::definition::projection;
    use crate::motion::{Force, Holonomic, Solution, VelocityPartials, decompose};

    /// The names of coordinates, forms, kinetic energy and force function of a system without forces.
    pub(in crate::motion) fn system(
        bench: &mut Workbench,
        names: &[&str],
        degrees: usize,
        declare: impl FnOnce(&mut Graph, &[ExprId], &[ExprId], ExprId) -> (Vec<Form>, ExprId, ExprId),
    ) -> Mechanics {
        let graph = &mut bench.graph;
        let symbols = |graph: &mut Graph, prefix: &str, role: Role| -> Vec<ExprId> {
            names.iter().map(|name| graph.symbol(&format!("{prefix}{name}"), role)).collect()
        };
        let time = graph.symbol("t", Role::Time);
        let coordinates = symbols(graph, "", Role::Coordinate);
        let velocities = symbols(graph, "rate of ", Role::Velocity);
        let etas = symbols(graph, "eta ", Role::QuasiVelocity);
        let mut accelerations = symbols(graph, "rate of eta ", Role::QuasiAcceleration);
        accelerations.truncate(degrees);
        let (forms, kinetic_energy, force_function) = declare(graph, &coordinates, &velocities, time);
        let forms = Forms { time, coordinates, forms, degrees };
        Mechanics {
            stated: vec![false; names.len()],
            written: forms.over(graph, &velocities),
            forms,
            velocities,
            etas,
            accelerations,
            inputs: Vec::new(),
            holonomic: Vec::new(),
            redundant: Vec::new(),
            kinetic_energy,
            force_function,
            multibody: None,
            structure: Default::default(),
            forces: Vec::new(),
            outputs: Vec::new(),
            states: Vec::new(),
            motion_symbols: Vec::new(),
            measured: None,
        }
    }

    /// A sled whose blade drifts with the time, its energy written in velocities and in `eta_1`.
    fn sled(bench: &mut Workbench) -> Mechanics {
        let mut sled = system(bench, &["phi", "x", "y"], 2, |graph, at, v, time| {
            let [mass, arm, inertia, weight] =
                ["m", "a", "J", "g"].map(|name| graph.symbol(name, Role::Constant));
            let spin = graph.symbol("eta phi", Role::QuasiVelocity);
            let (sine, cosine) = graph.sin_cos(at[0]);
            let (zero, one) = (graph.zero(), graph.one());
            let (minus_cosine, drift) = (graph.neg(cosine), graph.mul(time, sine));
            let forms = vec![
                Form { row: vec![one, zero, zero], offset: zero },
                Form { row: vec![zero, cosine, sine], offset: zero },
                Form { row: vec![zero, sine, minus_cosine], offset: drift },
            ];
            let (across, along) = (graph.product(&[(arm, 1), (sine, 1), (spin, 1)]), graph.mul(arm, cosine));
            let (ahead, aside) = (graph.sub(v[1], across), graph.mul(along, v[0]));
            let aside = graph.add(v[2], aside);
            let half = graph.ratio(1, 2);
            let parts = [(mass, ahead), (mass, aside), (inertia, v[0])]
                .map(|(weight, u)| graph.product(&[(half, 1), (weight, 1), (u, 2)]));
            let height = graph.add(at[1], along);
            (forms, graph.sum(parts.to_vec()), graph.product(&[(mass, 1), (weight, 1), (height, 1)]))
        });
        let pull = bench.graph.symbol("u", Role::Input);
        sled.inputs.push(pull);
        sled.forces.push(Force { magnitude: pull, along: sled.etas[1] });
        sled
    }

    /// The frame of a system, and its equations by definition.
    fn written(bench: &mut Workbench, system: &Mechanics) -> (Frame, MotionEquations) {
        let operators = Operators::new(bench, &system.forms).ok().unwrap();
        let mut frame = Frame::new(bench, system, operators);
        let equations = poincare::equations(bench, system, &mut frame);
        (frame, equations)
    }

    /// An expression with one term of it turned, for each of its terms; twice itself where it has one.
    fn turned(bench: &mut Workbench, e: ExprId) -> Vec<ExprId> {
        let Node::Sum { terms, .. } = bench.graph.node(e).clone() else {
            return vec![bench.graph.scale(e, &Rational::integer(2))];
        };
        let turn = terms.iter().map(|(term, c)| {
            let twice = bench.graph.linear(&[(*term, &(-c.clone()) * &Rational::integer(2))]);
            bench.graph.add(e, twice)
        });
        turn.collect()
    }

    #[test]
    fn a_term_that_is_turned_is_refused() {
        let mut bench = Workbench::new(Graph::new());
        let sled = sled(&mut bench);
        let (mut frame, own) = written(&mut bench, &sled);
        let (zero, u) = (bench.graph.zero(), sled.inputs[0]);
        let mut definition = Definition::new(&mut bench, &sled, &[zero, u]);
        assert_eq!(definition.is(&mut bench, (&sled, &mut frame), &own, false).ok(), Some(true));
        let mut count = 0;
        for s in 0..2 {
            let entries = [&own.mass[s][..], &[own.forces[s]]].concat();
            for (t, e) in entries.into_iter().enumerate() {
                for wrong in turned(&mut bench, e) {
                    if wrong == e {
                        continue;
                    }
                    let mut other = own.clone();
                    *other.mass[s].get_mut(t).unwrap_or(&mut other.forces[s]) = wrong;
                    let found = definition.is(&mut bench, (&sled, &mut frame), &other, false);
                    assert!(
                        matches!(found, Err(DerivationError::RoutesDisagree { equation }) if equation == s)
                    );
                    count += 1;
                }
            }
        }
        assert!(count > 8, "{count} terms");
    }

    #[test]
    fn rates_that_are_turned_are_refused() {
        let mut bench = Workbench::new(Graph::new());
        let sled = sled(&mut bench);
        let (mut frame, mut own) = written(&mut bench, &sled);
        let (zero, u) = (bench.graph.zero(), sled.inputs[0]);
        let mut definition = Definition::new(&mut bench, &sled, &[zero, u]);
        own.forces[1] = bench.graph.add(own.forces[1], u);
        let solution = Solution::new(&mut bench, &own.mass, &own.forces).ok().unwrap();
        let rates = [&frame.velocities[..], &solution.accelerations].concat();
        assert_eq!(definition.is_solved_by(&mut bench, (&sled, &mut frame), &rates).ok(), Some(true));
        for (place, e) in rates.iter().enumerate() {
            for wrong in turned(&mut bench, *e) {
                let mut other = rates.clone();
                other[place] = wrong;
                assert!(definition.is_solved_by(&mut bench, (&sled, &mut frame), &other).is_err());
            }
        }
    }

    #[test]
    fn reactions_that_are_turned_are_refused() {
        let mut bench = Workbench::new(Graph::new());
        let sled = sled(&mut bench);
        let (mut frame, _) = written(&mut bench, &sled);
        let mut partials = VelocityPartials::of_system(&bench, &sled);
        let symbols = [&sled.velocities[..], &sled.etas].concat();
        let terms = decompose(&mut bench, &mut partials, &symbols, sled.kinetic_energy).ok().unwrap();
        let own = projection::equations(&mut bench, &sled, &mut frame, &mut partials, &terms, 0..3).equations;
        let (zero, u) = (bench.graph.zero(), sled.inputs[0]);
        let mut definition = Definition::new(&mut bench, &sled, &[zero, u]);
        assert_eq!(definition.is(&mut bench, (&sled, &mut frame), &own, false).ok(), Some(true));
        for wrong in turned(&mut bench, own.forces[2]) {
            let mut other = own.clone();
            other.forces[2] = wrong;
            let found = definition.is(&mut bench, (&sled, &mut frame), &other, false);
            assert!(matches!(found, Err(DerivationError::RoutesDisagree { equation: 2 })));
        }
    }

    /// Entries that are exchanged have the same sum along `X_1 + X_2`, and no other displacement.
    #[test]
    fn all_displacements_are_looked_at() {
        let mut bench = Workbench::new(Graph::new());
        let plane = system(&mut bench, &["x", "y"], 2, |graph, at, v, _| {
            let (zero, one) = (graph.zero(), graph.one());
            let forms = [vec![one, zero], vec![zero, one]].map(|row| Form { row, offset: zero });
            let squares = [v[0], v[1]].map(|v| (graph.powi(v, 2), Rational::new(1, 2)));
            let hills = [at[0], at[1]].map(|x| (graph.powi(x, 2), Rational::new(1, 2)));
            (forms.to_vec(), graph.linear(&squares), graph.linear(&hills))
        });
        let (mut frame, right) = written(&mut bench, &plane);
        let zero = bench.graph.zero();
        let mut definition = Definition::new(&mut bench, &plane, &[zero, zero]);
        assert_eq!(definition.is(&mut bench, (&plane, &mut frame), &right, true).ok(), Some(true));
        let wrong = MotionEquations { mass: right.mass, forces: vec![right.forces[1], right.forces[0]] };
        assert!(definition.is(&mut bench, (&plane, &mut frame), &wrong, true).is_err());
        let rates = [&plane.etas[..], &wrong.forces].concat();
        assert!(definition.is_solved_by(&mut bench, (&plane, &mut frame), &rates).is_err());
    }

    /// A particle of unit mass on a line.
    fn particle(bench: &mut Workbench) -> Mechanics {
        system(bench, &["x"], 1, |graph, _, v, _| {
            let (zero, one) = (graph.zero(), graph.one());
            let square = graph.powi(v[0], 2);
            (vec![Form { row: vec![one], offset: zero }], graph.scale(square, &Rational::new(1, 2)), zero)
        })
    }

    /// A root that is right wherever a residue happens to have its sign, as three points in a row do for one in eight.
    #[test]
    fn roots_with_the_sign_of_some_points_are_refused() {
        let mut bench = Workbench::new(Graph::new());
        let point = particle(&mut bench);
        let (mut frame, _) = written(&mut bench, &point);
        let x = point.forms.coordinates[0];
        let one = bench.graph.one();
        let square = bench.graph.powi(x, 2);
        let beside = bench.graph.add(one, square);
        for k in 1..=24 {
            let number = bench.graph.number(Rational::integer(k));
            let left = bench.graph.sub(number, x);
            let square = bench.graph.powi(left, 2);
            let radicand = bench.graph.mul(square, beside);
            let force = bench.graph.sqrt(radicand);
            let root = bench.graph.sqrt(beside);
            let other = bench.graph.mul(left, root);
            let mut definition = Definition::new(&mut bench, &point, &[force]);
            let mut is_solved_by = |rate| {
                let rates = [point.etas[0], rate];
                definition.is_solved_by(&mut bench, (&point, &mut frame), &rates).ok()
            };
            assert_eq!(is_solved_by(force), Some(true), "{k}");
            assert_ne!(is_solved_by(other), Some(true), "{k}");
        }
    }

    /// Of the points modulo the prime one in 2^20 has all the roots of twenty.
    #[test]
    fn many_roots_are_as_good_as_few() {
        let mut bench = Workbench::new(Graph::new());
        let point = particle(&mut bench);
        let (mut frame, _) = written(&mut bench, &point);
        let x = point.forms.coordinates[0];
        let square = bench.graph.powi(x, 2);
        let length = |bench: &mut Workbench, k: i64| {
            let number = bench.graph.number(Rational::integer(k));
            let sum = bench.graph.add(number, square);
            bench.graph.sqrt(sum)
        };
        let lengths: Vec<ExprId> = (1..=20).map(|k| length(&mut bench, k)).collect();
        let force = bench.graph.sum(lengths.clone());
        let mut definition = Definition::new(&mut bench, &point, &[force]);
        let mut is_solved_by = |bench: &mut Workbench, rate| {
            definition.is_solved_by(bench, (&point, &mut frame), &[point.etas[0], rate]).ok()
        };
        assert_eq!(is_solved_by(&mut bench, force), Some(true));
        let twice = bench.graph.add(force, lengths[7]);
        assert_ne!(is_solved_by(&mut bench, twice), Some(true));
        let other = length(&mut bench, 21);
        let wrong = bench.graph.sub(force, lengths[7]);
        let wrong = bench.graph.add(wrong, other);
        assert_ne!(is_solved_by(&mut bench, wrong), Some(true));
    }

    /// A pendulum whose length is one on the constraint.
    #[test]
    fn on_a_constraint_they_need_be_equal_there_only() {
        let mut bench = Workbench::new(Graph::new());
        let mut pendulum = system(&mut bench, &["x", "r"], 1, |graph, at, v, _| {
            let (zero, one) = (graph.zero(), graph.one());
            let forms = [vec![one, zero], vec![zero, one]].map(|row| Form { row, offset: zero });
            let (across, along) = (graph.product(&[(at[1], 2), (v[0], 2)]), graph.powi(v[1], 2));
            let energy = graph.linear(&[(across, Rational::new(1, 2)), (along, Rational::new(1, 2))]);
            // The cosine of a number has values that differ where it does not.
            let number = graph.ratio(1, 3);
            let (cosine, lean) = (graph.cos(at[0]), graph.cos(number));
            (forms.to_vec(), energy, graph.product(&[(lean, 1), (at[1], 1), (cosine, 1)]))
        });
        let (one, r) = (bench.graph.one(), pendulum.forms.coordinates[1]);
        let constraint = bench.graph.sub(r, one);
        pendulum.holonomic.push(Holonomic { form: 1, equation: constraint });
        let (mut frame, own) = written(&mut bench, &pendulum);
        let force = bench.graph.div(own.forces[0], r);
        let short = MotionEquations { mass: vec![vec![r]], forces: vec![force] };
        let opposite = bench.graph.neg(force);
        let wrong = MotionEquations { mass: vec![vec![r]], forces: vec![opposite] };
        let zero = bench.graph.zero();
        let mut definition = Definition::new(&mut bench, &pendulum, &[zero]);
        bench.zero.set_manifold(&mut bench.graph, &[constraint]);
        let mut is = |bench: &mut Workbench, equations: &MotionEquations, on_manifold| {
            definition.is(bench, (&pendulum, &mut frame), equations, on_manifold).ok()
        };
        assert_eq!(is(&mut bench, &own, false), Some(true));
        assert_eq!(is(&mut bench, &short, true), Some(true));
        assert_eq!(is(&mut bench, &short, false), None);
        assert_eq!(is(&mut bench, &wrong, true), None);
    }
}
