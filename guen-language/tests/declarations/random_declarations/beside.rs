//! What is emitted beside the rates of a drawn declaration, against its meaning: forms, momenta, the energy integral and its rate, slopes of
//! positions, poses, reactions as a covector, operators with their brackets, and linearisations.

use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_language::model::Model;
use guen_symbolic::{ExprId, Pattern, SymbolId, evaluate_function, evaluate_prepare};

use super::declared::{Declared, lift};
use super::draw::Draw;
use super::multipliers::{self, Multipliers};
use super::scalar::{Dual, Scalar, solve};
use super::{LARGEST, ROUNDING, STATES, grammar, numbers};
use crate::common::{by_two_threads, derived, evaluated, rounds};

/// Largest difference to a difference quotient, in units of condition times scale.
pub const CLOSE: f64 = 1e-6;
/// The step of difference quotients.
const STEP: f64 = 1e-5;

/// How much was compared, and the largest differences from what is exact and from difference quotients, in units of condition times scale.
#[derive(Default)]
struct Seen {
    states: usize,
    numbers: usize,
    worst: [f64; 2],
}

/// The coefficients of `X_0, X_1..X_n`: the columns of the inverse of the forms, without that of the time.
fn operators<R: Scalar>(forms: &[Vec<R>]) -> Vec<Vec<R>> {
    let n = forms.len();
    let unit = |row: usize, column: usize| R::constant(if row == column { 1.0 } else { 0.0 });
    let right = |row: usize| {
        let offset = forms[row][n].scaled(-1.0);
        [offset].into_iter().chain((0..n).map(|column| unit(row, column))).collect()
    };
    let solved = solve(forms.iter().map(|row| row[..n].to_vec()).collect(), (0..n).map(right).collect());
    (0..=n).map(|s| solved.iter().map(|row| row[s].clone()).collect()).collect()
}

/// `C_rs1 .. C_rsn` by the commutator of the vector fields.
fn bracket(declared: &Declared<'_>, point: &[f64], fields: &[Vec<f64>], (r, s): (usize, usize)) -> Vec<f64> {
    let n = declared.n;
    // A field with the time's share, and how all fields change along it.
    let along = |field: usize| {
        let moving = lift(point, |k| match k {
            0 => f64::from(u8::from(field == 0)),
            k if k <= n => fields[field][k - 1],
            _ => 0.0,
        });
        operators(&declared.forms_at(&moving))
    };
    let [along_r, along_s]: [Vec<Vec<Dual<f64>>>; 2] = [r, s].map(along);
    let commutator: Vec<f64> = (0..n).map(|i| along_r[s][i].du - along_s[r][i].du).collect();
    declared
        .forms_at(point)
        .iter()
        .map(|row| row[..n].iter().zip(&commutator).map(|(a, c)| a * c).sum())
        .collect()
}

/// A state of a declaration, and what was compared there.
struct Look<'l, 'a> {
    model: &'l Model<'a>,
    level: &'l DerivedLevel,
    declared: &'l Declared<'a>,
    point: Vec<f64>,
    reference: Multipliers,
    values: Vec<(SymbolId, f64)>,
    /// The coefficients of the operators.
    fields: Vec<Vec<f64>>,
    seen: Seen,
}

impl Look<'_, '_> {
    fn symbol(&self, e: ExprId) -> SymbolId {
        self.model.bench.graph.as_symbol(e).expect("a symbol")
    }

    fn value(&self, symbol: SymbolId) -> f64 {
        let known = self.values.iter().find(|(known, _)| *known == symbol);
        known.map(|(_, value)| *value).expect("a symbol of the declaration")
    }

    /// The results of a program where symbols differ from the state by so much.
    fn moved(&self, name: &str, by: &dyn Fn(SymbolId) -> f64) -> Vec<f64> {
        evaluated(self.level, name, |symbol| self.value(symbol) + by(symbol)).unwrap_or_default()
    }

    fn own(&self, name: &str) -> Vec<f64> {
        self.moved(name, &|_| 0.0)
    }

