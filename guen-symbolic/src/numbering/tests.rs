//! Tests of finding by value, of export and of rates.

use super::{Num, Numbering, Rates};
use crate::algebra::{ExprId, Function, Graph, Rational, Role, SymbolId};
use crate::workbench::Workbench;
use crate::zero::evaluate_f64;

fn bench() -> Workbench {
    Workbench::new(Graph::new())
}

fn numbering(bench: &mut Workbench) -> Numbering {
    at_point(bench, 0)
}

fn at_point(bench: &mut Workbench, point: usize) -> Numbering {
    let generation = bench.zero.generation();
    Numbering::new(&mut bench.graph, (point, false), generation)
}

/// Expressions at the first point where their roots exist.
fn imported<const N: usize>(bench: &mut Workbench, es: [ExprId; N]) -> (Numbering, [Num; N]) {
    let sound = (0..16).find_map(|point| {
        let mut n = at_point(bench, point);
        let numbers = es.map(|e| n.import(bench, e));
        n.is_sound().then_some((n, numbers))
    });
    sound.expect("every other point has roots")
}

fn symbols<const N: usize>(bench: &mut Workbench, role: Role) -> [ExprId; N] {
    std::array::from_fn(|i| bench.graph.symbol(&format!("x{i}"), role))
}

/// A value for every symbol.
fn at(symbol: SymbolId) -> f64 {
    (1.3 * symbol.index() as f64 + 0.7).sin() + 1.4
}

#[test]
fn what_has_the_value_of_something_older_is_that_up_to_its_sign() {
    let mut bench = bench();
    let [x, y] = symbols(&mut bench, Role::Coordinate);
    let mut n = numbering(&mut bench);
    let (s, c) = bench.graph.sin_cos(x);
    let [s, c, y] = [s, c, y].map(|e| n.import(&mut bench, e));
    let (ss, cc) = (n.square(s), n.square(c));
    assert_eq!(n.add(ss, cc), Num::ONE);
    // y (s s + c c) term by term, and turned there and back.
    let (first, second) = (n.mul(y, ss), n.mul(y, cc));
    assert_eq!(n.add(first, second), y);
    let difference = n.sub(s, y);
    assert_eq!(n.sub(y, s), difference.neg());
    let product = n.mul(difference, y.neg());
    assert_eq!(n.div(product, y), difference.neg());
    assert_eq!(n.sub(s, s), Num::ZERO);
    assert!(n.is_sound());
}

#[test]
fn another_value_is_another_number() {
    let mut bench = bench();
    let [x, y] = symbols(&mut bench, Role::Coordinate);
    let mut n = numbering(&mut bench);
    let [x, y] = [x, y].map(|e| n.import(&mut bench, e));
    let (sum, product) = (n.add(x, y), n.mul(x, y));
    let (sum_of_squares, difference) = {
        let (xx, yy) = (n.square(x), n.square(y));
        (n.add(xx, yy), n.sub(xx, yy))
    };
    let all = [x, y, sum, product, sum_of_squares, difference, Num::ONE, Num::ZERO];
    for (i, a) in all.iter().enumerate() {
        assert!(all[..i].iter().all(|b| a.abs() != b.abs()));
    }
}

#[test]
fn constants_meet_and_are_prepared() {
    let mut bench = bench();
    let [a, b] = symbols(&mut bench, Role::Constant);
    let [x] = symbols(&mut bench, Role::Coordinate);
    let mut n = numbering(&mut bench);
    let (s, c) = bench.graph.sin_cos(x);
    let [a, b, s, c] = [a, b, s, c].map(|e| n.import(&mut bench, e));
    // b (a x) is (b a) x, and a x + b x is (a + b) x.
    let inner = n.mul(a, s);
    let product = n.mul(b, inner);
    let ba = n.mul(b, a);
    assert_eq!(n.mul(ba, s), product);
    let (first, second) = (n.mul(a, s), n.mul(b, s));
    let sum = n.add(a, b);
    assert_eq!(n.add(first, second), n.mul(sum, s));
    // What turns out to be constant is so, however it came about.
    let (mut parts, square) = (Vec::new(), n.square(a));
    for e in [s, c] {
        let scaled = n.mul(a, e);
        parts.push(n.square(scaled));
    }
    let whole = n.sum(parts);
    assert_eq!(whole, square);
    assert!(n.is_constant(whole));
}

