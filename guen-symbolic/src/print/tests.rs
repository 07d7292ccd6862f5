use crate::{ExprId, Function, Graph, Notation, Rational, Role};

fn text_sum(g: &Graph, terms: &[(ExprId, &str)]) -> String {
    Notation::text(g, 200).sum(terms).unwrap()
}

fn latex_sum(g: &Graph, terms: &[(ExprId, &str)]) -> String {
    Notation::latex(g, 200).sum(terms).unwrap()
}

struct World {
    g: Graph,
    symbols: Vec<(String, ExprId)>,
}

impl World {
    fn new() -> Self {
        let mut g = Graph::new();
        let mut symbols = Vec::new();
        let roles: [(&str, Role); 6] = [
            ("a A C g m k", Role::Constant),
            ("t", Role::Time),
            ("theta psi x y", Role::Coordinate),
            ("dot(theta) dot(x)", Role::Velocity),
            ("eta1 eta2 eta3", Role::QuasiVelocity),
            ("eta1' eta2'", Role::QuasiAcceleration),
        ];
        for (names, role) in roles {
            for name in names.split(' ') {
                symbols.push((name.to_owned(), g.symbol(name, role)));
            }
        }
        World { g, symbols }
    }

    fn s(&self, name: &str) -> ExprId {
        self.symbols.iter().find(|(n, _)| n == name).expect("a symbol of the test").1
    }
}

#[test]
fn hoop_equation() {
    let mut w = World::new();
    let (a, big_a, c, grav, theta) = (w.s("a"), w.s("A"), w.s("C"), w.s("g"), w.s("theta"));
    let (e2, e3, acc) = (w.s("eta2"), w.s("eta3"), w.s("eta1'"));
    let g = &mut w.g;
    let a2 = g.powi(a, 2);
    let (first, third) = (g.add(big_a, a2), g.add(c, a2));
    let (cot, cos) = (g.cot(theta), g.cos(theta));
    let t1 = g.mul(first, acc);
    let t2 = g.product(&[(big_a, 1), (cot, 1), (e2, 2)]);
    let t3 = g.product(&[(third, 1), (e2, 1), (e3, 1)]);
    let t4 = g.product(&[(a, 1), (grav, 1), (cos, 1)]);
    let e =
        g.linear(&[(t1, Rational::ONE), (t2, Rational::MINUS_ONE), (t3, Rational::ONE), (t4, Rational::ONE)]);
    assert_eq!(g.text(e), "(A + a^2)*eta1' - A*cot(theta)*eta2^2 + (C + a^2)*eta2*eta3 + a*g*cos(theta)");
    assert_eq!(
        g.latex(e),
        "\\left(A + a^{2}\\right)\\,\\dot{\\eta}_{1} - A\\,\\cot\\theta\\,\\eta_{2}^{2} + \
         \\left(C + a^{2}\\right)\\,\\eta_{2}\\,\\eta_{3} + a\\,g\\,\\cos\\theta"
    );
}

#[test]
fn operators_and_brackets() {
    let mut w = World::new();
    let (a, theta, psi) = (w.s("a"), w.s("theta"), w.s("psi"));
    let g = &mut w.g;
    let cot = g.cot(theta);
    let minus_cot = g.neg(cot);
    let one = g.one();
    assert_eq!(text_sum(g, &[(minus_cot, "X2"), (one, "X3")]), "-cot(theta) X2 + X3");
    let (sp, cp, st) = (g.sin(psi), g.cos(psi), g.sin(theta));
    let e4 = g.product(&[(a, 1), (sp, 1), (st, -1)]);
    let e5 = g.product(&[(a, 1), (cp, 1), (st, -1)]);
    let e5 = g.neg(e5);
    assert_eq!(
        text_sum(g, &[(g.zero(), "X1"), (e4, "X4"), (e5, "X5")]),
        "a*sin(psi)/sin(theta) X4 - a*cos(psi)/sin(theta) X5"
    );
    let csc = g.powi(st, -1);
    assert_eq!(
        text_sum(g, &[(csc, "d/dpsi"), (minus_cot, "d/dphi")]),
        "1/sin(theta) d/dpsi - cot(theta) d/dphi"
    );
    assert_eq!(
        latex_sum(g, &[(csc, "d/dpsi"), (one, "X2")]),
        "\\frac{1}{\\sin\\theta}\\,\\frac{\\partial}{\\partial \\psi} + X_{2}"
    );
    assert_eq!(text_sum(g, &[]), "0");
    let sum = g.sub(a, theta);
    assert_eq!(text_sum(g, &[(sum, "X1")]), "(a - theta) X1");
}

