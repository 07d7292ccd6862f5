//! The zero test on manifolds: expressions that vanish where equations hold.

use super::*;

pub(super) fn quaternion(b: &mut Bench) -> ([ExprId; 4], ExprId) {
    let q = ["q0", "q1", "q2", "q3"].map(|name| b.q(name));
    let squares = q.map(|q| b.g.powi(q, 2));
    let norm = b.g.sum(squares);
    (q, norm)
}

#[test]
fn unit_quaternions() {
    let mut b = Bench::new();
    let (q, norm) = quaternion(&mut b);
    let one = b.g.one();
    let equation = b.g.sub(norm, one);
    b.test.set_manifold(&mut b.g, &[equation]);
    assert!(b.test.manifold_is_solved());
    let fourth = b.g.powi(norm, 2);
    assert_eq!(b.differ(fourth, one), Nonzero);
    assert_eq!(b.on_manifold(fourth, one), Zero);
    // The first row of the rotation matrix is a unit vector.
    let (mut diagonal, mut terms) = (Vec::new(), Vec::new());
    for (i, sign) in [(0, 1), (1, 1), (2, -1), (3, -1)] {
        let square = b.g.powi(q[i], 2);
        diagonal.push((square, Rational::integer(sign)));
    }
    let r11 = b.g.linear(&diagonal);
    for (i, j, k, l, sign) in [(1, 2, 0, 3, -1), (1, 3, 0, 2, 1)] {
        let (a, c) = (b.g.mul(q[i], q[j]), b.g.mul(q[k], q[l]));
        let entry = b.g.linear(&[(a, Rational::integer(2)), (c, Rational::integer(2 * sign))]);
        terms.push(b.g.powi(entry, 2));
    }
    terms.push(b.g.powi(r11, 2));
    let length = b.g.sum(terms);
    assert_eq!(b.on_manifold(length, one), Zero);
    assert_eq!(b.on_manifold(r11, one), Nonzero);
    // Roots need the real points.
    let root = b.g.sqrt(norm);
    assert_eq!(b.on_manifold(root, one), Zero);
    let size = b.f(Function::Abs, q[0]);
    assert_eq!(b.on_manifold(size, q[0]), Nonzero);
    // The angle of a solved coordinate is related to nothing that residues see.
    let s = b.g.sin(q[0]);
    assert_eq!(b.on_manifold(s, q[1]), Nonzero);
}

#[test]
fn four_bar() {
    let mut b = Bench::new();
    let angles = ["a", "b", "c"].map(|name| b.q(name));
    let lengths = ["l1", "l2", "l3", "l4"].map(|name| b.positive(name));
    let (mut across, mut along) = (Vec::new(), Vec::new());
    for (i, sign) in [1, 1, -1].into_iter().enumerate() {
        let (s, c) = b.g.sin_cos(angles[i]);
        along.push((b.g.mul(lengths[i], c), Rational::integer(sign)));
        across.push((b.g.mul(lengths[i], s), Rational::integer(sign)));
    }
    along.push((lengths[3], Rational::MINUS_ONE));
    let (f, h) = (b.g.linear(&along), b.g.linear(&across));
    b.test.set_manifold(&mut b.g, &[f, h]);
    assert!(b.test.manifold_is_solved());
    let product = b.g.mul(f, angles[0]);
    let sum = b.g.add(product, h);
    assert_eq!(b.test.verdict_on_manifold(&mut b.g, sum), Zero);
    assert_eq!(b.test.verdict(&mut b.g, sum), Nonzero);
    assert_eq!(b.on_manifold(lengths[3], lengths[0]), Nonzero);
    // l2^2 from the other bars
    let (f2, h2) = (b.g.linear(&along[..1]), b.g.linear(&across[..1]));
    let (rest_f, rest_h) = (b.g.linear(&along[2..]), b.g.linear(&across[2..]));
    let (u, v) = (b.g.add(f2, rest_f), b.g.add(h2, rest_h));
    let (u2, v2) = (b.g.powi(u, 2), b.g.powi(v, 2));
    let sum = b.g.add(u2, v2);
    let square = b.g.powi(lengths[1], 2);
    assert_eq!(b.on_manifold(sum, square), Zero);
    let root = b.g.sqrt(sum);
    assert_eq!(b.on_manifold(root, lengths[1]), Zero);
    assert_eq!(b.on_manifold(root, lengths[0]), Nonzero);
}

