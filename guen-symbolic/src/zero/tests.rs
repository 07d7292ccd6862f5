//! Identities that must be found, and near misses that must not.

mod manifolds;
mod piecewise;

use manifolds::quaternion;

use super::Verdict::{Nonzero, Unknown, Zero};
use super::*;
use crate::algebra::{Function, Rational, Role, SignBound};

/// A graph with a test, and expressions written shortly.
struct Bench {
    g: Graph,
    test: ZeroTest,
}

impl Bench {
    fn new() -> Self {
        Bench { g: Graph::new(), test: ZeroTest::new() }
    }

    fn q(&mut self, name: &str) -> ExprId {
        self.g.symbol(name, Role::Coordinate)
    }

    fn positive(&mut self, name: &str) -> ExprId {
        self.g.bounded_symbol(name, Role::Constant, SignBound::Positive)
    }

    fn f(&mut self, function: Function, x: ExprId) -> ExprId {
        self.g.function(function, x)
    }

    fn n(&mut self, n: i64) -> ExprId {
        self.g.number(n)
    }

    fn times(&mut self, a: ExprId, n: i64, d: i64) -> ExprId {
        self.g.scale(a, &Rational::new(n, d))
    }

    /// The verdict about `a - b`.
    fn differ(&mut self, a: ExprId, b: ExprId) -> Verdict {
        let difference = self.g.sub(a, b);
        self.test.verdict(&mut self.g, difference)
    }

    fn on_manifold(&mut self, a: ExprId, b: ExprId) -> Verdict {
        let difference = self.g.sub(a, b);
        self.test.verdict_on_manifold(&mut self.g, difference)
    }
}

#[test]
fn products_of_roots() {
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let xy = b.g.mul(x, y);
    let (rx, ry, rxy) = (b.g.sqrt(x), b.g.sqrt(y), b.g.sqrt(xy));
    let product = b.g.mul(rx, ry);
    assert_eq!(b.differ(product, rxy), Zero);
    assert_eq!(b.differ(product, rx), Nonzero);
    // 1/sqrt(x^2 + y^2) as quotient of the root
    let (x2, y2) = (b.g.powi(x, 2), b.g.powi(y, 2));
    let h2 = b.g.add(x2, y2);
    let h = b.g.sqrt(h2);
    let (a, c) = (b.g.powi(h, -1), b.g.div(h, h2));
    assert_eq!(b.differ(a, c), Zero);
    // sqrt(x^4) = x^2, third roots
    let x4 = b.g.powi(x, 4);
    let r4 = b.g.sqrt(x4);
    assert_eq!(b.differ(r4, x2), Zero);
    let (cx, cy, cxy) = (b.g.root(x, 3), b.g.root(y, 3), b.g.root(xy, 3));
    let product = b.g.mul(cx, cy);
    assert_eq!(b.differ(product, cxy), Zero);
}

#[test]
fn root_of_a_square_is_not_its_base() {
    let mut b = Bench::new();
    let x = b.q("x");
    let x2 = b.g.powi(x, 2);
    let root = b.g.sqrt(x2);
    assert_eq!(b.differ(root, x), Nonzero);
    let minus = b.g.neg(x);
    assert_eq!(b.differ(root, minus), Nonzero);
    let size = b.f(Function::Abs, x);
    assert_eq!(b.differ(root, size), Zero);
    let (size2, sign) = (b.g.powi(size, 2), b.f(Function::Sign, x));
    assert_eq!(b.differ(size2, x2), Zero);
    let product = b.g.mul(sign, size);
    assert_eq!(b.differ(product, x), Zero);
    // Promised signs count: sqrt((a + b)^2) with a, b > 0 is left open at worst.
    let (a, c) = (b.positive("a"), b.positive("c"));
    let sum = b.g.add(a, c);
    let (a2, c2, ac) = (b.g.powi(a, 2), b.g.powi(c, 2), b.g.mul(a, c));
    let square = b.g.sum([a2, c2, ac, ac]);
    let root = b.g.sqrt(square);
    assert_ne!(b.differ(root, sum), Nonzero);
}

