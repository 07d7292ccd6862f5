//! Programs equal their expressions, with and without each pass.

mod jacobian;
mod reuse;
mod systems;

use super::lower::{PreparedTable, lower};
use super::net::{Conversion, Field, Net};
use super::passes::{CANDIDATES, Pass, apply};
use super::{FunctionProgram, OperationCount, ProgramBuilder, Programs, evaluate_function, evaluate_prepare};
use crate::algebra::{ExprId, Function, Graph, Node, Rational, Role};

/// Pseudo-random numbers with a fixed seed.
struct Dice(u64);

impl Dice {
    // Knuth's linear congruential generator; its high bits are random enough for choosing cases.
    fn step(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }
    fn next(&mut self, n: usize) -> usize {
        (self.step() % n as u64) as usize
    }
    /// Between 0.5 and 1.5.
    fn real(&mut self) -> f64 {
        self.step() as f64 / (1_u64 << 31) as f64 + 0.5
    }
}

/// The values of expressions, straight from the graph.
fn direct(graph: &Graph, roots: &[ExprId], symbols: &[f64]) -> Vec<f64> {
    use super::Arithmetic;
    let mut values = vec![f64::NAN; graph.len()];
    for id in graph.reachable(roots, |_| false) {
        values[id.index()] = match graph.node(id) {
            Node::Number(value) => value.to_f64(),
            Node::Pi => std::f64::consts::PI,
            Node::Symbol(symbol) => symbols[symbol.index()],
            Node::Sum { constant, terms } => {
                terms.iter().fold(constant.to_f64(), |sum, (term, c)| sum + values[term.index()] * c.to_f64())
            }
            Node::Product(factors) => {
                factors.iter().fold(1.0, |p, (base, e)| p * values[base.index()].powi(*e))
            }
            Node::Function(function, x) => f64::call(*function, &values[x.index()]),
            Node::Multivariate(function, arguments) => {
                let arguments: Vec<f64> = arguments.iter().map(|e| values[e.index()]).collect();
                f64::apply(*function, &arguments)
            }
            Node::Kept(x) => values[x.index()],
            Node::Undefined => f64::NAN,
        };
    }
    roots.iter().map(|root| values[root.index()]).collect()
}

fn programs(graph: &mut Graph, outputs: &[ExprId]) -> Programs {
    let mut builder = ProgramBuilder::new(graph);
    builder.add_function("f", outputs);
    builder.finish()
}

/// The program and the graph agree at some points, to within what cancellation at them may lose.
fn check(graph: &mut Graph, outputs: &[ExprId], dice: &mut Dice) -> Programs {
    let programs = programs(graph, outputs);
    agree(graph, outputs, &programs, dice);
    programs
}

fn agree(graph: &Graph, outputs: &[ExprId], programs: &Programs, dice: &mut Dice) {
    let count = graph.symbols().count();
    for _ in 0..3 {
        let symbols: Vec<f64> = (0..count).map(|_| dice.real()).collect();
        let expected = direct(graph, outputs, &symbols);
        let prepared = evaluate_prepare(programs, |s| symbols[s.index()]);
        let found = evaluate_function(programs, 0, &prepared, |s| symbols[s.index()]);
        for (i, (a, b)) in found.iter().zip(&expected).enumerate() {
            let close = (a - b).abs() <= 1e-8 * (1.0 + b.abs()) || (!a.is_finite() && !b.is_finite());
            // Ill-conditioned random expressions exist: compare again in units of the largest value seen.
            assert!(close || b.abs() > 1e12, "output {i}: {a} instead of {b}");
        }
    }
}

fn random_expression(graph: &mut Graph, pool: &mut Vec<ExprId>, dice: &mut Dice) {
    let pick = |dice: &mut Dice, pool: &[ExprId]| pool[dice.next(pool.len())];
    let (a, b) = (pick(dice, pool), pick(dice, pool));
    let e = match dice.next(16) {
        0..=3 => graph.add(a, b),
        4 | 5 => graph.sub(a, b),
        6..=9 => graph.mul(a, b),
        10 => {
            let b2 = graph.powi(b, 2);
            let one = graph.one();
            let below = graph.add(b2, one);
            graph.div(a, below)
        }
        11 => graph.powi(a, 1 + dice.next(3) as i32),
        12 => graph.sin(a),
        13 => graph.cos(a),
        14 => {
            let a2 = graph.powi(a, 2);
            let one = graph.one();
            let inside = graph.add(a2, one);
            graph.sqrt(inside)
        }
        _ => {
            let function = [Function::Atan, Function::Tanh, Function::Abs, Function::Sign][dice.next(4)];
            graph.function(function, a)
        }
    };
    let n = graph.ratio(dice.next(7) as i64 - 3, 1 + dice.next(3) as i64);
    let e = if dice.next(4) == 0 { graph.mul(e, n) } else { e };
    if graph.as_number(e).is_none() {
        pool.push(e);
    }
}

/// A graph with random expressions, the last of which are the most involved.
fn random_system(dice: &mut Dice, length: usize) -> (Graph, Vec<ExprId>) {
    let mut g = Graph::new();
    let mut pool = Vec::new();
    for name in ["x", "y", "z"] {
        pool.push(g.symbol(name, Role::Coordinate));
    }
    for name in ["a", "b"] {
        pool.push(g.symbol(name, Role::Constant));
    }
    for _ in 0..length {
        random_expression(&mut g, &mut pool, dice);
    }
    let outputs = (0..4).map(|_| pool[dice.next(pool.len())]).chain(pool.last().copied()).collect();
    (g, outputs)
}

