use super::{Limits, normal_coefficients, normal_form};
use crate::{ExprId, Function, Graph, Node, Rational, Role, SignBound};

const CONSTANTS: &[&str] = &["a", "A", "C", "g", "m", "alpha", "beta", "gamma", "k"];
const COORDINATES: &[&str] = &["theta", "psi", "x", "y", "z"];
const VELOCITIES: &[&str] = &["eta1", "eta2", "eta3"];

fn world() -> Graph {
    let mut g = Graph::new();
    for name in CONSTANTS {
        g.bounded_symbol(name, Role::Constant, SignBound::Positive);
    }
    for name in COORDINATES {
        g.symbol(name, Role::Coordinate);
    }
    for name in VELOCITIES {
        g.symbol(name, Role::QuasiVelocity);
    }
    g
}

/// A reader of the language's expressions, just large enough for these tests.
struct Reader<'a> {
    g: &'a mut Graph,
    rest: &'a str,
}

impl Reader<'_> {
    fn eat(&mut self, token: char) -> bool {
        self.rest = self.rest.trim_start();
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn sum(&mut self) -> ExprId {
        let mut value = self.product();
        loop {
            if self.eat('+') {
                let next = self.product();
                value = self.g.add(value, next);
            } else if self.eat('-') {
                let next = self.product();
                value = self.g.sub(value, next);
            } else {
                return value;
            }
        }
    }

    fn product(&mut self) -> ExprId {
        let mut value = self.unary();
        loop {
            if self.eat('*') {
                let next = self.unary();
                value = self.g.mul(value, next);
            } else if self.eat('/') {
                let next = self.unary();
                value = self.g.div(value, next);
            } else {
                return value;
            }
        }
    }

    fn unary(&mut self) -> ExprId {
        if self.eat('-') {
            let value = self.unary();
            return self.g.neg(value);
        }
        let base = self.primary();
        if self.eat('^') {
            let exponent = self.unary();
            return self.g.power(base, exponent).expect("a legal power");
        }
        base
    }

    fn primary(&mut self) -> ExprId {
        if self.eat('(') {
            let value = self.sum();
            assert!(self.eat(')'), "a closing parenthesis before {}", self.rest);
            return value;
        }
        let end = self.rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        if let Ok(n) = word.parse::<i64>() {
            return self.g.number(n);
        }
        if self.eat('(') {
            let x = self.sum();
            assert!(self.eat(')'));
            return match word {
                "tan" => self.g.tan(x),
                "cot" => self.g.cot(x),
                "sqrt" => self.g.sqrt(x),
                "exp" => self.g.exp(x),
                "sin" => self.g.sin(x),
                "cos" => self.g.cos(x),
                "abs" => self.g.function(Function::Abs, x),
                "ln" => self.g.function(Function::Ln, x),
                _ => panic!("no function {word}"),
            };
        }
        if word == "pi" {
            return self.g.pi();
        }
        let symbol = self.g.symbols().find(|s| self.g.symbol_info(*s).name == word);
        self.g.symbol_expr(symbol.unwrap_or_else(|| panic!("no symbol `{word}`")))
    }
}

fn read(g: &mut Graph, text: &str) -> ExprId {
    let mut reader = Reader { g, rest: text };
    let value = reader.sum();
    assert!(reader.rest.trim().is_empty(), "left over: {}", reader.rest);
    value
}

fn value(g: &Graph, e: ExprId, point: &[f64]) -> f64 {
    let mut values = std::collections::BTreeMap::new();
    for id in g.reachable(&[e], |_| false) {
        let v = match g.node(id) {
            Node::Number(r) => r.to_f64(),
            Node::Pi => std::f64::consts::PI,
            Node::Kept(x) => values[x],
            Node::Symbol(s) => point[s.index()],
            Node::Sum { constant, terms } => {
                terms.iter().fold(constant.to_f64(), |sum, (t, c)| sum + c.to_f64() * values[t])
            }
            Node::Product(factors) => factors.iter().fold(1.0, |p, (b, e)| p * f64::powi(values[b], *e)),
            Node::Function(f, x) => {
                let x: f64 = values[x];
                match f {
                    Function::Sin => x.sin(),
                    Function::Cos => x.cos(),
                    Function::Exp => x.exp(),
                    Function::Ln => x.ln(),
                    Function::Abs => x.abs(),
                    Function::Root(2) => x.sqrt(),
                    Function::Root(3) => x.cbrt(),
                    _ => f64::NAN,
                }
            }
            Node::Multivariate(_, arguments) => f64::atan2(values[&arguments[0]], values[&arguments[1]]),
            Node::Undefined => f64::NAN,
        };
        values.insert(id, v);
    }
    values[&e]
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = splitmix(self.0);
        self.0
    }
    fn below(&mut self, n: u64) -> usize {
        ((self.next() >> 20) % n) as usize
    }
    fn point(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| 0.3 + (self.next() >> 11) as f64 / (1u64 << 53) as f64).collect()
    }
}

