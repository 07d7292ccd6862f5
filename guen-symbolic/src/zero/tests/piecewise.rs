//! Choices between branches, and functions that nobody knows.

use crate::algebra::{Flow, Function, Graph, Role};
use crate::zero::{Verdict, ZeroTest};

#[test]
fn branches_are_not_guessed() {
    let mut g = Graph::new();
    let zero = g.zero();
    let coordinates: Vec<_> = (0..16).map(|i| g.symbol(&format!("x{i}"), Role::Coordinate)).collect();
    // Nonzero in one of 2^16 combinations of signs: points that chose a side would miss it.
    let stops: Vec<_> = coordinates.iter().map(|x| (g.maximum(zero, *x), 1)).collect();
    let product = g.product(&stops);
    assert_ne!(ZeroTest::new().verdict(&mut g, product), Verdict::Zero);
    // A step and its square agree on both sides, and nothing in between shows that.
    let step = {
        let one = g.one();
        g.select(coordinates[0], one, zero)
    };
    let square = g.powi(step, 2);
    let difference = g.sub(step, square);
    assert_ne!(ZeroTest::new().verdict(&mut g, difference), Verdict::Nonzero);
}

#[test]
fn choices_keep_their_identities() {
    let mut g = Graph::new();
    let [x, y] = ["x", "y"].map(|name| g.symbol(name, Role::Coordinate));
    let (larger, smaller) = (g.maximum(x, y), g.minimum(x, y));
    let (sum, both) = (g.add(larger, smaller), g.add(x, y));
    let c = g.sub(x, y);
    let chosen = g.select(c, x, y);
    let turned = g.sub(y, x);
    let other = g.select(turned, y, x);
    let double = g.add(c, c);
    let scaled = g.select(double, x, y);
    assert_eq!(scaled, chosen);
    let mut zero = ZeroTest::new();
    for (a, b) in [(sum, both), (larger, chosen), (larger, other)] {
        let difference = g.sub(a, b);
        assert_eq!(zero.verdict(&mut g, difference), Verdict::Zero, "{}", g.text(difference));
    }
    for (a, b) in [(larger, smaller), (larger, x), (chosen, y)] {
        let difference = g.sub(a, b);
        assert_eq!(zero.verdict(&mut g, difference), Verdict::Nonzero, "{}", g.text(difference));
    }
}

#[test]
fn steps_are_not_constant() {
    let mut g = Graph::new();
    let x = g.symbol("x", Role::Coordinate);
    let (one, zero) = (g.one(), g.zero());
    let thousandth = g.ratio(1, 1000);
    let small = g.mul(thousandth, x);
    let size = g.function(Function::Abs, small);
    let steps = [g.function(Function::Sign, x), g.function(Function::Floor, size), g.select(x, one, zero)];
    for step in steps {
        assert_ne!(ZeroTest::new().is_constant(&mut g, step, &[x]), Verdict::Zero, "{}", g.text(step));
    }
    let floor = steps[1];
    assert_ne!(ZeroTest::new().verdict(&mut g, floor), Verdict::Zero);
}

#[test]
fn supplied_functions_are_free() {
    let mut g = Graph::new();
    let [x, y] = ["x", "y"].map(|name| g.symbol(name, Role::Coordinate));
    let f = g.declare_function("f", &["u", "v"]);
    // f(x^2 - y^2, y) and f((x - y)(x + y), y) are one value, and so are mixed derivatives.
    let (x2, y2) = (g.powi(x, 2), g.powi(y, 2));
    let first = g.sub(x2, y2);
    let (minus, plus) = (g.sub(x, y), g.add(x, y));
    let second = g.mul(minus, plus);
    let (a, b) = (g.multivariate(f, &[first, y]), g.multivariate(f, &[second, y]));
    let mut zero = ZeroTest::new();
    let difference = g.sub(a, b);
    assert_eq!(zero.verdict(&mut g, difference), Verdict::Zero);
    let by_x = Flow::partial(&g, x).of(&mut g, a);
    let by_x_y = Flow::partial(&g, y).of(&mut g, by_x);
    let by_y = Flow::partial(&g, y).of(&mut g, b);
    let by_y_x = Flow::partial(&g, x).of(&mut g, by_y);
    let difference = g.sub(by_x_y, by_y_x);
    assert_eq!(zero.verdict(&mut g, difference), Verdict::Zero);
    // Values, derivatives and other arguments are unrelated.
    let turned = g.multivariate(f, &[y, first]);
    for other in [turned, by_x, by_y] {
        let difference = g.sub(a, other);
        assert_eq!(zero.verdict(&mut g, difference), Verdict::Nonzero);
    }
}
