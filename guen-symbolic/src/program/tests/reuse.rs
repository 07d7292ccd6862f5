//! Values by products of others.

use f256::f256;

use super::Dice;
use crate::algebra::{ExprId, Function, Graph, Multivariate, Rational, Role, SignBound, SymbolId};
use crate::program::OperationCount;
use crate::program::evaluate::run;
use crate::program::instruction::{Instruction, Operation, Value};
use crate::program::lower::Code;
use crate::program::reuse::{in_order, reused};
use crate::zero::evaluate;

/// Code that is written operation by operation, on four symbols.
struct Writer {
    graph: Graph,
    code: Code,
    prepared: Vec<ExprId>,
}

impl Writer {
    fn new() -> Self {
        let code = Code { instructions: Vec::new(), outputs: Vec::new(), values: 0 };
        Writer { graph: Graph::new(), code, prepared: Vec::new() }
    }

    fn put(&mut self, operation: Operation) -> Value {
        let result = Value::new(self.code.values);
        self.code.values += 1;
        self.code.instructions.push(Instruction { result, operation });
        result
    }

    fn symbols<const N: usize>(&mut self) -> [Value; N] {
        std::array::from_fn(|i| {
            let e = self.graph.symbol(&format!("x{i}"), Role::Coordinate);
            let symbol = self.graph.as_symbol(e).expect("it was just made");
            self.put(Operation::Symbol(symbol))
        })
    }

    /// The operations before and after, with these outputs; and that these stay what they are.
    fn costs(mut self, outputs: &[Value]) -> [u32; 2] {
        self.code.outputs = outputs.to_vec();
        let Writer { graph, mut code, prepared } = self;
        code.instructions = in_order(&code.instructions, &code.outputs, code.values);
        let after = reused(&graph, &code, &prepared).unwrap_or_else(|| code.clone());
        let mut dice = Dice(7);
        for _ in 0..8 {
            let drawn: Vec<f256> = (0..8).map(|_| f256::from(2.0 * dice.real() - 2.0)).collect();
            let symbol = |symbol: SymbolId| drawn[symbol.index()];
            let constants = evaluate(&graph, &prepared, &symbol);
            let outputs =
                |code: &Code| run(&code.instructions, code.values, &code.outputs, &constants, symbol);
            let [before, after] = [&code, &after].map(outputs);
            for (before, after) in before.into_iter().zip(after) {
                // A value that was not finite may be anything: a division may have left the code.
                let is_close = f256::abs(&(before - after)) <= f256::from(1e-20);
                assert!(is_close || !before.is_finite(), "{before} {after}");
            }
        }
        [&code, &after].map(|code| OperationCount::of(&code.instructions).operations())
    }
}

#[test]
fn a_sum_that_is_a_product_of_values_is_one_multiplication() {
    let mut code = Writer::new();
    let [x, y, z] = code.symbols();
    let sum = code.put(Operation::Add(x, y));
    let (xz, yz) = (code.put(Operation::Mul(x, z)), code.put(Operation::Mul(y, z)));
    let product = code.put(Operation::Add(xz, yz));
    assert_eq!(code.costs(&[sum, product]), [4, 2]);
}

#[test]
fn equal_values_are_computed_once() {
    let mut code = Writer::new();
    let [x, y, z] = code.symbols();
    let (sum, xz, yz) =
        (code.put(Operation::Add(x, y)), code.put(Operation::Mul(x, z)), code.put(Operation::Mul(y, z)));
    let (first, second) = (code.put(Operation::Mul(sum, z)), code.put(Operation::Add(xz, yz)));
    assert_eq!(code.costs(&[first, second]), [5, 2]);
}

/// `w - (x - y) z` in place of `w + (y z - x z)`, and a product of two values that are the other way round.
#[test]
fn signs_move_into_what_a_value_is_used_for() {
    let mut code = Writer::new();
    let [x, y, z, w] = code.symbols();
    let difference = code.put(Operation::Sub(x, y));
    let (xz, yz) = (code.put(Operation::Mul(x, z)), code.put(Operation::Mul(y, z)));
    let opposite = code.put(Operation::Sub(yz, xz));
    let more = code.put(Operation::Mul(opposite, w));
    let (first, second) = (code.put(Operation::Add(w, more)), code.put(Operation::Sub(more, z)));
    let third = code.put(Operation::Sub(opposite, w));
    let fourth = code.put(Operation::Mul(third, third));
    assert_eq!(code.costs(&[difference, first, second, fourth]), [9, 8]);
}

/// A sign that has no place is an operation, and counts.
#[test]
fn an_output_is_not_turned() {
    let mut code = Writer::new();
    let [x, y, z] = code.symbols();
    let difference = code.put(Operation::Sub(x, y));
    let (xz, yz) = (code.put(Operation::Mul(x, z)), code.put(Operation::Mul(y, z)));
    let opposite = code.put(Operation::Sub(yz, xz));
    assert_eq!(code.costs(&[difference, opposite]), [4, 3]);
}