fn same(g: &Graph, a: ExprId, b: ExprId, random: &mut Random) {
    for _ in 0..3 {
        let point = random.point(g.symbols().count());
        let (u, v) = (value(g, a, &point), value(g, b, &point));
        // A point outside the domain, or near a pole, says nothing.
        if u.is_finite() && u.abs() < 1e4 {
            assert!((u - v).abs() <= 1e-7 * (1.0 + u.abs()), "{} = {u}\n{} = {v}", g.text(a), g.text(b));
        }
    }
}

fn check(text: &str, expected: &str) {
    let mut g = world();
    let e = read(&mut g, text);
    let n = normal_form(&mut g, e, &Limits::default()).unwrap_or_else(|| panic!("no normal form of {text}"));
    same(&g, e, n, &mut Random(7));
    assert_eq!(g.text(n), expected, "from {text}");
    let again = normal_form(&mut g, n, &Limits::default());
    assert_eq!(again, Some(n), "not idempotent: {text}");
    let printed = g.text(n);
    let back = read(&mut g, &printed);
    same(&g, e, back, &mut Random(8));
}

#[test]
fn trigonometric_identities() {
    check("1/sin(x)^2 - cot(x)^2", "1");
    check("(1 - cos(x)^2)/sin(x)", "sin(x)");
    check("sin(2*x)/(2*cos(x))", "sin(x)");
    check("cos(x)*cos(x + y) + sin(x)*sin(x + y)", "cos(y)");
    check("2*sin(x/2)*cos(x/2)", "sin(x)");
    check("cos(x/2)^2 - sin(x/2)^2", "cos(x)");
    check("1/(1 - sin(x)^2)", "1/cos(x)^2");
    check("sin(x)/(1 + cos(x)) - (1 - cos(x))/sin(x)", "0");
    check("cos(x)/(1 + sin(x)) + tan(x)", "1/cos(x)");
    check(
        "cos(theta)*A*eta2^2/sin(theta)*sin(theta)^2 + A*sin(theta)*cos(theta)*eta1^2",
        "A*sin(theta)*cos(theta)*eta1^2 + A*sin(theta)*cos(theta)*eta2^2",
    );
    check("(A*cos(theta)*eta2^2 - C*sin(theta)*eta2*eta3)/sin(theta)", "A*cot(theta)*eta2^2 - C*eta2*eta3");
    check("A*sin(x)^2 + C*cos(x)^2 + k*sin(x)^2 + k*cos(x)^2", "k + A*sin(x)^2 + C*cos(x)^2");
    check("cos(x)^4 - sin(x)^4", "1 - 2*sin(x)^2");
    check("tan(x)*cos(x) - sin(x)", "0");
}

#[test]
fn arguments_stay_where_their_normal_forms_are_dearer() {
    check("sin(sin(2*x))", "sin(sin(2*x))");
    check("A*cos(sin(2*x))^2*y", "A*cos(sin(2*x))^2*y");
    check("sin((x + y)^2 - x^2 - y^2 - x*y)", "sin(x*y)");
    // Equal arguments are one, whichever comes first.
    check("sin(sin(2*x)) - sin(2*sin(x)*cos(x))", "0");
    check("sin(2*sin(x)*cos(x)) - sin(sin(2*x))", "0");
    check("exp(cos(2*x)) - exp(1 - 2*sin(x)^2)", "0");
}

#[test]
fn squares_of_tangents_take_nothing_from_each_other() {
    // Not `A/cos^2 - (A - C) tan^2`: next to a right angle both have no digits of `A`.
    check("A/cos(x)^2 - (A - C)*sin(x)^2/cos(x)^2", "A + C*tan(x)^2");
    check("A + C/cos(x)^2", "A + C/cos(x)^2");
    check("A/cos(x)^4 - (A - C)*tan(x)^2/cos(x)^2", "A/cos(x)^2 + C*tan(x)^2/cos(x)^2");
    // By itself it stays.
    check("A/cos(x)^2", "A/cos(x)^2");
    check("A*eta1*eta2/cos(x)^2 + C*eta1^2", "C*eta1^2 + A*eta1*eta2/cos(x)^2");
    check("A*y*cos(x)^2 + C*y*sin(x)^2", "(A*cos(x)^2 + C*sin(x)^2)*y");
}