    /// Condition times scale.
    fn unit(&self) -> f64 {
        self.reference.condition * self.reference.scale
    }

    fn compare(&mut self, name: &str, found: &[f64], expected: &[f64], (unit, close): (f64, f64)) {
        assert_eq!(found.len(), expected.len(), "{name} of\n{}", self.model.declaration);
        for (place, (a, b)) in found.iter().zip(expected).enumerate() {
            let ratio = (a - b).abs() / unit;
            assert!(ratio <= close, "{name} {place}: {a}, and not {b}, of\n{}", self.model.declaration);
            let kind = usize::from(close == CLOSE);
            self.seen.worst[kind] = self.seen.worst[kind].max(ratio);
            self.seen.numbers += 1;
        }
    }

    /// The same of a program at the state, to rounding.
    fn exactly(&mut self, name: &str, expected: &[f64], unit: f64) {
        let found = self.own(name);
        self.compare(name, &found, expected, (unit, ROUNDING));
    }

    /// Forms at any velocities.
    fn forms(&mut self, draw: &mut Draw) {
        let declared = self.declared;
        let mut free = self.point.clone();
        declared.velocities.iter().for_each(|v| free[*v] += draw.real(-1.0, 1.0));
        let meaning = declared.meaning(&free);
        let expected: Vec<f64> = self.model.forms.iter().map(|form| meaning.forms[&form.name]).collect();
        let velocities: Vec<SymbolId> =
            self.model.mechanics.velocities.iter().map(|e| self.symbol(*e)).collect();
        let found = self.moved(function::FORMS, &|s| {
            let place = velocities.iter().position(|known| *known == s);
            place.map_or(0.0, |i| free[declared.velocities[i]] - self.point[declared.velocities[i]])
        });
        self.compare(function::FORMS, &found, &expected, (size(&expected), ROUNDING));
    }

    /// The energy integral, momenta and reactions.
    fn energy(&mut self) {
        let declared = self.declared;
        let meaning = declared.meaning(&self.point);
        let slopes: Vec<f64> =
            declared.by_velocities(&self.point).map(|meaning| meaning.kinetic_energy.du).collect();
        // `h = sum_i x_i' dT°/dx_i' - T° - U`
        let twice: f64 =
            declared.velocities.iter().zip(&slopes).map(|(v, slope)| self.point[*v] * slope).sum();
        let energy = twice - meaning.kinetic_energy - meaning.force_function;
        self.exactly(function::ENERGY, &[energy], size(&[twice, meaning.force_function]));
        // What belongs to `|q| = 1` depends on what `T` is off it, and so may others beside it.
        if !self.model.quaternions.is_empty() {
            return;
        }
        let known = (0..declared.n).filter(|j| self.level.derivation.known_momentum[*j]);
        let momentum =
            |j: usize| slopes.iter().zip(&self.fields[j + 1]).map(|(slope, xi)| slope * xi).sum::<f64>();
        let momenta: Vec<f64> = known.map(momentum).collect();
        self.exactly(function::MOMENTA, &momenta, size(&slopes) * size(&self.fields.concat()));
        if self.level.program(function::REACTION_COVECTOR).is_some() {
            let covector = self.reference.covector.clone();
            // `lambda_v` is formed along `X_v`, which has the inverse of the forms once more.
            self.exactly(function::REACTION_COVECTOR, &covector, self.unit() * self.reference.condition);
        }
    }