#[test]
fn numeric_roots() {
    let mut b = Bench::new();
    let (two, three, six, five) = (b.n(2), b.n(3), b.n(6), b.n(5));
    let (r2, r3, r6) = (b.g.sqrt(two), b.g.sqrt(three), b.g.sqrt(six));
    let product = b.g.mul(r2, r3);
    assert_eq!(b.differ(product, r6), Zero);
    // sqrt(2) + sqrt(3) = sqrt(5 + 2 sqrt(6))
    let sum = b.g.add(r2, r3);
    let twice = b.times(r6, 2, 1);
    let inner = b.g.add(five, twice);
    let nested = b.g.sqrt(inner);
    assert_ne!(b.differ(sum, nested), Nonzero);
    let near = b.g.ratio(17320508, 10000000);
    assert_eq!(b.differ(r3, near), Nonzero);
}

#[test]
fn multiple_and_half_angles() {
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let x2 = b.times(x, 2, 1);
    let (s, c) = b.g.sin_cos(x);
    let sc = b.g.mul(s, c);
    let twice = b.times(sc, 2, 1);
    let s2 = b.g.sin(x2);
    assert_eq!(b.differ(s2, twice), Zero);
    assert_eq!(b.differ(s2, s), Nonzero);
    let half = b.times(x, 1, 2);
    let (sh, ch) = b.g.sin_cos(half);
    let product = b.g.mul(sh, ch);
    let twice = b.times(product, 2, 1);
    assert_eq!(b.differ(twice, s), Zero);
    let sum = b.g.add(x, y);
    let whole = b.g.sin(sum);
    let other = b.g.sin_cos(y);
    let parts = b.g.rotate((s, c), other);
    assert_eq!(b.differ(whole, parts.0), Zero);
    // sin(x) and x have nothing to do with each other
    assert_eq!(b.differ(s, x), Nonzero);
}

#[test]
fn rational_parts_of_pi() {
    let mut b = Bench::new();
    let pi = b.g.pi();
    let fifth = b.times(pi, 1, 5);
    let (s, c) = b.g.sin_cos(fifth);
    let five = b.n(5);
    let r5 = b.g.sqrt(five);
    let one = b.g.one();
    let sum = b.g.add(one, r5);
    let quarter = b.times(sum, 1, 4);
    assert_eq!(b.differ(c, quarter), Zero);
    assert_eq!(b.differ(s, quarter), Nonzero);
    let eighth = b.times(pi, 1, 8);
    let c8 = b.g.cos(eighth);
    let two = b.n(2);
    let r2 = b.g.sqrt(two);
    let inner = b.g.add(two, r2);
    let nested = b.g.sqrt(inner);
    let half = b.times(nested, 1, 2);
    assert_eq!(b.differ(c8, half), Zero);
    let near = b.g.ratio(355, 113);
    assert_eq!(b.differ(pi, near), Nonzero);
    // sin(x + pi/3) expanded
    let x = b.q("x");
    let third = b.times(pi, 1, 3);
    let shifted = b.g.add(x, third);
    let whole = b.g.sin(shifted);
    let (at_x, at_third) = (b.g.sin_cos(x), b.g.sin_cos(third));
    let parts = b.g.rotate(at_x, at_third);
    assert_eq!(b.differ(whole, parts.0), Zero);
}