#[test]
fn constants_and_quotients() {
    check("m*(alpha^2 + beta^2 + k^2) - m*beta^2", "m*(alpha^2 + k^2)");
    check("A*x + a^2*x", "(A + a^2)*x");
    check("(x^2 - y^2)/(x - y)", "x + y");
    check("1/(x - y) + 1/(x + y) - 2*x/(x^2 - y^2)", "0");
    check("(x + y)^2 - x^2 - y^2", "2*x*y");
    check(
        "alpha*eta1*(beta*eta1 - eta2)/((alpha^2 + beta^2 + k^2) - beta^2)",
        "alpha*beta*eta1^2/(alpha^2 + k^2) - alpha*eta1*eta2/(alpha^2 + k^2)",
    );
    check("(A + a^2)*eta1^2 - (A + a^2)^2*eta2/(A + a^2)", "(A + a^2)*eta1^2 - (A + a^2)*eta2");
    check("m*alpha^2*eta1 + m*k^2*eta1 + C*eta1", "(C + m*(alpha^2 + k^2))*eta1");
}

#[test]
fn other_functions() {
    check("sqrt(x)^2 + sqrt(x + y)^4", "x + x^2 + 2*x*y + y^2");
    check("(x - y)/(sqrt(x) - sqrt(y))", "sqrt(x) + sqrt(y)");
    check("1/sqrt(x^2 + y^2)", "1/sqrt(x^2 + y^2)");
    check("x^2/sqrt(x^2 + y^2) + y^2/sqrt(x^2 + y^2)", "sqrt(x^2 + y^2)");
    check("abs(x)^2/x", "x");
    check("exp(2*x)*exp(-x) - exp(x)", "0");
    check("(exp(2*x) - 1)/(exp(x) - 1)", "exp(x) + 1");
    check("ln(x*y + y*x)/ln(2*x*y)", "1");
    check("sin(x*(y + z)) - sin(x*y + x*z)", "0");
}

#[test]
fn meets() {
    let mut g = world();
    for (a, b) in [
        ("(x + y)*(x - y)", "x^2 - y^2"),
        ("sin(x + y)", "sin(x)*cos(y) + cos(x)*sin(y)"),
        ("cos(2*x)", "1 - 2*sin(x)^2"),
        ("1/(A + C) + 1/(A - C)", "2*A/((A - C)*(A + C))"),
        ("cot(x) + tan(x)", "1/(sin(x)*cos(x))"),
    ] {
        let (e, f) = (read(&mut g, a), read(&mut g, b));
        let limits = Limits::default();
        let (e, f) = (normal_form(&mut g, e, &limits).unwrap(), normal_form(&mut g, f, &limits).unwrap());
        assert_eq!(e, f, "{a} and {b}: {} and {}", g.text(e), g.text(f));
    }
}

/// `(1 - cos x)/sin^2 x` for `1/(1 + cos x)` would divide zero by zero at `x = 0`.
#[test]
fn divisors_stay_those_that_were_written() {
    check("1/(1 + cos(x))", "1/(cos(x) + 1)");
    check("1/(1 - sin(x)) + 1/(1 + sin(x))", "-2/((sin(x) + 1)*(sin(x) - 1))");
    check("sin(x)^2/(1 - cos(x))", "cos(x) + 1");
    check("tan(x/4)", "tan(1/4*x)");
    check("1/cos(x/4)^2", "1/cos(1/4*x)^2");
    check("1/(sqrt(x) - 1)", "1/(sqrt(x) - 1)");
}

#[test]
fn coefficients_of_motion() {
    let mut g = world();
    let e = read(&mut g, "(A*eta1 + a^2*eta1)*eta1/2 + A*eta2^2*sin(theta)^2/sin(theta) + x");
    let variables: Vec<_> = ["eta1", "eta2"].map(|name| read(&mut g, name)).to_vec();
    let rows = normal_coefficients(&mut g, e, &variables, &Limits::default()).unwrap();
    let rows: Vec<_> = rows.into_iter().map(|(exponents, c)| (exponents, g.text(c))).collect();
    assert_eq!(
        rows,
        [
            (vec![2, 0], "1/2*A + 1/2*a^2".to_owned()),
            (vec![0, 2], "A*sin(theta)".to_owned()),
            (vec![0, 0], "x".to_owned())
        ]
    );
    for no in ["sin(eta1)", "1/eta1", "1/(eta1 + x)", "sqrt(eta1 + x)"] {
        let e = read(&mut g, no);
        assert_eq!(normal_coefficients(&mut g, e, &variables, &Limits::default()), None, "{no}");
    }
}