#[test]
fn expressions_come_back_equal_with_what_is_shared_kept_whole() {
    let mut bench = bench();
    let [x, y, z] = symbols(&mut bench, Role::Coordinate);
    let graph = &mut bench.graph;
    let (s, c) = graph.sin_cos(x);
    let (sum, two) = (graph.add(s, y), graph.number(2));
    let root = {
        let square = graph.powi(z, 2);
        let inside = graph.add(square, two);
        graph.sqrt(inside)
    };
    let quotient = graph.product(&[(sum, 3), (c, 1), (root, -1)]);
    let difference = graph.sub(z, quotient);
    let (n, numbers) = imported(&mut bench, [quotient, difference]);
    let back = n.export(&mut bench.graph, &numbers);
    let before = evaluate_f64(&bench.graph, &[quotient, difference], &at);
    let after = evaluate_f64(&bench.graph, &back, &at);
    for (before, after) in before.iter().zip(&after) {
        assert!((before - after).abs() < 1e-14 * before.abs(), "{before} {after}");
    }
    let real = n.evaluate(&bench.graph, &numbers, &at);
    for (before, real) in before.iter().zip(&real) {
        assert!((before - real).abs() < 1e-14 * before.abs(), "{before} {real}");
    }
}

#[test]
fn rates_are_those_of_differences() {
    let mut bench = bench();
    let [x, y] = symbols(&mut bench, Role::Coordinate);
    let [a] = symbols(&mut bench, Role::Constant);
    let graph = &mut bench.graph;
    let angle = {
        let scaled = graph.mul(a, y);
        graph.add(x, scaled)
    };
    let (s, c) = graph.sin_cos(angle);
    let below = {
        let square = graph.powi(y, 2);
        let sum = graph.add(square, a);
        graph.sqrt(sum)
    };
    let e = {
        let product = graph.product(&[(s, 2), (x, 1), (below, -1)]);
        graph.add(product, c)
    };
    let [x_rate, y_rate] = symbols::<2>(&mut bench, Role::Input);
    let (mut n, [x_rate, y_rate, number]) = imported(&mut bench, [x_rate, y_rate, e]);
    let rates = Rates { symbols: vec![(x, x_rate), (y, y_rate)] };
    let rate = n.rate(&mut bench, &rates, number);
    let [rate, x_rate, y_rate] = [rate, x_rate, y_rate].map(|a| n.evaluate(&bench.graph, &[a], &at)[0]);
    let moved = |h: f64| {
        let value = |symbol: SymbolId| {
            let own = bench.graph.symbol_expr(symbol);
            at(symbol)
                + h * if own == x {
                    x_rate
                } else if own == y {
                    y_rate
                } else {
                    0.0
                }
        };
        evaluate_f64(&bench.graph, &[e], &value)[0]
    };
    let h = 1e-5;
    let difference = (moved(h) - moved(-h)) / (2.0 * h);
    assert!((rate - difference).abs() < 1e-8 * rate.abs(), "{rate} {difference}");
}

#[test]
fn a_root_or_a_quotient_without_a_value_is_reported() {
    let mut bench = bench();
    let [x] = symbols(&mut bench, Role::Coordinate);
    let mut n = numbering(&mut bench);
    let x = n.import(&mut bench, x);
    let square = n.square(x);
    // One of a number and its opposite is no square.
    let minus = square.neg();
    n.sqrt(square);
    assert!(n.is_sound());
    n.sqrt(minus);
    assert!(!n.is_sound());
    let mut other = numbering(&mut bench);
    other.div(Num::ONE, Num::ZERO);
    assert!(!other.is_sound());
}