#[test]
fn arguments_with_constants() {
    let mut b = Bench::new();
    let (x, t) = (b.q("x"), b.g.symbol("t", Role::Time));
    let (k, len) = (b.positive("k"), b.positive("b"));
    let kb = b.g.mul(k, len);
    let sum = b.g.add(x, kb);
    let whole = b.g.cos(sum);
    let (at_x, at_kb) = (b.g.sin_cos(x), b.g.sin_cos(kb));
    let parts = b.g.rotate(at_x, at_kb);
    assert_eq!(b.differ(whole, parts.1), Zero);
    // (x + b) t multiplied out
    let sum = b.g.add(x, len);
    let product = b.g.mul(sum, t);
    let (xt, bt) = (b.g.mul(x, t), b.g.mul(len, t));
    let expanded = b.g.add(xt, bt);
    let (one, other) = (b.g.sin(product), b.g.sin(expanded));
    assert_eq!(b.differ(one, other), Zero);
    // sin(lam) is no function of lam that polynomials know
    let lam = b.g.symbol("lam", Role::Constant);
    let (s, c) = b.g.sin_cos(lam);
    let (s2, c2) = (b.g.powi(s, 2), b.g.powi(c, 2));
    let sum = b.g.add(s2, c2);
    assert_eq!(b.differ(sum, lam), Nonzero);
    let number = b.g.ratio(3, 10);
    let double = b.g.ratio(6, 10);
    let (s, c) = b.g.sin_cos(number);
    let s2 = b.g.sin(double);
    let sc = b.g.mul(s, c);
    let twice = b.times(sc, 2, 1);
    assert_eq!(b.differ(s2, twice), Zero);
    assert_eq!(b.differ(s2, s), Nonzero);
    // Arguments that are equal without looking equal are left open.
    let quotient = b.g.powi(x, 2);
    let k2 = b.g.powi(k, 2);
    let difference = b.g.sub(quotient, k2);
    let below = b.g.add(x, k);
    let quotient = b.g.div(difference, below);
    let simple = b.g.sub(x, k);
    let (one, other) = (b.g.sin(quotient), b.g.sin(simple));
    assert_eq!(b.differ(one, other), Unknown);
}

#[test]
fn exponentials() {
    let mut b = Bench::new();
    let x = b.q("x");
    let minus = b.g.neg(x);
    let (e, i) = (b.g.exp(x), b.g.exp(minus));
    let (s, c, t) = (b.f(Function::Sinh, x), b.f(Function::Cosh, x), b.f(Function::Tanh, x));
    let sum = b.g.add(s, c);
    assert_eq!(b.differ(sum, e), Zero);
    let difference = b.g.sub(c, s);
    assert_eq!(b.differ(difference, i), Zero);
    let quotient = b.g.div(s, c);
    assert_eq!(b.differ(quotient, t), Zero);
    let half = b.times(x, 1, 2);
    let (root, halved) = (b.g.sqrt(e), b.g.exp(half));
    assert_eq!(b.differ(root, halved), Zero);
    assert_eq!(b.differ(e, s), Nonzero);
}

#[test]
fn inverse_functions() {
    let mut b = Bench::new();
    let (x, y) = (b.positive("x"), b.positive("y"));
    let xy = b.g.mul(x, y);
    let (lx, ly, lxy) = (b.f(Function::Ln, x), b.f(Function::Ln, y), b.f(Function::Ln, xy));
    let sum = b.g.add(lx, ly);
    assert_eq!(b.differ(lxy, sum), Zero);
    let doubled = b.times(lx, 2, 1);
    assert_eq!(b.differ(lxy, doubled), Nonzero);
    let inverse = b.g.powi(x, -1);
    let (a, c) = (b.f(Function::Atan, x), b.f(Function::Atan, inverse));
    let sum = b.g.add(a, c);
    let pi = b.g.pi();
    let right = b.times(pi, 1, 2);
    assert_eq!(b.differ(sum, right), Zero);
    let near = b.g.ratio(11, 7);
    assert_eq!(b.differ(sum, near), Nonzero);
    // Without the promise the sum jumps at zero.
    let z = b.q("z");
    let inverse = b.g.powi(z, -1);
    let (a, c) = (b.f(Function::Atan, z), b.f(Function::Atan, inverse));
    let sum = b.g.add(a, c);
    assert_eq!(b.differ(sum, right), Nonzero);
    let one = b.g.one();
    let quarter = b.f(Function::Atan, one);
    let four = b.times(quarter, 4, 1);
    assert_eq!(b.differ(four, pi), Zero);
    let (two, three, six) = (b.n(2), b.n(3), b.n(6));
    let (l2, l3, l6) = (b.f(Function::Ln, two), b.f(Function::Ln, three), b.f(Function::Ln, six));
    let sum = b.g.add(l2, l3);
    assert_eq!(b.differ(sum, l6), Zero);
    let angle = b.g.atan2(x, y);
    let quotient = b.g.div(x, y);
    let plain = b.f(Function::Atan, quotient);
    assert_eq!(b.differ(angle, plain), Zero);
}

