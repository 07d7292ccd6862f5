//! Formulation "recursive": velocities are computed one from another, from the sums as they were written.
//!
//! The axle of the last of ten trailers moves like the one before it, plus the turn of one link. Multiplied out into
//! coefficients its velocity has eleven terms, on the constraints each of these is a long product, and a row of the
//! operators grows with all rows before it. Here velocities stay what they are, one a few terms from another, and the
//! constraints are solved from one velocity to the next: the work of a train grows as a person's does, with its length.
//!
//! Points of a plane that constraints hold by an angle have their velocities in axes that turn with it, too (`axles`): in the
//! world's a link turns by a difference that has no digits left where it is nearly in line with the one before.
//!
//! What comes out are more lists of rates for the optimiser. The operators that are shown, and all that is derived
//! from them, are not touched.

mod axles;
mod component;
mod planar;
mod sums;
mod turned_pairs;
mod unknowns;

use self::component::Component;
use self::sums::{Relative, relatives};
use self::unknowns::Unknowns;
use crate::algebra::{ExprId, FastMap, Flow, Graph, Node};
use crate::motion::coordinates::relative_angles::RelativeAngles;
use crate::motion::definition::projection::{self, Measured, MeasuredForms};
use crate::motion::thresholds::{CLOSE_PROMISE, VELOCITY_WEIGHT};
use crate::motion::{Frame, KineticTerm, Mechanics, MotionEquations, Solution};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The rates of the state, velocities first; none where nothing is in common, or nothing is seen to be, or where equations
/// promise no less than `most`.
pub(super) fn rates(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    terms: &[KineticTerm],
    forms: &MeasuredForms,
    generalised_forces: &[ExprId],
    most: u64,
) -> Vec<Vec<ExprId>> {
    found(bench, system, frame, terms, forms, generalised_forces, most).unwrap_or_default()
}

fn found(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    terms: &[KineticTerm],
    forms: &MeasuredForms,
    generalised_forces: &[ExprId],
    most: u64,
) -> Option<Vec<Vec<ExprId>>> {
    let mut unknowns = Unknowns::new(bench, system);
    let written: Vec<ExprId> = system.written.iter().map(|e| unknowns.form(bench, *e)).collect();
    let in_world = Written { forms: written, terms: terms.to_vec(), ..Written::default() };
    let on_axles = axles::written(bench, system, &mut unknowns, &in_world, forms);
    let mut found: Vec<(u64, Assembled)> = Vec::new();
    for written in core::iter::once(in_world).chain(on_axles) {
        let assembled = assembled(bench, system, frame, &mut unknowns, &written, forms, generalised_forces);
        if let Some(Assembled { velocities, equations }) = assembled {
            let all = [&velocities[..], &equations.entries()].concat();
            found.push((weighted_cost(&bench.graph, &all), Assembled { velocities, equations }));
        }
    }
    let least = found.iter().map(|(cost, _)| *cost).min()?;
    found.retain(|(cost, _)| *cost < most && CLOSE_PROMISE.1 * cost <= CLOSE_PROMISE.0 * least);
    let mut lists = Vec::new();
    for (_, Assembled { velocities, equations: MotionEquations { mass, forces } }) in found {
        let solutions = [Solution::new(bench, &mass, &forces).ok(), Solution::shared(bench, &mass, &forces)];
        let solutions = solutions.into_iter().flatten();
        lists.extend(solutions.map(|solution| [&velocities[..], &solution.accelerations].concat()));
    }
    Some(lists)
}

/// The rates of the coordinates, and the equations with the generalised forces.
struct Assembled {
    velocities: Vec<ExprId>,
    equations: MotionEquations,
}

/// The forms of a system over velocities, or over symbols for other ones.
#[derive(Default)]
struct Written {
    /// The definitions of the symbols.
    definitions: FastMap<ExprId, ExprId>,
    /// The forms of the declaration.
    forms: Vec<ExprId>,
    /// The kinetic energy.
    terms: Vec<KineticTerm>,
    /// The vectors in it that are taken apart in axes that turn.
    points: Vec<Point>,
}

