//! Taylor series of drawn declarations: a series `p(s)` of order `n` is right if and only if `p'(s) - f(p(s)) = O(s^n)`, with the rates `f` of
//! the program that other tests compare with its meaning.

use guen_language::derive::{DerivedSystem, derive, function};
use guen_language::diagnostics::collect;
use guen_language::{model, parse};
use guen_symbolic::{Arithmetic, Operation, SeriesProgram, SeriesStep, Start, SymbolId, evaluate_prepare};

use super::draw::Draw;
use super::{LARGEST, STATES, grammar, multipliers, numbers, scenes};
use crate::common::{by_two_threads, evaluated, rounds};

/// The highest order of a coefficient.
const ORDER: usize = 8;
/// The length of a step over that in which something changes by one.
const STEP: f64 = 0.01;
/// Largest residual, in units of condition times scale: the next term is some `STEP^8`, a wrong coefficient of order four `STEP^3`.
const SMALL: f64 = 1e-11;

/// The coefficients of the state's variables, order by order.
fn coefficients(
    series: &SeriesProgram,
    start: &[f64],
    inputs: &[Vec<f64>],
    (time, prepared): (f64, &[f64]),
    symbol: &dyn Fn(SymbolId) -> f64,
) -> Vec<[f64; ORDER + 1]> {
    let mut all = vec![[0.0; ORDER + 1]; series.steps.len()];
    for k in 0..=ORDER {
        for (v, step) in series.steps.iter().enumerate() {
            let at = |v: &guen_symbolic::Value| &all[v.index()];
            let products =
                |a: &[f64], b: &[f64], from: usize| -> f64 { (from..=k).map(|j| a[j] * b[k - j]).sum() };
            let begin = |start: &Start| match start {
                Start::Call(function, x) => f64::call(*function, &at(x)[0]),
                Start::Atan2(y, x) => at(y)[0].atan2(at(x)[0]),
            };
            let order = k as f64;
            let found = match step {
                SeriesStep::Still(_) if k > 0 => 0.0,
                SeriesStep::Still(operation) => match operation {
                    Operation::Number(value) => value.to_f64(),
                    Operation::Pi => std::f64::consts::PI,
                    Operation::Symbol(s) => symbol(*s),
                    Operation::Prepared(place) => prepared[*place],
                    Operation::Add(a, b) => at(a)[0] + at(b)[0],
                    Operation::Sub(a, b) => at(a)[0] - at(b)[0],
                    Operation::Neg(a) => -at(a)[0],
                    Operation::Mul(a, b) => at(a)[0] * at(b)[0],
                    Operation::Div(a, b) => at(a)[0] / at(b)[0],
                    Operation::Call(function, x) => f64::call(*function, &at(x)[0]),
                    Operation::Apply(function, arguments) => {
                        f64::apply(*function, &arguments.iter().map(|x| at(x)[0]).collect::<Vec<f64>>())
                    }
                    Operation::SinCos { .. } => unreachable!("series have none"),
                },
                SeriesStep::Time => [time, 1.0].get(k).copied().unwrap_or(0.0),
                SeriesStep::Variable(i) if k > 0 => at(&series.rates[*i])[k - 1] / order,
                SeriesStep::Variable(i) => match i.checked_sub(start.len()) {
                    None => start[*i],
                    Some(place) => begin(&series.carried[place]),
                },
                SeriesStep::Input(i) => inputs[*i].get(k).copied().unwrap_or(0.0),
                SeriesStep::Add(a, b) => at(a)[k] + at(b)[k],
                SeriesStep::Sub(a, b) => at(a)[k] - at(b)[k],
                SeriesStep::Neg(a) => -at(a)[k],
                SeriesStep::Scale(a, b) => at(a)[0] * at(b)[k],
                SeriesStep::Product(a, b, _) => products(at(a), at(b), 0),
                SeriesStep::Along(a, b, _) => products(at(a), at(b), 1),
                SeriesStep::Quotient(a, b, _) => {
                    let own: f64 = (1..=k).map(|j| at(b)[j] * all[v][k - j]).sum();
                    (at(a)[k] - own) / at(b)[0]
                }
                SeriesStep::SquareRoot(a, _) if k == 0 => at(a)[0].sqrt(),
                SeriesStep::SquareRoot(a, _) => {
                    let own: f64 = (1..k).map(|j| all[v][j] * all[v][k - j]).sum();
                    (at(a)[k] - own) / (2.0 * all[v][0])
                }
                SeriesStep::Derivative(a) => order * at(a)[k],
                SeriesStep::Integral(start, _) if k == 0 => begin(start),
                SeriesStep::Integral(_, rate) => at(rate)[k] / order,
            };
            all[v][k] = found;
        }
    }
    let own = |i: usize| series.steps.iter().position(|step| *step == SeriesStep::Variable(i));
    // A variable that nothing reads has no step.
    let rate = |i: usize, k: usize| all[series.rates[i].index()][k - 1] / k as f64;
    let of = |i: usize| match own(i) {
        Some(v) => all[v],
        None => std::array::from_fn(|k| if k == 0 { start[i] } else { rate(i, k) }),
    };
    (0..start.len()).map(of).collect()
}