#[test]
fn near_misses() {
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let tiny = Rational::from_decimal("1", -30).unwrap();
    let small = b.g.scale(y, &tiny);
    let almost = b.g.add(x, small);
    assert_eq!(b.differ(almost, x), Nonzero);
    let size = b.f(Function::Abs, x);
    let off = b.g.add(size, small);
    assert_eq!(b.differ(off, size), Nonzero);
    let (s, c) = b.g.sin_cos(x);
    let (s2, c2) = (b.g.powi(s, 2), b.g.powi(c, 2));
    let most = b.g.scale(c2, &(&Rational::ONE + &tiny));
    let sum = b.g.add(s2, most);
    let one = b.g.one();
    assert_eq!(b.differ(sum, one), Nonzero);
    // Products of tiny constants keep their relative precision.
    let planck = Rational::from_decimal("662607015", -42).unwrap();
    let h = b.g.number(planck);
    let h4 = b.g.powi(h, 4);
    let scaled = b.g.mul(h4, size);
    assert_eq!(b.test.verdict(&mut b.g, scaled), Nonzero);
    // A multiple of the prime is no zero.
    let prime = b.g.number(Rational::integer(field::PRIME as i64));
    let multiple = b.g.mul(prime, x);
    assert_ne!(b.test.verdict(&mut b.g, multiple), Zero);
    // Neither is a division by what vanishes identically.
    let twice = b.times(x, 2, 1);
    let sc = b.g.mul(s, c);
    let doubled = b.times(sc, -2, 1);
    let s2x = b.g.sin(twice);
    let hidden = b.g.add(s2x, doubled);
    let pole = b.g.div(y, hidden);
    assert_eq!(b.test.verdict(&mut b.g, pole), Unknown);
}

#[test]
fn growing_denominators() {
    let mut b = Bench::new();
    let x = b.q("x");
    let s = b.g.sin(x);
    assert_eq!(b.test.verdict(&mut b.g, s), Nonzero);
    let before = b.test.table.generation;
    let seventh = b.times(x, 1, 35);
    let pair = b.g.sin_cos(seventh);
    let mut turned = pair;
    for _ in 1..35 {
        turned = b.g.rotate(turned, pair);
    }
    assert_eq!(b.differ(turned.0, s), Zero);
    assert!(b.test.table.generation > before);
    assert_eq!(b.differ(turned.1, s), Nonzero);
}

/// Half of all residues are what a positive number is.
#[test]
fn ranks_see_both_signs() {
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let below = |b: &mut Bench, x: ExprId| {
        let absolute = b.f(Function::Abs, x);
        b.g.sub(absolute, x)
    };
    let (of_x, of_y) = (below(&mut b, x), below(&mut b, y));
    let zero = b.g.zero();
    assert_eq!(b.test.rank(&mut b.g, &[vec![of_x]], true), Some(1));
    assert_eq!(b.test.rank(&mut b.g, &[vec![of_x, zero], vec![zero, of_y]], true), Some(2));
    // Each is zero for the other's sign.
    let minus = b.g.neg(x);
    let above = below(&mut b, minus);
    let product = b.g.mul(of_x, above);
    assert_eq!(b.test.rank(&mut b.g, &[vec![product]], true), Some(0));
    assert_eq!(b.test.rank(&mut b.g, &[vec![of_x, zero], vec![zero, above]], true), Some(1));
    // sqrt(1 - cos(x)^2) is the sine only where that is positive.
    let (s, c) = b.g.sin_cos(x);
    let one = b.g.one();
    let square = b.g.powi(c, 2);
    let rest = b.g.sub(one, square);
    let root = b.f(Function::Root(2), rest);
    let difference = b.g.sub(root, s);
    assert_eq!(b.test.rank(&mut b.g, &[vec![difference]], true), Some(1));
}

