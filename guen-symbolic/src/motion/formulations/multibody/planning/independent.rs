//! Independent velocities in place of the parameters, where loops are short in these.
//!
//! On a platform whose parameters are the rates of its six legs, every velocity hangs on every parameter. In the velocities of the plate each
//! leg is solved by itself. So the equations are solved in such velocities `w`, and the declared parameters are forms of them:
//!
//! ```text
//! eta = A(t, x) w + a_0,   M w' = f,   eta' = A w' + A' w + a_0'
//! ```
//!
//! Such velocities are taken where their forms, beside those of the constraints, are dependent at no state but those where the declared ones are
//! too, as far as is seen.

use super::safety::are_regular_with;
use crate::algebra::{ExprId, Role};
use crate::geometry::{Form, blocks};
use crate::motion::Mechanics;
use crate::motion::formulations::body_axes;
use crate::motion::formulations::other_parameters::restated::{self, Parameter};
use crate::motion::graph::{FormShape, FrameId, Motion, Place, Turn, Velocity, VelocityComponent};
use crate::motion::quasi_velocities::velocity_forms::{VelocityForm, VelocityPartials};
use crate::workbench::Workbench;
use crate::zero::field;

/// The unknowns that are solved for together in the declared parameters, from which on others are looked for.
const COUPLED: usize = 3;

/// A velocity that may be independent.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Choice {
    /// The rate of a coordinate.
    Rate(usize),
    /// A component of a spin, by the index of that.
    Spin(usize, usize),
}

/// The angular velocity of a frame, in its axes: against its parent, or against the world.
struct Spin {
    frame: FrameId,
    against: FrameId,
    components: [VelocityForm; 3],
}

/// Forms over velocities that may be independent, modulo the prime.
struct Columns {
    choices: Vec<Choice>,
    spins: Vec<Spin>,
    parameters: Vec<Vec<u64>>,
    constraints: Vec<Vec<u64>>,
}

/// The system in independent velocities of its own; none where the declared parameters are as good.
pub(in crate::motion::formulations::multibody) fn restated(
    bench: &mut Workbench,
    system: &Mechanics,
    partials: &mut VelocityPartials,
    on_manifold: bool,
) -> Option<Mechanics> {
    let l = system.forms.degrees;
    if system.forms.len() == l || l < COUPLED {
        return None;
    }
    let columns = Columns::new(bench, system, partials, on_manifold)?;
    let all: Vec<&Vec<u64>> = columns.parameters.iter().chain(&columns.constraints).collect();
    let declared = sizes(&all, &(0..columns.choices.len()).collect::<Vec<_>>())?;
    if declared.iter().all(|size| *size < COUPLED) {
        return None;
    }
    let dependent = dependent(&columns)?;
    let own = sizes(&columns.constraints.iter().collect::<Vec<_>>(), &dependent)?;
    let work = |sizes: &[usize]| sizes.iter().map(|size| size.pow(3)).sum::<usize>();
    if 2 * work(&own) > work(&declared) {
        return None;
    }
    let independent = (0..columns.choices.len()).filter(|column| !dependent.contains(column));
    let parameters: Vec<Parameter> = independent
        .enumerate()
        .map(|(k, column)| columns.parameter(bench, system, k, columns.choices[column]))
        .collect();
    let forms = parameters.iter().map(|parameter| parameter.form.clone());
    let forms: Vec<Form> = forms.chain(system.forms.forms[l..].iter().cloned()).collect();
    are_regular_with(&bench.graph, &forms, &system.forms.forms)
        .then(|| restated::in_parameters(bench, system, parameters))
}