#[test]
fn frame_of_unit_vectors() {
    let mut b = Bench::new();
    let names = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];
    let e: Vec<ExprId> = names.iter().map(|name| b.q(name)).collect();
    let dot = |b: &mut Bench, i: usize, j: usize| {
        let products: Vec<_> = (0..3).map(|k| b.g.mul(e[3 * i + k], e[3 * j + k])).collect();
        b.g.sum(products)
    };
    let one = b.g.one();
    let mut equations = Vec::new();
    for i in 0..3 {
        for j in i..3 {
            let product = dot(&mut b, i, j);
            equations.push(if i == j { b.g.sub(product, one) } else { product });
        }
    }
    b.test.set_manifold(&mut b.g, &equations);
    assert!(b.test.manifold_is_solved());
    // Columns are unit vectors too.
    let squares: Vec<_> = (0..3).map(|i| b.g.powi(e[3 * i], 2)).collect();
    let column = b.g.sum(squares);
    assert_eq!(b.on_manifold(column, one), Zero);
    assert_eq!(b.on_manifold(e[0], e[4]), Nonzero);
}

#[test]
fn unsolvable_manifolds_stay_open() {
    let mut b = Bench::new();
    let (x, y) = (b.q("x"), b.q("y"));
    let (sx, sy) = (b.g.sin(x), b.g.sin(y));
    let equation = b.g.sub(sx, sy);
    b.test.set_manifold(&mut b.g, &[equation]);
    assert!(!b.test.manifold_is_solved());
    assert_eq!(b.test.verdict_on_manifold(&mut b.g, equation), Unknown);
    assert_eq!(b.test.verdict_on_manifold(&mut b.g, sx), Nonzero);
    assert_eq!(b.test.residues(&mut b.g, 0, &[sx], true), None);
}

/// A body whose axis is held by two products beside the length of its quaternion: three quadratic equations, of which not all are solved.
#[test]
fn equations_that_are_left_out_leave_questions_open() {
    let mut b = Bench::new();
    let ([w, x, y, z], norm) = quaternion(&mut b);
    let one = b.g.one();
    let unit = b.g.sub(norm, one);
    let mut product = |a: [ExprId; 4], sign: i64| {
        let (first, second) = (b.g.mul(a[0], a[1]), b.g.mul(a[2], a[3]));
        b.g.linear(&[(first, Rational::integer(2)), (second, Rational::integer(2 * sign))])
    };
    let (across, along) = (product([x, z, w, y], 1), product([y, z, w, x], -1));
    b.test.set_manifold(&mut b.g, &[across, along, unit]);
    assert!(!b.test.manifold_is_solved() && b.test.manifold_has_points());
    // The length is kept: what follows from it alone is seen.
    let square = b.g.powi(norm, 2);
    assert_eq!(b.on_manifold(square, one), Zero);
    for equation in [across, along, unit] {
        assert_ne!(b.test.verdict_on_manifold(&mut b.g, equation), Nonzero);
    }
    // The axis is upright, which follows from all three.
    let terms = [(w, 1), (x, -1), (y, -1), (z, 1)].map(|(q, sign)| (b.g.powi(q, 2), Rational::integer(sign)));
    let upright = b.g.linear(&terms);
    let upright = b.g.powi(upright, 2);
    assert_eq!(b.on_manifold(upright, one), Unknown);
    assert_eq!(b.on_manifold(w, x), Nonzero);
    assert_eq!(b.test.rank(&mut b.g, &[vec![across], vec![along]], true), None);
}

#[test]
fn what_vanishes_where_others_do() {
    let mut b = Bench::new();
    let (q, norm) = quaternion(&mut b);
    let one = b.g.one();
    let unit = b.g.sub(norm, one);
    let multiple = b.g.mul(unit, q[2]);
    let free = b.g.mul(q[0], q[1]);
    assert!(b.test.vanish_where(&mut b.g, &[unit], &[multiple, unit]));
    assert!(!b.test.vanish_where(&mut b.g, &[unit], &[multiple, free]));
    assert!(b.test.vanish_where(&mut b.g, &[unit, q[1]], &[multiple, free]));
    assert!(!b.test.vanish_where(&mut b.g, &[], &[multiple]));
}