/// A polynomial and its rate.
fn polynomial(coefficients: &[f64], s: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, rate), c| (value * s + c, rate * s + value))
}

#[derive(Default)]
struct Seen {
    states: usize,
    along_inputs: usize,
    worst: f64,
}

fn look_at(text: &str, derived: &DerivedSystem<'_>, draw: &mut Draw) -> Seen {
    let (model, level) = (&derived.model, &derived.system);
    let symbol = |e| model.bench.graph.as_symbol(e).expect("a symbol");
    let series = level.series.as_ref().expect("a series");
    let numbers = numbers(derived);
    let declared = &numbers.declared;
    let variables: Vec<SymbolId> =
        level.selection.variables.iter().map(|place| symbol(model.variable(*place))).collect();
    let inputs: Vec<SymbolId> = model.inputs.iter().map(|input| symbol(input.symbol)).collect();
    let time = symbol(model.mechanics.forms.time);
    let mut seen = Seen::default();
    for _ in 0..STATES {
        let Some((point, etas)) = declared.state(draw) else { continue };
        let Some(reference) = multipliers::solve(declared, &point) else { continue };
        let unit = reference.condition * reference.scale;
        if unit > LARGEST {
            continue;
        }
        let values = numbers.values(model, &point, &etas);
        let value = |own: SymbolId| {
            let known = values.iter().find(|(known, _)| *known == own);
            known.map(|(_, value)| *value).expect("a symbol of the declaration")
        };
        let start: Vec<f64> = variables.iter().map(|own| value(*own)).collect();
        let prepared = evaluate_prepare(&level.programs, value);
        let held: Vec<Vec<f64>> = inputs.iter().map(|input| vec![value(*input)]).collect();
        let moving: Vec<Vec<f64>> =
            held.iter().map(|held| [held[0], draw.real(-1.0, 1.0), draw.real(-1.0, 1.0)].to_vec()).collect();
        let mut all = vec![(&series.held, held)];
        if let Some(along) = &series.along_inputs {
            all.push((along, moving));
            seen.along_inputs += 1;
        }
        for (program, given) in all {
            let found = coefficients(program, &start, &given, (point[0], &prepared), &value);
            let terms = found.iter().flat_map(|own| own.iter().enumerate().skip(1));
            let radius = terms.fold(1.0_f64, |least, (k, c)| least.min(c.abs().powf(-1.0 / k as f64)));
            let s = STEP * radius;
            let then: Vec<(f64, f64)> = found.iter().map(|own| polynomial(own, s)).collect();
            let rates = evaluated(level, function::RHS, |own| {
                if own == time {
                    return point[0] + s;
                }
                if let Some(i) = variables.iter().position(|known| *known == own) {
                    return then[i].0;
                }
                match inputs.iter().position(|known| *known == own) {
                    Some(i) => polynomial(&given[i], s).0,
                    None => value(own),
                }
            });
            for (i, (rate, (_, own))) in rates.expect("a right-hand side").iter().zip(&then).enumerate() {
                let ratio = (rate - own).abs() * radius / unit;
                assert!(ratio <= SMALL, "{i}: {own}, and not {rate}, in {found:?} of\n{text}");
                seen.worst = seen.worst.max(ratio);
            }
        }
        seen.states += 1;
    }
    seen
}

#[test]
fn taylor_series_of_drawn_declarations() {
    let rounds = rounds(8);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let text = scenes::with(&grammar::of_one_formula(*seed), &["provide taylor;".to_owned()]);
        let (declaration, _) = parse::parse(text.parse().expect("tokens"));
        let declaration = declaration.expect("a declaration");
        let (derived, faults) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
        match derived {
            Some(derived) if faults.is_empty() => {
                Some(look_at(&text, &derived, &mut Draw::new(seed.rotate_left(37))))
            }
            _ => {
                let message = faults.faults()[0].message();
                assert!(message.starts_with("the Taylor series needs"), "{seed}: {message}\n{text}");
                None
            }
        }
    });
    let seen: Vec<&Seen> = found.iter().flatten().collect();
    let sum = |of: fn(&Seen) -> usize| seen.iter().map(|seen| of(seen)).sum::<usize>();
    let (states, along) = (sum(|seen| seen.states), sum(|seen| seen.along_inputs));
    println!(
        "{states} states of {rounds} systems, {} too large, {along} along inputs, residuals of at most {:.1e}",
        found.len() - seen.len(),
        seen.iter().map(|seen| seen.worst).fold(0.0, f64::max)
    );
    assert!(states as u64 >= rounds && along > 0, "{states} states, {along} along inputs");
}