impl Columns {
    fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        partials: &mut VelocityPartials,
        on_manifold: bool,
    ) -> Option<Self> {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        let entries: Vec<ExprId> =
            system.forms.forms.iter().flat_map(|form| form.row.iter().copied()).collect();
        let entries = bench.zero.residues(&mut bench.graph, 0, &entries, on_manifold)?;
        let mut parameters: Vec<Vec<u64>> = entries.chunks(n).map(<[u64]>::to_vec).collect();
        let constraints = parameters.split_off(l);
        let choices = (0..n).map(Choice::Rate).collect();
        let mut columns = Columns { choices, spins: Vec::new(), parameters, constraints };
        for (frame, against, spin) in turning(bench, system) {
            let forms = spin.map(|component| partials.affine(bench, component));
            if let [Some(x), Some(y), Some(z)] = forms {
                columns.turn(bench, Spin { frame, against, components: [x, y, z] }, on_manifold);
            }
        }
        Some(columns)
    }

    /// Puts an angular velocity in place of the rates of coordinates, where these are three, or more of which constraints that speak of no
    /// others leave three.
    fn turn(&mut self, bench: &mut Workbench, spin: Spin, on_manifold: bool) -> Option<()> {
        let mut places = Vec::new();
        for form in &spin.components {
            if !form.on_etas.is_empty() {
                return None;
            }
            places.extend(form.on_velocities.iter().map(|(i, _)| *i));
        }
        places.sort_unstable();
        places.dedup();
        let own: Vec<usize> = places
            .iter()
            .map(|i| self.choices.iter().position(|choice| *choice == Choice::Rate(*i)))
            .collect::<Option<_>>()?;
        let is_own =
            |row: &[u64]| row.iter().enumerate().all(|(column, entry)| *entry == 0 || own.contains(&column));
        let held: Vec<usize> =
            (0..self.constraints.len()).filter(|r| is_own(&self.constraints[*r])).collect();
        if held.len() + 3 != own.len() {
            return None;
        }
        let mut matrix = Vec::new();
        for form in &spin.components {
            let entries: Vec<ExprId> = form.on_velocities.iter().map(|(_, e)| *e).collect();
            let entries = bench.zero.residues(&mut bench.graph, 0, &entries, on_manifold)?;
            let mut row = vec![0; own.len()];
            for ((i, _), entry) in form.on_velocities.iter().zip(entries) {
                row[places.iter().position(|place| place == i)?] = entry;
            }
            matrix.push(row);
        }
        matrix.extend(held.iter().map(|r| own.iter().map(|column| self.constraints[*r][*column]).collect()));
        // The rates of the coordinates for each component of the spin.
        let unit = |q: usize| (0..own.len()).map(|row| u64::from(row == q)).collect::<Vec<u64>>();
        if field::rank(&matrix) < own.len() {
            return None;
        }
        let rates: Vec<Vec<u64>> = (0..3).map(|q| field::solve(&matrix, &unit(q))).collect::<Option<_>>()?;
        let mut kept = 0..;
        self.constraints.retain(|_| kept.next().is_some_and(|row| !held.contains(&row)));
        for row in self.parameters.iter_mut().chain(&mut self.constraints) {
            let by_spin = rates.iter().map(|rates| {
                own.iter()
                    .zip(rates)
                    .fold(0, |sum, (column, rate)| field::add(sum, field::mul(row[*column], *rate)))
            });
            let by_spin: Vec<u64> = by_spin.collect();
            let others = row.iter().enumerate().filter(|(column, _)| !own.contains(column));
            *row = others.map(|(_, entry)| *entry).chain(by_spin).collect();
        }
        let mut column = 0..;
        self.choices.retain(|_| column.next().is_some_and(|column| !own.contains(&column)));
        self.choices.extend((0..3).map(|q| Choice::Spin(self.spins.len(), q)));
        self.spins.push(spin);
        Some(())
    }

    /// A velocity as a parameter.
    fn parameter(&self, bench: &mut Workbench, system: &Mechanics, k: usize, choice: Choice) -> Parameter {
        let symbol = bench.graph.symbol(&format!("w{}", k + 1), Role::QuasiVelocity);
        let (zero, one) = (bench.graph.zero(), bench.graph.one());
        let mut row = vec![zero; system.forms.len()];
        let (offset, shape) = match choice {
            Choice::Rate(i) => {
                row[i] = one;
                (zero, FormShape { components: Vec::new(), rest: system.velocities[i] })
            }
            Choice::Spin(index, q) => {
                let Spin { frame, against, components } = &self.spins[index];
                components[q].on_velocities.iter().for_each(|(i, e)| row[*i] = *e);
                let mut axis = [zero; 3];
                axis[q] = one;
                let direction = Place { terms: vec![(*frame, axis)] };
                let mut velocity = Velocity { parts: vec![(one, Motion::Spin(*frame))] };
                if *against != FrameId::WORLD {
                    velocity.parts.push((bench.graph.neg(one), Motion::Spin(*against)));
                }
                (
                    components[q].offset,
                    FormShape { components: vec![VelocityComponent { direction, velocity }], rest: zero },
                )
            }
        };
        Parameter { symbol, form: Form { row, offset }, shape: Some(shape) }
    }
}