#[test]
fn random_programs_equal_their_expressions() {
    for seed in 0..300 {
        let mut dice = Dice(seed);
        let (mut g, outputs) = random_system(&mut dice, 30);
        check(&mut g, &outputs, &mut dice);
    }
}

/// Sequences of passes one by one, without a choice of the cheapest.
fn check_passes(graph: &mut Graph, outputs: &[ExprId], passes: &[Pass], dice: &mut Dice) {
    let mut net = Net::default();
    let mut prepared = PreparedTable::default();
    let mut roots = Conversion::roots(graph, &mut net, Field::Constants, outputs);
    for pass in passes {
        roots = apply(*pass, graph, &mut net, &roots);
    }
    let code = lower(graph, &net, &roots, &mut prepared);
    let cost = OperationCount::of(&code.instructions);
    let function = FunctionProgram {
        name: String::new(),
        instructions: code.instructions,
        outputs: code.outputs,
        values: code.values,
        cost,
    };
    let mut net = Net::default();
    let roots = Conversion::roots(graph, &mut net, Field::Numbers, &prepared.expressions);
    let code = lower(graph, &net, &roots, &mut PreparedTable::default());
    let prepare_cost = OperationCount::of(&code.instructions);
    let programs = Programs {
        prepare: code.instructions,
        prepared: code.outputs,
        prepare_values: code.values,
        prepare_cost,
        functions: vec![function],
    };
    agree(graph, outputs, &programs, dice);
}

#[test]
fn every_pass_keeps_functions_equal() {
    use Pass::{Absorb, Expand, FactorAll, FactorUnshared, Products, ProductsAndConstants, Signs, Sums};
    let single = [Absorb, Expand, FactorAll, FactorUnshared, Products, ProductsAndConstants, Signs, Sums];
    for seed in 0..100 {
        let mut dice = Dice(1000 + seed);
        let (mut g, outputs) = random_system(&mut dice, 25);
        check_passes(&mut g, &outputs, &[], &mut dice);
        for pass in single {
            check_passes(&mut g, &outputs, &[pass], &mut dice);
            check_passes(&mut g, &outputs, &[pass, Signs, pass], &mut dice);
        }
        for passes in CANDIDATES {
            check_passes(&mut g, &outputs, passes, &mut dice);
        }
    }
}

#[test]
fn constants_are_hoisted() {
    // The state part is k1 x + k2 with k1 = 2 a b/c and k2 = sqrt(a) + 1/3; nothing else is left for the function.
    let mut g = Graph::new();
    let x = g.symbol("x", Role::Coordinate);
    let [a, b, c] = ["a", "b", "c"].map(|name| g.symbol(name, Role::Constant));
    let (ab, root, third) = (g.mul(a, b), g.sqrt(a), g.ratio(1, 3));
    let k1 = g.div(ab, c);
    let two = g.number(2);
    let slope = g.product(&[(two, 1), (k1, 1), (x, 1)]);
    let e = g.sum([slope, root, third]);
    let programs = check(&mut g, &[e, a, third], &mut Dice(3));
    assert_eq!(programs.functions[0].cost.operations(), 2);
    // The constant `a` itself and the number are loaded as they are.
    assert_eq!(programs.prepared.len(), 2);
}

#[test]
fn multiple_angles_come_from_base_angles() {
    let mut g = Graph::new();
    let x = g.symbol("x", Role::Coordinate);
    let y = g.symbol("y", Role::Coordinate);
    let (sx, sy) = (g.sin(x), g.sin(y));
    let (x2, x3) = (g.scale(x, &Rational::integer(2)), g.scale(x, &Rational::integer(3)));
    let (sum, difference) = (g.add(x, y), g.sub(x, y));
    let outputs = [sx, sy, g.cos(x2), g.sin(x3), g.sin(sum), g.cos(sum), g.cos(difference)];
    let programs = check(&mut g, &outputs, &mut Dice(4));
    assert_eq!(programs.functions[0].cost.sines, 2);
    // One angle only: nothing to gain.
    let programs = check(&mut g, &outputs[6..], &mut Dice(4));
    assert_eq!(programs.functions[0].cost.sines, 1);
    assert_eq!(programs.functions[0].cost.operations(), 1);
}

#[test]
fn nothing_new_is_divided_by() {
    // b x + c y in both sums, in the ratio c/b: where b vanishes the program must stay finite.
    let mut g = Graph::new();
    let [x, y, z] = ["x", "y", "z"].map(|name| g.symbol(name, Role::Coordinate));
    let [b, c] = ["b", "c"].map(|name| g.symbol(name, Role::Constant));
    let (bx, cy) = (g.mul(b, x), g.mul(c, y));
    let z2 = g.powi(z, 2);
    let (first, second) = (g.sum([bx, cy, z]), g.sum([bx, cy, z2]));
    let (first, second) = (g.mul(first, b), g.mul(second, c));
    let programs = check(&mut g, &[first, second], &mut Dice(5));
    let prepared = evaluate_prepare(&programs, |_| 0.0);
    let values = evaluate_function(&programs, 0, &prepared, |_| 0.0);
    assert_eq!(values, [0.0, 0.0]);
}

#[test]
fn programs_are_the_same_every_time() {
    let once = || {
        let (mut g, outputs) = random_system(&mut Dice(42), 40);
        programs(&mut g, &outputs)
    };
    assert_eq!(once(), once());
}