#[test]
fn constants_and_ranks() {
    let mut b = Bench::new();
    let (x, a) = (b.q("x"), b.positive("a"));
    let (s, c) = b.g.sin_cos(x);
    let (s2, c2) = (b.g.powi(s, 2), b.g.powi(c, 2));
    let two = b.times(x, 2, 1);
    let cos2 = b.g.cos(two);
    let sum = b.g.linear(&[(s2, Rational::integer(2)), (cos2, Rational::ONE), (a, Rational::ONE)]);
    assert_eq!(b.test.is_constant(&mut b.g, sum, &[x]), Zero);
    assert_eq!(b.test.is_constant(&mut b.g, c2, &[x]), Nonzero);
    let (as_, ac) = (b.g.mul(a, s), b.g.mul(a, c));
    let rows = vec![vec![s, c], vec![as_, ac]];
    assert_eq!(b.test.rank(&mut b.g, &rows, false), Some(1));
    let minus = b.g.neg(s);
    assert_eq!(b.test.rank(&mut b.g, &[vec![s, c], vec![c, minus]], false), Some(2));
    let values = b.test.residues(&mut b.g, 0, &[s, c], false).unwrap();
    let squares = values.iter().fold(0, |sum, v| field::add(sum, field::mul(*v, *v)));
    assert_eq!(squares, 1);
}

#[test]
fn same_questions_same_answers() {
    let run = || {
        let mut b = Bench::new();
        let (q, norm) = quaternion(&mut b);
        let one = b.g.one();
        let equation = b.g.sub(norm, one);
        b.test.set_manifold(&mut b.g, &[equation]);
        let s = b.g.sin(q[1]);
        let free = b.test.residues(&mut b.g, 1, &[s, q[0]], false);
        let bound = b.test.residues(&mut b.g, 1, &[s, q[0]], true);
        (free, bound)
    };
    assert_eq!(run(), run());
}

#[test]
fn evaluations_agree() {
    use super::real::Real;
    let mut b = Bench::new();
    let x = b.q("x");
    let third = b.times(x, 1, 3);
    let functions = [
        Function::Sin,
        Function::Cos,
        Function::Asin,
        Function::Acos,
        Function::Atan,
        Function::Exp,
        Function::Ln,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Abs,
        Function::Root(2),
        Function::Root(3),
        Function::Root(5),
        Function::Root(6),
    ];
    let es: Vec<_> = functions.iter().map(|function| b.f(*function, third)).collect();
    let half = f256::f256::rational(&Rational::new(1, 2));
    let plain = evaluate_f64(&b.g, &es, &|_| 0.5);
    let long = evaluate(&b.g, &es, &|_| half);
    for ((function, plain), long) in functions.iter().zip(plain).zip(long) {
        let difference = (long - f256::f256::from(plain)).of(Function::Abs);
        assert!(difference < f256::f256::from(1e-15), "{function:?}: {plain} {long}");
    }
}