/// A vector in axes at an angle.
struct Point {
    angle: ExprId,
    /// The forms of the velocities along the axes in the energy: the acceleration of a form belongs to its point, and
    /// two points may have one of them in common.
    forms: [ExprId; 2],
    velocities: [ExprId; 2],
}

fn assembled(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    unknowns: &mut Unknowns,
    written: &Written,
    forms: &MeasuredForms,
    generalised_forces: &[ExprId],
) -> Option<Assembled> {
    let l = system.forms.degrees;
    let Written { definitions, forms: written, terms, points } = written;
    let energy: Vec<ExprId> = terms.iter().flat_map(|term| term.forms.iter().copied()).collect();
    let in_unknowns: Vec<ExprId> = energy.iter().map(|e| unknowns.form(bench, *e)).collect();
    let values = definitions.iter().map(|(_, value)| *value);
    let values = values.chain(points.iter().flat_map(|point| point.velocities));
    let roots: Vec<ExprId> = written[l..].iter().chain(&in_unknowns).copied().chain(values).collect();
    let sums = match relatives(bench, &roots) {
        Some(sums) => sums,
        None if points.is_empty() => return None,
        None => FastMap::default(),
    };
    let mut on_constraints = Velocities::new(bench, system, frame, unknowns, written, &sums, definitions)?;
    let mut motion = on_constraints.motion(bench, system);
    let mut displacements = on_constraints.displacements(bench, system);
    let mut nested = MeasuredForms::default();
    for point in points {
        on_constraints.measure_point(bench, system, &mut motion, point, &mut nested)?;
    }
    for (u, in_unknowns) in energy.into_iter().zip(in_unknowns) {
        if !nested.contains_key(&u) {
            let mut measured = on_constraints.measure(bench, system, &mut motion, in_unknowns)?;
            measured.turning.clone_from(&forms[&u].turning);
            nested.insert(u, measured);
        }
    }
    let mut terms = terms.clone();
    turned_pairs::merge(bench, system, &mut motion, &mut terms, &mut nested);
    let (equations, _) =
        projection::assemble(bench, system, (0, &mut displacements), &mut motion, &terms, &nested);
    let equations = equations.driven(bench, generalised_forces);
    Some(Assembled { velocities: on_constraints.velocities, equations })
}

/// The velocities on the constraints, and forms made of them.
struct Velocities<'a> {
    /// `x_i'`.
    velocities: Vec<ExprId>,
    /// `xi_s^i`, a row for each of `X_1..X_l`.
    operators: Vec<Vec<ExprId>>,
    /// The components along `X_s`, by `s`; 0 is the drift.
    along: Vec<Component<'a>>,
    /// The values, in the `eta`.
    whole: Component<'a>,
}

