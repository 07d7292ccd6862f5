//! Mechanisms drawn at random: each ends with rates that are those of the multipliers, or with an error; nothing is refused that the
//! multipliers solve. Of every third the operations with no bounds on its constants, with some and with all are compared. What more bounds
//! may cost is what the optimiser, which gives way to the first of equals, leaves to the order of terms: an operation or two percent,
//! six percent in one of forty.

use std::panic::{AssertUnwindSafe, catch_unwind};

use guen_language::derive::{DerivedSystem, derive, function};
use guen_language::diagnostics::collect;
use guen_language::{model, parse};
use guen_symbolic::{ExprId, SymbolId};
use nalgebra::DMatrix;

use super::declared::Declared;
use super::draw::Draw;
use super::mechanisms::{self, Mechanism};
use super::{Numbers, multipliers, numbers_of};
use crate::common::{by_two_threads, evaluated, rounds};
use crate::families::{parallel, robots};

/// Largest difference, in units of condition times scale.
const ROUNDING: f64 = 1e-12;
/// Below this condition a system is solvable beyond doubt.
const CLEAR: f64 = 1e5;
/// States of each mechanism.
const STATES: usize = 2;

/// The outcomes of some mechanisms.
#[derive(Default)]
struct Seen {
    accepted: usize,
    refused: usize,
    states: usize,
    /// Without a state that the multipliers solve.
    unseen: usize,
    worst: f64,
    compared: usize,
    /// The mechanisms that cost more operations with more bounds on constants.
    costlier: Vec<String>,
    /// The number of these that cost more by at least two percent and more than one operation.
    costlier_by_two_percent: usize,
    /// The largest ratio of the operations with more bounds to those with fewer, among these.
    ratio: f64,
    faults: Vec<String>,
    /// First lines of errors.
    messages: Vec<String>,
}

impl Seen {
    fn add(&mut self, other: Seen) {
        self.accepted += other.accepted;
        self.refused += other.refused;
        self.states += other.states;
        self.unseen += other.unseen;
        self.worst = self.worst.max(other.worst);
        self.compared += other.compared;
        self.costlier.extend(other.costlier);
        self.costlier_by_two_percent += other.costlier_by_two_percent;
        self.ratio = self.ratio.max(other.ratio);
        self.faults.extend(other.faults);
        self.messages.extend(other.messages);
    }
}

/// What a declaration ends with: what follows from it, or what is said of it and whether multipliers solve it all the same.
enum End<T> {
    DerivedSystem(T),
    Refused { message: String, is_solvable: bool },
}

/// Whether the forms, those of the parameters among them, are clearly independent.
fn are_independent(declared: &Declared<'_>, point: &[f64]) -> bool {
    let n = declared.n;
    let forms = declared.forms_at(point);
    let matrix = DMatrix::from_fn(n, n, |j, i| forms[j][i]);
    let singular = matrix.svd(false, false).singular_values;
    singular.max() < CLEAR * singular.min()
}