/// `(u + w)/w - 1` is `(u/y) (y/w)`, but not at `y = 0`.
#[test]
fn nothing_is_divided_by_that_was_not() {
    let mut code = Writer::new();
    let [u, w, y] = code.symbols();
    let (first, second) = (code.put(Operation::Div(u, y)), code.put(Operation::Div(y, w)));
    let one = code.put(Operation::Number(Rational::ONE));
    let sum = code.put(Operation::Add(u, w));
    let quotient = code.put(Operation::Div(sum, w));
    let value = code.put(Operation::Sub(quotient, one));
    assert_eq!(code.costs(&[first, second, value]), [5, 5]);
}

/// `x y z` is `(x y/k) (k z)`, but not for `k = 0`.
#[test]
fn no_constant_is_divided_by_that_was_not() {
    let mut code = Writer::new();
    let k = code.graph.symbol("k", Role::Constant);
    code.prepared = vec![k, code.graph.powi(k, -1)];
    let [x, y, z] = code.symbols();
    let (k, inverse) = (code.put(Operation::Prepared(0)), code.put(Operation::Prepared(1)));
    let (xk, xz) = (code.put(Operation::Mul(x, inverse)), code.put(Operation::Mul(x, z)));
    let (first, second) = (code.put(Operation::Mul(xk, y)), code.put(Operation::Mul(k, z)));
    let value = code.put(Operation::Mul(xz, y));
    assert_eq!(code.costs(&[first, second, value]), [5, 5]);
}

/// A maximum is one of its arguments at some points; a root of a square has either sign at some point.
#[test]
fn one_branch_is_not_taken_for_all() {
    for is_root in [false, true] {
        let mut code = Writer::new();
        let e = code.graph.bounded_symbol("p", Role::Coordinate, SignBound::Free);
        let p = code.graph.as_symbol(e).expect("it was just made");
        let [x, y] = code.symbols();
        let p = code.put(Operation::Symbol(p));
        let size = if is_root {
            let square = code.put(Operation::Mul(x, x));
            code.put(Operation::Call(Function::Root(2), square))
        } else {
            code.put(Operation::Apply(Multivariate::Maximum, vec![x, p].into()))
        };
        // (size + y) y - y y
        let sum = code.put(Operation::Add(size, y));
        let (first, second) = (code.put(Operation::Mul(sum, y)), code.put(Operation::Mul(y, y)));
        let value = code.put(Operation::Sub(first, second));
        let [before, after] = code.costs(&[value]);
        assert_eq!((before, after), if is_root { (6, 3) } else { (4, 4) });
    }
}

/// A constant of unknown sign may be negative: it is neither the root of its square nor its absolute value.
#[test]
fn constants_have_both_signs() {
    for is_root in [false, true] {
        let mut code = Writer::new();
        let graph = &mut code.graph;
        let (a, one) = (graph.symbol("a", Role::Constant), graph.one());
        let (k, twice, square) = (graph.add(a, one), graph.add(a, a), graph.powi(a, 2));
        // (a + 1)^2, multiplied out: nothing knows the root.
        let power = graph.sum([square, twice, one]);
        let size = if is_root { graph.sqrt(power) } else { graph.function(Function::Abs, k) };
        code.prepared = vec![k, size];
        let [x, y] = code.symbols();
        let (k, size) = (code.put(Operation::Prepared(0)), code.put(Operation::Prepared(1)));
        let kx = code.put(Operation::Mul(k, x));
        let first = code.put(Operation::Mul(size, y));
        let value = code.put(Operation::Mul(first, x));
        assert_eq!(code.costs(&[kx, value]), [3, 3]);
    }
}

/// Random sums and products, in which products are multiplied out again.
#[test]
fn random_code_stays_what_it_is() {
    let mut saved = 0;
    for seed in 0..1000 {
        let mut dice = Dice(seed);
        let mut code = Writer::new();
        let mut values = code.symbols::<4>().to_vec();
        for _ in 0..14 {
            let [a, b, c] = [0; 3].map(|_| values[dice.next(values.len())]);
            let next = match dice.next(7) {
                0 => code.put(Operation::Add(a, b)),
                1 => code.put(Operation::Sub(a, b)),
                2 => code.put(Operation::Mul(a, b)),
                3 => code.put(Operation::Div(a, b)),
                4 => code.put(Operation::Call(Function::Root(2), a)),
                5 => {
                    let (first, second) = (code.put(Operation::Mul(a, c)), code.put(Operation::Mul(b, c)));
                    code.put(Operation::Sub(first, second))
                }
                _ => {
                    let sum = code.put(Operation::Sub(a, b));
                    code.put(Operation::Mul(sum, c))
                }
            };
            values.push(next);
        }
        let outputs = values.split_off(values.len() - 5);
        let [before, after] = code.costs(&outputs);
        assert!(after <= before);
        saved += before - after;
    }
    assert!(saved > 1000, "{saved}");
}