impl<'a> Velocities<'a> {
    fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &Frame,
        unknowns: &Unknowns,
        written: &[ExprId],
        sums: &'a FastMap<ExprId, Relative>,
        definitions: &'a FastMap<ExprId, ExprId>,
    ) -> Option<Self> {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let mut along: Vec<Component<'a>> = Vec::new();
        for s in 0..=l {
            let mut component = Component::new(sums, definitions, s == 0);
            for (t, eta) in system.etas.iter().enumerate() {
                component.set(*eta, if t + 1 == s { one } else { zero });
            }
            along.push(component);
        }
        let mut heavy: Vec<usize> = Vec::new();
        for (i, symbol) in system.velocities.iter().enumerate() {
            let known: Vec<ExprId> =
                (0..=l).map(|s| unknowns.unknown(bench, i, &frame.operators.xi[s])).collect();
            if weighted_cost(&bench.graph, &known) > VELOCITY_WEIGHT {
                heavy.push(i);
            } else {
                along.iter_mut().zip(known).for_each(|(component, value)| component.set(*symbol, value));
            }
        }
        // Nothing was solved for that could grow.
        if heavy.is_empty() {
            return None;
        }
        let rows: Vec<Vec<ExprId>> =
            system.forms.forms.iter().map(|form| unknowns.row(bench, &form.row)).collect();
        let promised = &frame.operators.constant_pivots;
        while !heavy.is_empty() {
            let (place, form) = solvable(bench, promised, &rows, &heavy).unwrap_or((0, None));
            let i = heavy.remove(place);
            let Some(v) = form else {
                let known: Vec<ExprId> =
                    (0..=l).map(|s| unknowns.unknown(bench, i, &frame.operators.xi[s])).collect();
                let known = in_short_angles(bench, known);
                along.iter_mut().zip(known).for_each(|(component, value)| {
                    component.set(system.velocities[i], value);
                });
                continue;
            };
            for component in &mut along {
                // a_vi w_i = eta_v - (the form without it)
                let others = component.without(bench, system.velocities[i], written[v])?;
                let own = component.of(bench, system.etas[v])?;
                let right = bench.graph.sub(own, others);
                let right = bench.graph.keep(right);
                component.set(system.velocities[i], bench.graph.div(right, rows[v][i]));
            }
        }
        let mut whole = Component::new(sums, definitions, true);
        for (t, eta) in system.etas.iter().enumerate() {
            whole.set(*eta, if t < l { *eta } else { zero });
        }
        let mut values: Vec<Vec<ExprId>> = Vec::new();
        for component in &mut along {
            let own: Option<Vec<ExprId>> =
                system.velocities.iter().map(|symbol| component.of(bench, *symbol)).collect();
            values.push(own?);
        }
        let mut moving = Vec::new();
        for (i, symbol) in system.velocities.iter().enumerate() {
            let mut terms = vec![values[0][i]];
            for (row, eta) in values[1..].iter().zip(&system.etas) {
                terms.push(bench.graph.mul(row[i], *eta));
            }
            let value = bench.graph.sum(terms);
            let value = bench.keep_large(value);
            whole.set(*symbol, value);
            moving.push(value);
        }
        let velocities = (0..n).map(|i| unknowns.velocity(bench, i, &moving)).collect();
        let operators = values[1..]
            .iter()
            .map(|row| (0..n).map(|i| unknowns.velocity(bench, i, row)).collect())
            .collect();
        Some(Velocities { velocities, operators, along, whole })
    }

    /// The rate along the motion.
    fn motion(&self, bench: &Workbench, system: &Mechanics) -> Flow {
        let rates = system.forms.coordinates.iter().copied().zip(self.velocities.iter().copied());
        Flow::new(&bench.graph, rates.chain([(system.forms.time, bench.graph.one())])).keeping()
    }

    /// `X_1..X_l`.
    fn displacements(&self, bench: &Workbench, system: &Mechanics) -> Vec<Flow> {
        let coordinates = || system.forms.coordinates.iter().copied();
        let along =
            |row: &Vec<ExprId>| Flow::new(&bench.graph, coordinates().zip(row.iter().copied())).keeping();
        self.operators.iter().map(along).collect()
    }

    /// A form of the energy but for its exterior derivative, which belongs to the form and not to its place.
    fn measure(
        &mut self,
        bench: &mut Workbench,
        system: &Mechanics,
        motion: &mut Flow,
        u: ExprId,
    ) -> Option<Measured> {
        let l = system.forms.degrees;
        let mut parts = Vec::with_capacity(l + 1);
        for component in &mut self.along {
            parts.push(component.of(bench, u)?);
        }
        let moving: Vec<usize> = (1..=l).filter(|s| !bench.graph.is_zero(parts[*s])).collect();
        // One parameter alone is a factor of all that follows from it.
        let value = match moving[..] {
            [s] if bench.graph.is_zero(parts[0]) => bench.graph.mul(parts[s], system.etas[s - 1]),
            _ => self.whole.of(bench, u)?,
        };
        let acceleration = motion.of(&mut bench.graph, value);
        Some(Measured {
            value: bench.keep_large(value),
            drift: parts[0],
            components: parts.split_off(1),
            acceleration: bench.keep_large(acceleration),
            turning: vec![bench.graph.zero(); l],
        })
    }

    /// The velocities of a point in axes that turn. With its acceleration along these axes, `u' - phi' w` and `w' + phi' u`, its
    /// equations are those of closed forms.
    fn measure_point(
        &mut self,
        bench: &mut Workbench,
        system: &Mechanics,
        motion: &mut Flow,
        point: &Point,
        nested: &mut MeasuredForms,
    ) -> Option<()> {
        let turning = motion.of(&mut bench.graph, point.angle);
        let [u, w] = point.velocities;
        let [mut along, mut across] =
            [self.measure(bench, system, motion, u)?, self.measure(bench, system, motion, w)?];
        let [by_across, by_along] = [&across, &along].map(|own| bench.graph.mul(turning, own.value));
        let own = bench.graph.sub(along.acceleration, by_across);
        along.acceleration = bench.keep_large(own);
        let own = bench.graph.add(across.acceleration, by_along);
        across.acceleration = bench.keep_large(own);
        nested.insert(point.forms[0], along);
        nested.insert(point.forms[1], across);
        Some(())
    }
}