fn ended<T>(text: &str, seed: u64, look: impl FnOnce(&DerivedSystem<'_>) -> T) -> End<T> {
    let (declaration, report) = parse::parse(text.parse().expect("tokens"));
    let declaration = declaration.unwrap_or_else(|| panic!("{}", report.to_compile_errors()));
    let mut is_solvable = false;
    let (derived, report) = collect(|faults| {
        let model = model::resolve(&declaration, faults)?;
        let numbers = numbers_of(&model);
        let derived = derive(model, faults);
        if derived.is_none() {
            let mut draw = Draw::new(seed);
            let states: Vec<_> = (0..STATES).filter_map(|_| numbers.declared.state(&mut draw)).collect();
            let is_regular = |(point, _): &(Vec<f64>, Vec<f64>)| {
                multipliers::solve(&numbers.declared, point).is_some_and(|found| found.condition < CLEAR)
                    && are_independent(&numbers.declared, point)
            };
            is_solvable = !states.is_empty() && states.iter().all(is_regular);
        }
        derived
    });
    match derived {
        Some(derived) => End::DerivedSystem(look(&derived)),
        None => {
            let fault = report.faults().first().expect("a reason");
            End::Refused { message: fault.message().to_owned(), is_solvable }
        }
    }
}

/// The largest difference from the multipliers, the states that were looked at, and what is wrong.
fn difference(derived: &DerivedSystem<'_>, seed: u64) -> (f64, usize, Option<String>) {
    let model = &derived.model;
    let symbol = |e: ExprId| model.bench.graph.as_symbol(e).expect("a symbol");
    let Numbers { declared, coordinates, held } = numbers_of(model);
    let mut draw = Draw::new(!seed);
    let (mut worst, mut states) = (0.0_f64, 0);
    for _ in 0..STATES {
        let Some((point, etas)) = declared.state(&mut draw) else { continue };
        let Some(reference) = multipliers::solve(&declared, &point) else { continue };
        let unit = reference.condition * reference.scale;
        if unit.is_nan() || unit > super::LARGEST {
            continue;
        }
        states += 1;
        let n = declared.n;
        let mechanics = &model.mechanics;
        let mut values: Vec<(SymbolId, f64)> = vec![(symbol(mechanics.forms.time), point[0])];
        values.extend(coordinates.iter().map(|(_, symbol)| *symbol).zip(point[1..].iter().copied()));
        values.extend(held.iter().map(|(_, symbol)| *symbol).zip(point[2 * n + 1..].iter().copied()));
        values.extend(mechanics.etas.iter().map(|e| symbol(*e)).zip(etas.iter().copied()));
        let value = |symbol: SymbolId| {
            values.iter().find(|(known, _)| *known == symbol).map(|(_, value)| *value).expect("a symbol")
        };
        let found = evaluated(&derived.system, function::RHS, value).expect("rates");
        let speeds = declared.velocities.iter().map(|v| point[*v]);
        let expected: Vec<f64> = speeds.chain(reference.accelerations.iter().copied()).collect();
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(&expected) {
            let ratio = (a - b).abs() / unit;
            worst = worst.max(ratio);
            if ratio.is_nan() || ratio > ROUNDING {
                return (
                    worst,
                    states,
                    Some(format!(
                        "rates {found:?}, and not {expected:?}; condition {:e}",
                        reference.condition
                    )),
                );
            }
        }
    }
    (worst, states, None)
}

fn operations(derived: &DerivedSystem<'_>) -> u64 {
    derived.system.program(function::RHS).map_or(0, |rhs| rhs.cost.weighted())
}

/// The operations of the rates with bounds on some constants; none if they are refused.
fn cost(mechanism: &Mechanism, seed: u64, is_bounded: impl Fn(usize) -> bool) -> Option<u64> {
    match ended(&mechanism.text(is_bounded), seed, operations) {
        End::DerivedSystem(cost) => Some(cost),
        End::Refused { .. } => None,
    }
}

fn looked_at(seed: u64) -> Seen {
    let mechanism = mechanisms::drawn(seed);
    let mut seen = Seen::default();
    let bare = mechanism.text(|_| false);
    match ended(&bare, seed, |derived| (operations(derived), difference(derived, seed))) {
        End::Refused { message, is_solvable } => {
            seen.refused += 1;
            let broken = ["bug", "too large"].iter().any(|word| message.contains(word));
            if is_solvable || broken {
                seen.faults.push(format!("number {seed}: refused ({message}), solvable: {is_solvable}"));
            }
            seen.messages.push(message);
        }
        End::DerivedSystem((without, (worst, states, fault))) => {
            seen.accepted += 1;
            seen.states += states;
            seen.unseen += usize::from(states == 0);
            seen.worst = worst;
            seen.faults.extend(fault.map(|what| format!("number {seed}: {what}")));
            if !seed.is_multiple_of(3) {
                return seen;
            }
            let mut draw = Draw::new(seed.rotate_left(31));
            let some: Vec<bool> = (0..mechanism.constants()).map(|_| draw.once_in(2)).collect();
            let (Some(partly), Some(all)) =
                (cost(&mechanism, seed, |i| some[i]), cost(&mechanism, seed, |_| true))
            else {
                seen.faults.push(format!("number {seed}: bounds have it refused"));
                return seen;
            };
            seen.compared += 1;
            let told =
                format!("number {seed}: {without}, {partly}, {all} operations with more and more bounds");
            let is_costlier = |more: u64, fewer: u64| more * 50 > fewer * 51 + 50;
            for (more, fewer) in [(all, partly), (partly, without), (all, without)] {
                if is_costlier(more, fewer) {
                    seen.costlier_by_two_percent = 1;
                    seen.ratio = seen.ratio.max(more as f64 / fewer as f64);
                }
            }
            if all > partly || partly > without {
                seen.costlier.push(told);
            }
        }
    }
    seen
}

/// More of them with `GUEN_ROUNDS`; that of one number with `GUEN_ONLY`, which prints it.
/// Loops that meet in one body: what vanishes by their equations follows from more than the bodies need, or from velocities that turn back. Legs
/// that are mounted at a third of a turn: their first axis points anywhere.
#[test]
fn robots_are_derived_by_bodies() {
    let arms = "for i in 0..n { w[i] = dot(q[i]); }";
    let plate = "vx = dot(x); vy = dot(y); vz = dot(z);";
    let legs = "for i in 0..n { v[i] = dot(s[i]); }";
    let spins = "vx = dot(x); vy = dot(y); vz = dot(z); w = angular_velocity_body(R);";
    let robots = [
        parallel::delta(arms),
        parallel::delta(plate),
        parallel::two_arms(2),
        parallel::two_arms(3),
        parallel::platform(legs),
        parallel::platform(spins),
        parallel::platform_on_quaternion(legs),
        parallel::planar_platform(),
        robots::tripod(),
    ];
    for text in robots {
        let looked = |derived: &DerivedSystem<'_>| {
            let declined = &derived.system.derivation.declined;
            assert!(declined.iter().all(|(formulation, _)| *formulation != "bodies"), "{text}");
            // Not every draw closes all loops.
            let drawn = |seed| difference(derived, seed);
            (0..40).map(drawn).find(|(_, states, _)| *states > 0).expect("a state")
        };
        match ended(&text, 7, looked) {
            End::DerivedSystem((worst, states, wrong)) => {
                assert!(wrong.is_none(), "{worst} at {states} states: {wrong:?}\n{text}");
            }
            End::Refused { message, .. } => panic!("{message}\n{text}"),
        }
    }
}