/// Points show that two expressions differ, and nothing else: neither what is zero nor what stays open is shown to
/// differ.
#[test]
fn a_difference_is_shown_by_points_alone() {
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let (sine, cosine) = b.g.sin_cos(x);
    let (s2, c2) = (b.g.powi(sine, 2), b.g.powi(cosine, 2));
    let near = b.times(c2, 2, 1);
    let zero = b.g.sub(x, x);
    let angle = b.f(Function::Atan, y);
    let turned = b.g.sub(angle, x);
    for (e, shown) in [(zero, false), (s2, true), (near, true), (turned, true)] {
        assert_eq!(b.test.is_shown_nonzero(&mut b.g, e, false), shown);
    }
    // On a circle of radius one its equation vanishes, and is no difference; off it there is one.
    let (x2, y2, one) = (b.g.powi(x, 2), b.g.powi(y, 2), b.n(1));
    let square = b.g.add(x2, y2);
    let circle = b.g.sub(square, one);
    b.test.set_manifold(&mut b.g, &[circle]);
    assert!(!b.test.is_shown_nonzero(&mut b.g, circle, true));
    assert!(b.test.is_shown_nonzero(&mut b.g, circle, false));
    assert!(b.test.is_shown_nonzero(&mut b.g, x, true));
}

/// `asin(f) + acos(f)` is constant, which its derivatives prove: as long as they are no more work than anybody waits for.
#[test]
fn a_proof_by_derivatives_has_its_limit() {
    for (terms, expected) in [(30, Zero), (1500, Unknown)] {
        let mut b = Bench::new();
        // Each derivative goes through all waves inside.
        let mut wave = b.g.zero();
        for k in 0..terms {
            let x = b.q(&format!("x{k}"));
            let sum = b.g.add(x, wave);
            wave = b.g.sin(sum);
        }
        let half = b.times(wave, 1, 2);
        let (sine, cosine) = (b.f(Function::Asin, half), b.f(Function::Acos, half));
        let sum = b.g.add(sine, cosine);
        let pi = b.g.pi();
        let turn = b.times(pi, 1, 2);
        let before = b.g.work();
        assert_eq!(b.differ(sum, turn), expected);
        assert!(b.g.work() - before < 2 * DERIVATIVE_WORK, "{}", b.g.work() - before);
    }
}

/// `e + 1` with `e = exp(-u) - 1` cancels: the hyperbolic sine of large negative arguments lost twice their digits, and
/// `sinh(u) + sinh(-u)` in two spellings was shown to differ from zero.
#[test]
fn functions_keep_their_digits_at_either_sign() {
    use super::real::Real;
    use f256::f256;
    let least = f256::from(2).power(-225);
    for function in [
        Function::Sin,
        Function::Cos,
        Function::Atan,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Root(3),
    ] {
        let sign = if function.is_odd() { -f256::ONE } else { f256::ONE };
        for x in [1e-40, 1e-3, 0.7, 3.0, 28.0, 90.0, 700.0].map(f256::from) {
            let (plus, minus) = (x.of(function), (-x).of(function));
            let difference = (plus - sign * minus).of(Function::Abs);
            assert!(difference <= least * plus.of(Function::Abs), "{function:?}({x}): {plus} {minus}");
        }
    }
    // cosh^2 - sinh^2 = 1
    for x in [-28.0, -3.0, 3.0, 28.0].map(f256::from) {
        let (s, c) = (x.of(Function::Sinh), x.of(Function::Cosh));
        let one = (c - s) * (c + s);
        assert!((one - f256::ONE).of(Function::Abs) <= least * c * c, "{x}: {one}");
    }
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let (long, far) = (b.times(x, 1, 8), b.n(-28));
    let arguments =
        [b.g.sum([long, y, far]), b.g.linear(&[(x, Rational::new(-1, 8)), (y, Rational::MINUS_ONE)])];
    let other = b.g.sub(arguments[1], far);
    let kept = b.g.keep(other);
    let (one, two) = (b.f(Function::Sinh, arguments[0]), b.f(Function::Sinh, kept));
    let sum = b.g.add(one, two);
    assert_ne!(b.test.verdict(&mut b.g, sum), Nonzero);
}