/// Entries in angles that are shorter than the base angles that they are between, kept whole: in the steering angle, and not
/// in those of the front wheel and of the car. Next to zero the sine of a difference of angles has lost its digits.
fn in_short_angles(bench: &mut Workbench, entries: Vec<ExprId>) -> Vec<ExprId> {
    let between = RelativeAngles::new(bench, &entries).shorter(&bench.graph);
    let short = entries.into_iter().map(|e| {
        let written = between.within(bench, e, |bench| {
            let open = bench.graph.opened(&[e])[0];
            let tidy = bench.tidy(open);
            (tidy != open).then(|| bench.graph.keep(tidy))
        });
        written.flatten().unwrap_or(e)
    });
    short.collect()
}

/// Whether a constant cannot vanish: by its bounds, or because the operators divide by it, too.
fn is_nonzero(graph: &Graph, promised: &[ExprId], e: ExprId) -> bool {
    let is_promised = |e: ExprId| {
        promised.iter().any(|pivot| match graph.node(*pivot) {
            _ if *pivot == e => true,
            Node::Product(factors) => factors.iter().any(|(base, exponent)| *base == e && *exponent > 0),
            Node::Sum { constant, terms } => {
                constant.is_zero() && matches!(terms[..], [(term, _)] if is_nonzero(graph, &[term], e))
            }
            _ => false,
        })
    };
    match graph.node(e) {
        _ if graph.manifestly_nonzero(e) || is_promised(e) => true,
        Node::Product(factors) => factors.iter().all(|(base, _)| is_nonzero(graph, promised, *base)),
        Node::Sum { constant, terms } if constant.is_zero() => {
            matches!(terms[..], [(term, _)] if is_nonzero(graph, promised, term))
        }
        _ => false,
    }
}

/// The place of the first unknown of a list that a form gives with a constant pivot, others of the list not in it, and
/// this form.
fn solvable(
    bench: &Workbench,
    promised: &[ExprId],
    rows: &[Vec<ExprId>],
    open: &[usize],
) -> Option<(usize, Option<usize>)> {
    open.iter().enumerate().find_map(|(place, i)| {
        let form = rows.iter().position(|row| {
            bench.graph.roles(row[*i]).is_constant()
                && is_nonzero(&bench.graph, promised, row[*i])
                && open.iter().all(|j| j == i || bench.graph.is_zero(row[*j]))
        })?;
        Some((place, Some(form)))
    })
}