/// The frames that turn in any way, with their angular velocities: against their parents, and against the world where a body is turned by three
/// angles that turn no other.
fn turning(bench: &mut Workbench, system: &Mechanics) -> Vec<(FrameId, FrameId, [ExprId; 3])> {
    let structure = &system.structure;
    let mut found = Vec::new();
    for (index, frame) in structure.frames().iter().enumerate() {
        if let Turn::General { spin, .. } = &frame.turn {
            found.push((structure.id(index), frame.parent, *spin));
        }
    }
    let path = |mut frame: FrameId| {
        let mut path = Vec::new();
        while frame != FrameId::WORLD {
            path.push(frame);
            frame = structure.frame(frame).parent;
        }
        path
    };
    let frames: Vec<FrameId> = structure.bodies.iter().filter_map(|body| body.frame).collect();
    let bodies = system.multibody.iter().flat_map(|multibody| &multibody.bodies);
    for (node, body) in structure.bodies.iter().zip(bodies) {
        let (Some(frame), Some(rows)) = (node.frame, &body.orientation) else { continue };
        let own = path(frame);
        let is_other = |other: &FrameId| {
            let others = path(*other);
            !others.contains(&frame) && others.iter().any(|between| own.contains(between))
        };
        if !frames.iter().any(is_other) {
            found.push((
                frame,
                FrameId::WORLD,
                body.spin.unwrap_or_else(|| body_axes::spin(bench, system, rows)),
            ));
        }
    }
    found
}

/// The sizes of the blocks in which rows determine some columns; `None` where they do not.
fn sizes(rows: &[&Vec<u64>], columns: &[usize]) -> Option<Vec<usize>> {
    let used = rows.iter().map(|row| (0..columns.len()).filter(|k| row[columns[*k]] != 0).collect());
    let used: Vec<Vec<usize>> = used.collect();
    (used.len() == columns.len())
        .then(|| blocks(&used))
        .flatten()
        .map(|blocks| blocks.into_iter().map(|(rows, _)| rows.len()).collect())
}

/// The columns that the constraints are solved for: those that the fewest constraints speak of, as of these what many loops have in common is
/// independent; among equals the one with the least fill.
fn dependent(columns: &Columns) -> Option<Vec<usize>> {
    let mut rows = columns.constraints.clone();
    let users = |rows: &[Vec<u64>]| -> Vec<usize> {
        let users = |column: usize| rows.iter().filter(|row| row[column] != 0).count();
        (0..columns.choices.len()).map(users).collect()
    };
    let all_users = users(&rows);
    let mut found = Vec::new();
    while !rows.is_empty() {
        let left = users(&rows);
        let candidates = rows.iter().enumerate().flat_map(|(r, row)| {
            let size = row.iter().filter(|entry| **entry != 0).count();
            let used = row.iter().enumerate().filter(|(_, entry)| **entry != 0);
            let (all_users, left) = (&all_users, &left);
            used.map(move |(column, _)| (all_users[column], (size - 1) * (left[column] - 1), r, column))
        });
        let (.., r, column) = candidates.min()?;
        let row = rows.remove(r);
        let inverse = field::inverse(row[column])?;
        for other in rows.iter_mut().filter(|other| other[column] != 0) {
            let factor = field::mul(other[column], inverse);
            other.iter_mut().zip(&row).for_each(|(e, own)| *e = field::sub(*e, field::mul(factor, *own)));
        }
        found.push(column);
    }
    Some(found)
}