/// Parameters that are no rates of coordinates have rates of their own beside those of velocities: here `s' s'`. In the declared parameters
/// the platform takes some 12,000 operations.
#[test]
fn other_velocities_are_turned_back() {
    let looked = |derived: &DerivedSystem<'_>| {
        let count = derived.system.program(function::RHS).map_or(0, |rhs| rhs.cost.operations());
        assert!((1..5000).contains(&count), "{count} operations");
        (0..40).map(|seed| difference(derived, seed)).find(|(_, states, _)| *states > 0).expect("a state")
    };
    let text = parallel::platform("for i in 0..n { v[i] = s[i]*dot(s[i]); }");
    let End::DerivedSystem((worst, _, wrong)) = ended(&text, 7, looked) else { panic!("refused") };
    assert!(wrong.is_none(), "{worst}: {wrong:?}");
}

/// A leg that is stretched is a dead point for the plate that it carries, and none for the motors whose rates are the parameters.
#[test]
fn other_velocities_have_no_dead_points_of_their_own() {
    let looked = |derived: &DerivedSystem<'_>| {
        let graph = &derived.model.bench.graph;
        let stretched = |symbol: SymbolId| match &graph.symbol_info(symbol).name[..] {
            "e[0]" => 0.0,
            name => {
                0.5 + 0.37 * (1.0 + name.bytes().fold(0.0, |sum, byte| 1.3 * sum + f64::from(byte))).sin()
            }
        };
        evaluated(&derived.system, function::RHS, stretched).expect("rates")
    };
    let End::DerivedSystem(rates) = ended(&parallel::planar_platform(), 3, looked) else { panic!("refused") };
    assert!(rates.iter().all(|rate| rate.abs() < 1e6), "{rates:?}");
}

#[test]
fn mechanisms_end_with_the_right_rates_or_an_error() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let rounds = rounds(60);
    let first = number("GUEN_FIRST").unwrap_or(0);
    let only = number("GUEN_ONLY");
    if let Some(seed) = only {
        println!("{}", mechanisms::drawn(seed).text(|_| false));
    }
    let seeds: Vec<u64> = only.map_or_else(|| (first..first + rounds).collect(), |seed| vec![seed]);
    let found = by_two_threads(&seeds, |seed| catch_unwind(AssertUnwindSafe(|| looked_at(*seed))));
    let mut all = Seen::default();
    for (seed, found) in seeds.iter().zip(found) {
        match found {
            Ok(seen) => all.add(seen),
            Err(_) => all.faults.push(format!("number {seed}: a panic")),
        }
    }
    println!(
        "{} accepted, {} without a state, {} refused; {} states, at most {:.1e} of condition times scale; bounds cost in {} of {}, much in {}, at most {:.2} times",
        all.accepted,
        all.unseen,
        all.refused,
        all.states,
        all.worst,
        all.costlier.len(),
        all.compared,
        all.costlier_by_two_percent,
        all.ratio
    );
    all.messages.sort();
    for message in all.messages.iter().chain(&all.costlier).chain(&all.faults) {
        println!("{message}");
    }
    assert!(all.faults.is_empty(), "{} faults", all.faults.len());
    assert!(
        40 * all.costlier_by_two_percent <= all.compared.max(40) && all.ratio <= 1.07,
        "bounds cost in {} of {}",
        all.costlier_by_two_percent,
        all.compared
    );
    assert!(only.is_some() || 2 * all.accepted as u64 > rounds && all.states > all.accepted);
}
