//! Jacobians of programs against the derivatives of their expressions.

use super::super::thresholds::LARGEST_DIFFERENTIATED;
use super::{Dice, direct, programs, random_system};
use crate::algebra::{ExprId, Flow, Function, Graph, Role, SymbolId};
use crate::program::{Programs, evaluate_function, evaluate_prepare};

/// The coordinates of a graph.
fn variables(graph: &Graph) -> Vec<SymbolId> {
    graph.symbols().filter(|s| graph.symbol_info(*s).role == Role::Coordinate).collect()
}

fn differentiated(graph: &mut Graph, outputs: &[ExprId]) -> (Programs, Vec<(usize, usize)>) {
    let mut programs = programs(graph, outputs);
    let of_constants = |s| graph.symbol_info(s).role == Role::Constant;
    let pattern = programs.add_jacobian("jacobian", 0, &variables(graph), of_constants);
    (programs, pattern.expect("the function is small"))
}

/// The Jacobian agrees with the graph's derivatives at some points, and what it leaves out vanishes.
fn check(graph: &mut Graph, outputs: &[ExprId], dice: &mut Dice) {
    let (programs, pattern) = differentiated(graph, outputs);
    let variables = variables(graph);
    let mut slopes = Vec::new();
    for symbol in &variables {
        let mut by = Flow::partial(graph, graph.symbol_expr(*symbol));
        slopes.push(outputs.iter().map(|e| by.of(graph, *e)).collect::<Vec<_>>());
    }
    for _ in 0..3 {
        let symbols: Vec<f64> = graph.symbols().map(|_| dice.real()).collect();
        let prepared = evaluate_prepare(&programs, |s| symbols[s.index()]);
        let found = evaluate_function(&programs, 1, &prepared, |s| symbols[s.index()]);
        for (column, slopes) in slopes.iter().enumerate() {
            let expected = direct(graph, slopes, &symbols);
            for (row, b) in expected.iter().enumerate() {
                let place = pattern.iter().position(|cell| *cell == (row, column));
                let a = place.map_or(0.0, |place| found[place]);
                let close = (a - b).abs() <= 1e-8 * (1.0 + b.abs()) || (!a.is_finite() && !b.is_finite());
                assert!(close || b.abs() > 1e12, "d{row}/d{column}: {a} instead of {b}");
            }
        }
    }
}

#[test]
fn jacobians_of_random_programs_are_derivatives() {
    for seed in 0..300 {
        let mut dice = Dice(5000 + seed);
        let (mut g, outputs) = random_system(&mut dice, 30);
        check(&mut g, &outputs, &mut dice);
    }
}

#[test]
fn jacobians_of_every_function_are_derivatives() {
    use Function::{Abs, Acos, Asin, Atan, Cos, Cosh, Exp, Ln, Root, Sign, Sin, Sinh, Tanh};
    for function in
        [Abs, Acos, Asin, Atan, Cos, Cosh, Exp, Ln, Root(2), Root(3), Root(5), Sign, Sin, Sinh, Tanh]
    {
        let mut g = Graph::new();
        let (x, y) = (g.symbol("x", Role::Coordinate), g.symbol("y", Role::Coordinate));
        // Between 0.07 and 0.65, inside every domain.
        let inside = g.mul(x, y);
        let inside = {
            let half = g.ratio(2, 7);
            g.mul(half, inside)
        };
        let e = g.function(function, inside);
        let e = g.mul(e, x);
        check(&mut g, &[e, inside], &mut Dice(7));
    }
    let mut g = Graph::new();
    let (x, y) = (g.symbol("x", Role::Coordinate), g.symbol("y", Role::Coordinate));
    let e = g.atan2(y, x);
    check(&mut g, &[e], &mut Dice(7));
}

#[test]
fn what_is_constant_is_prepared() {
    // f = a b x + sin(y): the derivatives are a b, which needs no operation, and a cosine without a sine.
    let mut g = Graph::new();
    let [x, y] = ["x", "y"].map(|name| g.symbol(name, Role::Coordinate));
    let [a, b] = ["a", "b"].map(|name| g.symbol(name, Role::Constant));
    let (bx, sine) = (g.mul(b, x), g.sin(y));
    let inner = g.add(bx, sine);
    let e = g.mul(a, inner);
    let (programs, pattern) = differentiated(&mut g, &[e]);
    assert_eq!(pattern, [(0, 0), (0, 1)]);
    let cost = programs.functions[1].cost;
    assert_eq!((cost.operations(), cost.sines), (1, 1));
}

#[test]
fn what_is_too_long_is_left_to_duals() {
    let mut g = Graph::new();
    let x = g.symbol("x", Role::Coordinate);
    let mut e = x;
    for _ in 0..LARGEST_DIFFERENTIATED {
        let sine = g.sin(e);
        e = g.add(sine, x);
    }
    let mut programs = programs(&mut g, &[e]);
    let before = programs.clone();
    assert_eq!(programs.add_jacobian("jacobian", 0, &variables(&g), |_| false), None);
    assert_eq!(programs, before);
}