/// A foot flat on the ground: heel and toe are at its height only where `sin(foot)` vanishes, which residues of angles do not, or where the
/// foot has no length, which no constant is made to have. The search for points modulo the prime ends at once.
#[test]
fn a_manifold_without_residues_is_not_solved() {
    let mut b = Bench::new();
    let (z, leg, foot) = (b.q("z"), b.q("leg"), b.q("foot"));
    let (c, s) = (b.g.cos(leg), b.g.sin(foot));
    let lengths =
        [[b.positive("l"), b.positive("f")], ["k", "h"].map(|name| b.g.symbol(name, Role::Constant))];
    for [l, f] in lengths {
        let (down, up) = (b.g.mul(l, c), b.g.mul(f, s));
        let ankle = b.g.sub(z, down);
        let toe = b.g.add(ankle, up);
        b.test.set_manifold(&mut b.g, &[ankle, toe]);
        assert!(!b.test.manifold_is_solved());
        for e in [s, f] {
            assert_ne!(b.test.verdict_on_manifold(&mut b.g, e), Zero);
        }
    }
}

/// The first symbols that occur linearly, `x` and `y`, are not determined by both equations; others are.
#[test]
fn symbols_are_those_that_the_equations_determine() {
    let mut b = Bench::new();
    let [x, y, z, angle] = ["x", "y", "z", "angle"].map(|name| b.q(name));
    let (sine, cosine) = b.g.sin_cos(angle);
    let sum = b.g.add(x, y);
    let rest = b.g.sub(sum, sine);
    let equations = [cosine, sine].map(|factor| {
        let product = b.g.mul(z, factor);
        b.g.add(rest, product)
    });
    b.test.set_manifold(&mut b.g, &equations);
    assert!(b.test.manifold_is_solved());
    assert_eq!(b.on_manifold(sum, sine), Zero);
    assert_eq!(b.test.verdict_on_manifold(&mut b.g, z), Zero);
    assert_eq!(b.test.verdict_on_manifold(&mut b.g, x), Nonzero);
}

/// The closing equations of Bricard's mechanism: six bars of these lengths, six hinges at right angles, the last bar in place.
fn bricard(b: &mut Bench, lengths: &[ExprId; 6]) -> (Vec<ExprId>, Vec<ExprId>) {
    let angles: Vec<ExprId> = (1..=5).map(|i| b.q(&format!("q{i}"))).collect();
    let (zero, one) = (b.g.zero(), b.g.one());
    let unit = |k: usize| -> [ExprId; 3] { core::array::from_fn(|i| if i == k { one } else { zero }) };
    // The axes of a bar: along it, across, and of its first hinge.
    let [mut x, mut y, mut z] = [0, 1, 2].map(unit);
    let mut end = [zero; 3];
    for (i, angle) in angles.iter().enumerate() {
        let (s, c) = b.g.sin_cos(*angle);
        let minus = b.g.neg(s);
        let turned = |b: &mut Bench, p: ExprId, q: ExprId| -> [ExprId; 3] {
            core::array::from_fn(|k| {
                let products = [b.g.mul(p, x[k]), b.g.mul(q, y[k])];
                b.g.sum(products.to_vec())
            })
        };
        let (along, across) = (turned(b, c, s), turned(b, minus, c));
        for k in 0..3 {
            let step = b.g.mul(lengths[i], along[k]);
            end[k] = b.g.add(end[k], step);
        }
        // The next hinge, a right angle about the bar; the last one ends the chain.
        let opposite = across.map(|e| b.g.neg(e));
        (x, y, z) = if i % 2 == 0 { (along, z, opposite) } else { (along, z.map(|e| b.g.neg(e)), across) };
    }
    let closing = b.g.add(end[0], lengths[5]);
    (vec![closing, end[1], end[2], z[0], z[2]], angles)
}

#[test]
fn bricards_mechanism_has_one_equation_too_many() {
    let mut b = Bench::new();
    let one = b.g.one();
    let length = b.positive("l");
    for lengths in [[one; 6], [length; 6]] {
        let (equations, angles) = bricard(&mut b, &lengths);
        let redundant = b.test.redundant(&mut b.g, &equations, &angles);
        assert_eq!(redundant, [Redundant { equation: 4, beside: vec![0, 1, 2, 3] }]);
        let gradients: Vec<Vec<ExprId>> = equations
            .iter()
            .map(|e| angles.iter().map(|x| Flow::partial(&b.g, *x).of(&mut b.g, *e)).collect())
            .collect();
        assert_eq!(b.test.rank(&mut b.g, &gradients, false), Some(5));
    }
    // With bars of different lengths it is a rigid frame.
    let lengths = ["l1", "l2", "l3", "l4", "l5", "l6"].map(|name| b.positive(name));
    let (equations, angles) = bricard(&mut b, &lengths);
    assert_eq!(b.test.redundant(&mut b.g, &equations, &angles), []);
}