#[test]
fn limits_are_met_quickly() {
    let mut g = world();
    let mut e = read(&mut g, "a + A*sin(x) + C*cos(y) + g*x + m*y + k*z");
    for _ in 0..5 {
        let s = read(&mut g, "alpha + beta*sin(z) + gamma*cos(z) + x + y");
        let sum = g.add(e, s);
        e = g.mul(e, sum);
    }
    let start = std::time::Instant::now();
    assert_eq!(normal_form(&mut g, e, &Limits::default()), None);
    assert!(start.elapsed().as_millis() < 3000, "{:?}", start.elapsed());
}

/// A random expression in two angles, two constants and a velocity.
fn random_expression(g: &mut Graph, random: &mut Random, size: u32) -> ExprId {
    const LEAVES: &[&str] = &[
        "x",
        "y",
        "A",
        "a",
        "eta1",
        "sin(x)",
        "cos(x)",
        "sin(y)",
        "cos(y)",
        "sin(x + y)",
        "cos(2*x)",
        "2",
        "sin(x/2)",
        "sqrt(A + x)",
        "exp(x)",
        "abs(x - y)",
        "cos(x - y)",
    ];
    if size == 0 {
        let leaf = LEAVES[random.below(LEAVES.len() as u64)];
        return read(g, leaf);
    }
    let left = random.below(u64::from(size)) as u32;
    let u = random_expression(g, random, left);
    match random.below(12) {
        0 => return g.powi(u, 2),
        1 => return g.scale(u, &Rational::new(-3, 2)),
        2 => return g.sin(u),
        _ => {}
    }
    let v = random_expression(g, random, size - 1 - left);
    match random.below(5) {
        0 | 1 => g.add(u, v),
        2 => g.sub(u, v),
        3 => g.mul(u, v),
        _ if g.is_zero(v) => u,
        _ => g.div(u, v),
    }
}

/// `GUEN_ROUNDS` asks for more than a quick run.
fn rounds() -> u32 {
    std::env::var("GUEN_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(600)
}

#[test]
fn random_expressions_stay_equal() {
    let mut random = Random(20_260);
    let mut found = 0;
    for round in 0..rounds() {
        let mut g = world();
        let e = random_expression(&mut g, &mut random, 2 + round % 8);
        let limits = Limits { terms: 100, steps: 5_000, ..Limits::default() };
        let Some(n) = normal_form(&mut g, e, &limits) else { continue };
        found += 1;
        same(&g, e, n, &mut random);
        // What is printed is read again as the same expression.
        for printed in [e, n] {
            let text = g.text(printed);
            let back = read(&mut g, &text);
            assert!(text.len() > 60 || back == printed, "{text} became {}", g.text(back));
            same(&g, printed, back, &mut random);
        }
        if let Some(again) = normal_form(&mut g, n, &limits) {
            assert_eq!(again, n, "not idempotent:\n{}\n{}\n{}", g.text(e), g.text(n), g.text(again));
        }
    }
    assert!(found > rounds() * 2 / 3, "only {found} normal forms");
}

/// Normal forms are regular where the expression is, also where variables are zero or one; random points are never there.
#[test]
fn regular_points_stay_regular() {
    let mut random = Random(20_261);
    let (mut found, mut left_out) = (0, 0);
    for round in 0..rounds() {
        let mut g = world();
        let e = random_expression(&mut g, &mut random, 2 + round % 8);
        let limits = Limits { terms: 100, steps: 5_000, ..Limits::default() };
        let Some(n) = normal_form(&mut g, e, &limits) else { continue };
        for _ in 0..8 {
            let point: Vec<f64> = g.symbols().map(|_| [0.0, 0.0, 1.0, -1.0, 0.5][random.below(5)]).collect();
            let beside = random.point(point.len());
            let beside: Vec<f64> = point.iter().zip(&beside).map(|(x, y)| x + 1e-7 * y).collect();
            let (u, near) = (value(&g, e, &point), value(&g, e, &beside));
            // Points at which the expression or a part of it is singular say nothing.
            let is_regular =
                g.reachable(&[e], |_| false).into_iter().all(|part| value(&g, part, &point).is_finite());
            if !(is_regular && u.abs() < 1e3 && (u - near).abs() < 1e-4) {
                left_out += 1;
                continue;
            }
            let v = value(&g, n, &point);
            assert!((u - v).abs() <= 1e-7 * (1.0 + u.abs()), "{} = {u}\n{} = {v}", g.text(e), g.text(n));
            found += 1;
        }
    }
    assert!(found > left_out, "only {found} of {} points", found + left_out);
}

fn splitmix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