    /// The equations on positions with their slopes, and the poses of bodies and particles.
    fn positions(&mut self) {
        let declared = self.declared;
        let meaning = declared.meaning(&self.point);
        if self.level.derivation.system.redundant.is_empty() && !meaning.positions.is_empty() {
            let slopes = |x: &usize| -> Vec<f64> {
                let moving = declared.meaning(&lift(&self.point, |k| if k == *x { 1.0 } else { 0.0 }));
                moving.positions.iter().map(|e| e.du).collect()
            };
            let columns: Vec<Vec<f64>> = declared.x.iter().map(slopes).collect();
            // A vector in the plane has no third equation.
            let is_there = |row: &usize| columns.iter().any(|column| column[*row] != 0.0);
            let rows: Vec<usize> = (0..meaning.positions.len()).filter(is_there).collect();
            let slopes = rows.iter().flat_map(|row| columns.iter().map(|column| column[*row]));
            let expected: Vec<f64> = rows.iter().map(|row| meaning.positions[*row]).chain(slopes).collect();
            self.exactly(function::GRADIENTS, &expected, size(&expected));
        }
        if let Some(placed) = &self.level.placed {
            let prepared = evaluate_prepare(placed, |symbol| self.value(symbol));
            let found = evaluate_function(placed, 0, &prepared, |symbol| self.value(symbol));
            let expected = meaning.placed();
            self.compare(function::BODIES, &found, &expected, (size(&expected), ROUNDING));
        }
    }

    /// The operators and their brackets.
    fn operators(&mut self) {
        let all = self.fields.concat();
        let unit = size(&all) * self.reference.condition;
        self.exactly(function::OPERATORS, &all, unit);
        let (declared, emitted) = (self.declared, &self.level.brackets);
        let of = |pair: (usize, usize)| bracket(declared, &self.point, &self.fields, pair);
        let brackets: Vec<f64> = emitted.iter().flat_map(|own| of((own.r, own.s))).collect();
        // Those that are not emitted vanish.
        for (r, s) in (1..=declared.degrees).flat_map(|s| (0..s).map(move |r| (r, s))) {
            if !emitted.iter().any(|own| (own.r, own.s) == (r, s)) {
                let zero = of((r, s));
                let text = self.model.declaration;
                assert!(zero.iter().all(|c| c.abs() <= ROUNDING * unit), "({r}, {s}) {zero:?} of\n{text}");
            }
        }
        self.exactly(function::BRACKETS, &brackets, size(&brackets) * unit);
    }

    /// The rate of the energy integral.
    fn power(&mut self) {
        let rates = self.rates();
        let fastest = rates.iter().fold(1.0_f64, |most, (_, rate)| most.max(rate.abs()));
        let step = STEP / fastest;
        let rate = |s: SymbolId| rates.iter().find(|(known, _)| *known == s).map_or(0.0, |(_, rate)| *rate);
        let moved = |step: f64| self.moved(function::ENERGY, &|s| step * rate(s))[0];
        let expected = (moved(step) - moved(-step)) / (2.0 * step);
        let energy = self.own(function::ENERGY)[0];
        let (found, unit) = (self.own(function::POWER), self.unit().max(energy.abs()) * fastest);
        self.compare(function::POWER, &found, &[expected], (unit, CLOSE));
    }

    /// The rates of the time, the coordinates, the parameters and the states, by symbol.
    fn rates(&self) -> Vec<(SymbolId, f64)> {
        let (model, declared) = (self.model, self.declared);
        let velocities = declared.velocities.iter().map(|v| self.point[*v]);
        let rates = velocities.chain(self.reference.accelerations.iter().copied());
        let rates = rates.chain(declared.meaning(&self.point).state_rates);
        let variables = (0..model.sizes().1).map(|place| self.symbol(model.variable(place)));
        variables.zip(rates).chain([(self.symbol(model.mechanics.forms.time), 1.0)]).collect()
    }

    /// The slopes of rates and outputs.
    fn linearisations(&mut self) {
        let columns = columns(self.model, self.level);
        for (name, of, pattern) in jacobians(self.level) {
            let at = |own: SymbolId, step: f64| self.moved(of, &|s| if s == own { step } else { 0.0 });
            let quotients = quotients(&columns, &at);
            let unit = self.unit().max(size(&quotients.concat())) * self.reference.condition;
            let found = matrix(pattern, &self.own(name), &quotients);
            self.compare(name, &found, &quotients.concat(), (unit, CLOSE));
        }
    }
}

/// The symbols by which a level is differentiated.
pub fn columns(model: &Model<'_>, level: &DerivedLevel) -> Vec<SymbolId> {
    let variables = level.selection.variables.iter().map(|place| model.variable(*place));
    let inputs = level.selection.inputs.iter().map(|input| model.inputs[*input].symbol);
    variables.chain(inputs).map(|e| model.bench.graph.as_symbol(e).expect("a symbol")).collect()
}