#[test]
fn precedence() {
    let mut w = World::new();
    let (a, x, y, k) = (w.s("a"), w.s("x"), w.s("y"), w.s("k"));
    let g = &mut w.g;
    let x2 = g.powi(x, 2);
    let e = g.neg(x2);
    assert_eq!(g.text(e), "-x^2");
    let e = g.product(&[(a, 1), (x, -1), (y, -1)]);
    assert_eq!(g.text(e), "a/(x*y)");
    let e = g.scale(x, &Rational::new(1, 2));
    assert_eq!(g.text(e), "1/2*x");
    let e = g.powi(x, -2);
    let e = g.scale(e, &Rational::new(-3, 2));
    assert_eq!(g.text(e), "-3/(2*x^2)");
    let one = g.one();
    let e = g.sub(one, x2);
    assert_eq!(g.text(e), "1 - x^2");
    let e = g.add(one, x2);
    assert_eq!(g.text(e), "x^2 + 1");
    let d = g.sub(x, y);
    let d = g.powi(d, -3);
    let e = g.mul(d, k);
    assert!(e != d && ["k/(x - y)^3", "-k/(y - x)^3"].contains(&&*g.text(e)), "{}", g.text(e));
    let r = g.root(x, 3);
    let e = g.powi(r, 2);
    assert_eq!(g.text(e), "x^(2/3)");
    assert_eq!(g.text(r), "x^(1/3)");
    let s = g.sqrt(x);
    let e = g.div(k, s);
    assert_eq!(g.text(e), "k/sqrt(x)");
    assert_eq!(g.latex(e), "\\frac{k}{\\sqrt{x}}");
    let (sx, cx) = g.sin_cos(x);
    let e = g.product(&[(cx, 1), (sx, -2)]);
    assert_eq!(g.text(e), "cot(x)/sin(x)");
    let e = g.product(&[(sx, 2), (cx, -2)]);
    assert_eq!(g.text(e), "tan(x)^2");
    assert_eq!(g.latex(e), "\\tan^{2} x");
    let e = g.powi(sx, -1);
    assert_eq!(g.text(e), "1/sin(x)");
    let m = g.number(-3);
    assert_eq!(g.text(m), "-3");
    let pair = g.add(x, y);
    let sum = g.add(pair, one);
    let e = g.scale(sum, &Rational::integer(2));
    assert_eq!(g.text(e), "2*x + 2*y + 2");
}

#[test]
fn limits_and_depth() {
    let mut w = World::new();
    let x = w.s("x");
    let g = &mut w.g;
    let mut e = x;
    for _ in 0..3000 {
        e = g.sin(e);
        e = g.add(e, x);
    }
    assert!(g.text_limited(e, 500).is_none());
    let mut e = x;
    for _ in 0..60 {
        let s = g.sin(e);
        let c = g.cos(e);
        e = g.mul(s, c);
    }
    assert!(g.text(e).contains("too long to show"));
}

#[test]
fn arguments_lead_with_a_plus() {
    let mut g = Graph::new();
    let [a, b, m] = ["a", "b", "m"].map(|name| g.symbol(name, Role::Coordinate));
    // One of the two is stored with its signs turned, whichever it is.
    for (from, to) in [(a, b), (b, a)] {
        let difference = g.sub(from, to);
        let (sin, cos) = g.sin_cos(difference);
        let tanh = g.function(Function::Tanh, difference);
        let sign = if from == a { "" } else { "-" };
        for (e, k, text, is_odd) in [
            (sin, 1, "sin(a - b)*m", true),
            (sin, 2, "sin(a - b)^2*m", false),
            (sin, 3, "sin(a - b)^3*m", true),
            (cos, 1, "cos(a - b)*m", false),
            (tanh, 1, "tanh(a - b)*m", true),
            (tanh, 2, "tanh(a - b)^2*m", false),
        ] {
            let product = g.product(&[(e, k), (m, 1)]);
            let sign = if is_odd { sign } else { "" };
            assert_eq!(g.text(product), format!("{sign}{text}"));
        }
        assert_eq!(g.text(sin), format!("{sign}sin(a - b)"));
        assert_eq!(g.text(cos), "cos(a - b)");
    }
}
