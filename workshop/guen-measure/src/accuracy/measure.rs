//! Errors of right-hand sides against values of 71 digits.
//!
//! The reference shares nothing with the emitted code but the declaration: it is (2.7) as the definition gives it, before
//! any simplification, evaluated in 256 bits and solved there by elimination. The same expressions in double precision are
//! the *raw* program that simplification must not be worse than. Constants are rounded to double precision first, so
//! that the errors are those of the arithmetic alone.

use std::iter::zip;

use f256::f256;
use guen::{Real as _, System};
use guen_benchmarks::{Random, Subject};
use guen_language::diagnostics::collect;
use guen_language::{model, parse};
use guen_symbolic::{ExprId, Frame, Graph, Operators, Real, SymbolId, equations_by_definition, evaluate};

/// The largest errors over some states, each as the largest error of a rate divided by the largest rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    /// The error of the declared system.
    pub declared: f64,
    /// The error of the program written by hand.
    pub by_hand: f64,
    /// The error of the raw program.
    pub raw: f64,
}

/// (2.7) before simplification: velocities, mass matrix, forces, as expressions.
struct Raw {
    graph: Graph,
    roots: Vec<ExprId>,
    /// The symbols of constants, coordinates and parameters.
    constants: Vec<SymbolId>,
    state: Vec<SymbolId>,
    degrees: usize,
}

impl Raw {
    fn of(declaration: &str) -> Self {
        let tokens = declaration.parse().expect("a declaration is made of tokens");
        let (parsed, report) = parse::parse(tokens);
        assert!(report.is_empty(), "{report}");
        let parsed = parsed.expect("there is a declaration where there is no fault");
        let (resolved, report) = collect(|faults| model::resolve(&parsed, faults));
        assert!(report.is_empty(), "{report}");
        let model::Model { mut bench, mechanics, constants, coordinates, .. } =
            resolved.expect("there is a model where there is no fault");
        let operators = Operators::new(&mut bench, &mechanics.forms);
        let operators = operators.unwrap_or_else(|_| panic!("the forms are independent"));
        let mut frame = Frame::new(&mut bench, &mechanics, operators);
        let equations = equations_by_definition(&mut bench, &mechanics, &mut frame);
        let degrees = mechanics.forms.degrees;
        let graph = bench.graph;
        let symbol = |e: &ExprId| graph.as_symbol(*e).expect("constants and states are symbols");
        let state =
            coordinates.iter().map(|entry| entry.symbol).chain(mechanics.etas[..degrees].iter().copied());
        let state = state.map(|e| symbol(&e)).collect();
        let constants = constants.iter().map(|entry| symbol(&entry.symbol)).collect();
        let roots =
            frame.velocities.into_iter().chain(equations.mass.concat()).chain(equations.forces).collect();
        Raw { graph, roots, constants, state, degrees }
    }

    /// The rates, in any arithmetic.
    fn rates<R: Real>(&self, number: impl Fn(f64) -> R, constants: &[f64], state: &[f64]) -> Vec<R> {
        let value = |symbol: SymbolId| -> R {
            let known = zip(&self.constants, constants).chain(zip(&self.state, state));
            let found = known.into_iter().find(|(known, _)| **known == symbol).map(|(_, value)| *value);
            number(found.expect("only constants and the state occur"))
        };
        let mut values = evaluate(&self.graph, &self.roots, &value);
        let l = self.degrees;
        let forces = values.split_off(values.len() - l);
        let entries = values.split_off(values.len() - l * l);
        values.extend(solved(entries.chunks(l).map(<[R]>::to_vec).collect(), forces));
        values
    }
}

/// Elimination without pivoting: mass matrices are positive definite.
#[allow(clippy::needless_range_loop, reason = "indices as in the formulas")]
fn solved<R: Real>(mut m: Vec<Vec<R>>, mut f: Vec<R>) -> Vec<R> {
    let n = f.len();
    for j in 0..n {
        for i in j + 1..n {
            let factor = m[i][j] / m[j][j];
            for k in j..n {
                m[i][k] = m[i][k] - factor * m[j][k];
            }
            f[i] = f[i] - factor * f[j];
        }
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            f[i] = f[i] - m[i][k] * f[k];
        }
        f[i] = f[i] / m[i][i];
    }
    f
}

/// Errors over as many states: as they occur, then near singular ones.
pub fn errors<S: Subject<N>, const N: usize>(states: usize) -> [Errors; 2] {
    let raw = Raw::of(S::DECLARATION);
    let constants: Vec<f64> =
        S::CONSTANTS.iter().map(|(_, (num, den))| f64::from_ratio(*num, *den)).collect();
    let (declared, by_hand) = (S::declared::<f64>(), S::by_hand::<f64>());
    [S::state, S::near_singular].map(|draw| {
        let mut random = Random::new(7);
        let mut worst = Errors::default();
        for _ in 0..states {
            let state = draw(&mut random);
            let reference = raw.rates(f256::from, &constants, &state);
            let error = |rates: &[f64]| relative(rates, &reference);
            worst.declared = worst.declared.max(error(&declared.rhs(0.0, &state)));
            worst.by_hand = worst.by_hand.max(error(&by_hand.rhs(0.0, &state)));
            worst.raw = worst.raw.max(error(&raw.rates(|x| x, &constants, &state)));
        }
        worst
    })
}

/// The largest error, relative to the largest rate. What is not a number is infinitely wrong.
fn relative(rates: &[f64], reference: &[f256]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f256>| {
        values
            .map(|value| value.abs())
            .fold(f256::ZERO, |largest, value| if value > largest { value } else { largest })
    };
    if rates.iter().any(|rate| !rate.is_finite()) {
        return f64::INFINITY;
    }
    let size = largest(&mut reference.iter().copied());
    let error = largest(&mut zip(rates, reference).map(|(rate, exact)| f256::from(*rate) - *exact));
    // A ratio of a few units in the last place of a double has no other way into a double than its digits.
    (error / size).to_string().parse().unwrap_or(f64::INFINITY)
}