/// The linearisations of a level, each with the program that is differentiated and the places of its results.
pub fn jacobians(level: &DerivedLevel) -> impl Iterator<Item = (&'static str, &'static str, &Pattern)> {
    let all = [
        (function::LINEARIZATION, function::RHS, &level.jacobians.rates),
        (function::OUTPUT_LINEARIZATION, function::OUTPUTS, &level.jacobians.outputs),
    ];
    all.into_iter().filter_map(|(name, of, pattern)| Some((name, of, pattern.as_ref()?)))
}

/// The derivatives by every column, of results where one symbol differs by a step.
pub fn quotients(columns: &[SymbolId], at: &dyn Fn(SymbolId, f64) -> Vec<f64>) -> Vec<Vec<f64>> {
    let quotient = |own: &SymbolId| -> Vec<f64> {
        at(*own, STEP).iter().zip(at(*own, -STEP)).map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
    };
    columns.iter().map(quotient).collect()
}

/// The whole matrix column by column, of the shape of another: what is not emitted vanishes.
pub fn matrix(pattern: &Pattern, found: &[f64], shape: &[Vec<f64>]) -> Vec<f64> {
    assert_eq!(pattern.len(), found.len());
    let mut all: Vec<Vec<f64>> = shape.iter().map(|column| vec![0.0; column.len()]).collect();
    for ((row, column), value) in pattern.iter().zip(found) {
        all[*column][*row] = *value;
    }
    all.concat()
}

fn size(list: &[f64]) -> f64 {
    list.iter().fold(1.0, |most, e| most.max(e.abs()))
}

fn look_at(derived: &DerivedSystem<'_>, seed: u64) -> Seen {
    let (model, level) = (&derived.model, &derived.system);
    let numbers = numbers(derived);
    let declared = &numbers.declared;
    let mut draw = Draw::new(seed.rotate_left(7));
    let mut seen = Seen::default();
    for _ in 0..STATES {
        let Some((point, etas)) = declared.state(&mut draw) else { continue };
        let Some(reference) = multipliers::solve(declared, &point) else { continue };
        // At a kink rounding decides.
        let is_at_kink = point[declared.velocities[0]].abs() < 1e-9;
        if reference.condition * reference.scale > LARGEST || is_at_kink {
            continue;
        }
        let mut values = numbers.values(model, &point, &etas);
        let symbol = |e: &ExprId| model.bench.graph.as_symbol(*e).expect("a symbol");
        let accelerations = model.mechanics.accelerations.iter().map(symbol);
        values.extend(accelerations.zip(reference.accelerations.iter().copied()));
        let velocities = model.mechanics.velocities.iter().map(symbol);
        values.extend(velocities.zip(declared.velocities.iter().map(|v| point[*v])));
        let fields = operators(&declared.forms_at(&point));
        let mut look = Look { model, level, declared, point, reference, values, fields, seen };
        look.forms(&mut draw);
        look.energy();
        look.positions();
        look.operators();
        look.power();
        look.linearisations();
        seen = look.seen;
        seen.states += 1;
    }
    seen
}

#[test]
fn programs_of_drawn_declarations_beside_the_rates() {
    let rounds = rounds(8);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let text = grammar::with_functions(*seed);
        derived(&text, |derived| look_at(derived, *seed))
    });
    let states: usize = found.iter().map(|seen| seen.states).sum();
    let numbers: usize = found.iter().map(|seen| seen.numbers).sum();
    let worst = [0, 1].map(|kind| found.iter().map(|seen| seen.worst[kind]).fold(0.0, f64::max));
    println!(
        "{states} states of {rounds} systems, {numbers} numbers, at most {:.1e} of condition times scale, {:.1e} from difference quotients",
        worst[0], worst[1]
    );
    assert!(states as u64 >= rounds && numbers > 50 * states, "{states} states, {numbers} numbers");
}