#[test]
fn absolute_values_are_nothing_else() {
    let mut bench = bench();
    let [x] = symbols(&mut bench, Role::Coordinate);
    let [size, sign] = [Function::Abs, Function::Sign].map(|function| bench.graph.function(function, x));
    let mut n = numbering(&mut bench);
    let [x, size, sign] = [x, size, sign].map(|e| n.import(&mut bench, e));
    assert!(n.is_sound());
    assert!(x.abs() != size.abs());
    assert!(sign.abs() != Num::ONE && !n.is_constant(sign));
}

/// The place of an end stands in forces beside numbers, in functions, and twice as large.
#[test]
fn sums_are_found_within_others_in_functions_and_as_multiples() {
    let mut bench = bench();
    let [x, y, l] = symbols(&mut bench, Role::Coordinate);
    let target = bench.graph.symbol("target", Role::Input);
    let (s, c) = (bench.graph.sin(x), bench.graph.cos(y));
    let (first, second) = (bench.graph.mul(l, s), bench.graph.mul(l, c));
    let place = bench.graph.add(first, second);
    let half = bench.graph.scale(place, &Rational::new(1, 2));
    let [beside, twice] = [bench.graph.sub(place, target), bench.graph.scale(place, &Rational::integer(2))];
    let zero = bench.graph.zero();
    let above = bench.graph.maximum(place, zero);
    let [s, c, l, wanted] = [s, c, l, target];
    let mut n = numbering(&mut bench);
    let [s, c, l, wanted] = [s, c, l, wanted].map(|e| n.import(&mut bench, e));
    n.look_for_multiples(&mut bench, half);
    // l (s + c), and not l s + l c.
    let sum = n.add(s, c);
    let short = n.mul(l, sum);
    assert_eq!(n.import(&mut bench, twice), n.times(&mut bench, &Rational::integer(2), short));
    assert_eq!(n.import(&mut bench, beside), n.sub(short, wanted));
    let above = n.import(&mut bench, above);
    assert!(n.is_sound());
    let [short, exported] = n.export(&mut bench.graph, &[short, above]).try_into().unwrap();
    let expected = bench.graph.maximum(short, zero);
    assert_eq!(exported, expected);
    // Alone nothing is found: the function keeps what it was given.
    let mut alone = numbering(&mut bench);
    let plain = bench.graph.maximum(place, zero);
    let number = alone.import(&mut bench, plain);
    assert_eq!(alone.export(&mut bench.graph, &[number]), [plain]);
}

/// Of twenty radicands hardly a point has all roots. The square of each is the radicand, and `1/sqrt(x)` is `sqrt(x)/x`.
#[test]
fn roots_may_be_drawn() {
    let mut bench = bench();
    let [x] = symbols(&mut bench, Role::Coordinate);
    let square = bench.graph.powi(x, 2);
    let radicands: Vec<ExprId> = (1..=20)
        .map(|k| {
            let number = bench.graph.number(Rational::integer(k));
            bench.graph.add(square, number)
        })
        .collect();
    let generation = bench.zero.generation();
    let mut n = Numbering::new(&mut bench.graph, (0, false), generation).with_drawn_roots(&mut bench);
    let mut sum = Num::ZERO;
    for radicand in &radicands {
        let number = n.import(&mut bench, *radicand);
        let root = n.sqrt(number);
        assert_eq!(n.mul(root, root), number);
        assert_eq!(n.mul(root, root.neg()), number.neg());
        let written = bench.graph.sqrt(*radicand);
        assert_eq!(n.import(&mut bench, written), root);
        let inverse = n.div(Num::ONE, root);
        sum = n.add(sum, inverse);
    }
    assert!(n.is_sound());
    let [exported] = n.export(&mut bench.graph, &[sum]).try_into().unwrap();
    let inverses: Vec<ExprId> = radicands
        .iter()
        .map(|radicand| {
            let root = bench.graph.sqrt(*radicand);
            let root = bench.graph.keep(root);
            bench.graph.powi(root, -1)
        })
        .collect();
    let written = bench.graph.sum(inverses);
    let difference = bench.graph.sub(exported, written);
    assert!(bench.zero.is_zero(&mut bench.graph, difference));
}
