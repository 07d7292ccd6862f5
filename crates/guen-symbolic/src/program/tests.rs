//! Programs equal their expressions; operation counts are golden.

use super::{Formulation, ProgramBuilder, Programs, evaluate_function, evaluate_prepare};
use crate::algebra::{ExprId, Function, Graph, Node, Role};

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
            Node::Atan2(y, x) => values[y.index()].atan2(values[x.index()]),
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

#[test]
fn random_programs_equal_their_expressions() {
    for seed in 0..300 {
        let mut dice = Dice(seed);
        let mut g = Graph::new();
        let mut pool = Vec::new();
        for name in ["x", "y", "z"] {
            pool.push(g.symbol(name, Role::Coordinate));
        }
        for name in ["a", "b"] {
            pool.push(g.symbol(name, Role::Constant));
        }
        for _ in 0..30 {
            random_expression(&mut g, &mut pool, &mut dice);
        }
        let outputs: Vec<_> =
            (0..4).map(|_| pool[dice.next(pool.len())]).chain(pool.last().copied()).collect();
        check(&mut g, &outputs, &mut dice);
    }
}

fn report(name: &str, programs: &Programs) {
    let cost = programs.functions[0].cost;
    println!(
        "{name}: {} operations (+{} *{} /{} -{} r{}), {} sines, {} calls; prepare {}",
        cost.operations(),
        cost.additions,
        cost.multiplications,
        cost.divisions,
        cost.negations,
        cost.roots,
        cost.sines,
        cost.calls,
        programs.prepare_cost.operations()
    );
}

/// Text of expressions such as `A*eta2^2*cos/(sin*(A+a^2))`, as much of it as these tests need.
struct Names<'a> {
    graph: &'a mut Graph,
    known: Vec<(&'static str, ExprId)>,
}

impl Names<'_> {
    fn parse(&mut self, text: &str) -> ExprId {
        let tokens: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
        let mut at = 0;
        let e = self.sum(&tokens, &mut at);
        assert_eq!(at, tokens.len(), "{text}");
        e
    }
    fn sum(&mut self, t: &[char], at: &mut usize) -> ExprId {
        let mut total = self.graph.zero();
        let mut sign = 1;
        if t[*at] == '-' {
            sign = -1;
            *at += 1;
        }
        loop {
            let e = self.product(t, at);
            total = if sign > 0 { self.graph.add(total, e) } else { self.graph.sub(total, e) };
            match t.get(*at) {
                Some('+') => sign = 1,
                Some('-') => sign = -1,
                _ => return total,
            }
            *at += 1;
        }
    }
    fn product(&mut self, t: &[char], at: &mut usize) -> ExprId {
        let mut total = self.power(t, at);
        while let Some(c @ ('*' | '/')) = t.get(*at).copied() {
            *at += 1;
            let e = self.power(t, at);
            total = if c == '*' { self.graph.mul(total, e) } else { self.graph.div(total, e) };
        }
        total
    }
    fn power(&mut self, t: &[char], at: &mut usize) -> ExprId {
        let e = if t[*at] == '(' {
            *at += 1;
            let e = self.sum(t, at);
            *at += 1;
            e
        } else {
            let start = *at;
            while t.get(*at).is_some_and(|c| c.is_alphanumeric()) {
                *at += 1;
            }
            let word: String = t[start..*at].iter().collect();
            if let Ok(n) = word.parse::<i64>() {
                self.graph.number(n)
            } else if let Some(x) = word.strip_prefix("sin") {
                let x = self.named(x);
                self.graph.sin(x)
            } else if let Some(x) = word.strip_prefix("cos") {
                let x = self.named(x);
                self.graph.cos(x)
            } else {
                self.named(&word)
            }
        };
        if t.get(*at) == Some(&'^') {
            *at += 2;
            let n = t[*at - 1].to_digit(10).expect("an exponent") as i32;
            return self.graph.powi(e, n);
        }
        e
    }
    fn named(&self, name: &str) -> ExprId {
        self.known.iter().find(|(known, _)| *known == name).unwrap_or_else(|| panic!("{name}")).1
    }
}

fn system(
    constants: &[&'static str],
    coordinates: &[&'static str],
    etas: &[&'static str],
    rates: &[&str],
) -> Programs {
    let mut graph = Graph::new();
    let mut known = Vec::new();
    for (names, role) in
        [(constants, Role::Constant), (coordinates, Role::Coordinate), (etas, Role::QuasiVelocity)]
    {
        for name in names {
            known.push((*name, graph.symbol(name, role)));
        }
    }
    let mut names = Names { graph: &mut graph, known };
    let outputs: Vec<_> = rates.iter().map(|rate| names.parse(rate)).collect();
    let p = check(&mut graph, &outputs, &mut Dice(1));
    if std::env::var("DUMP").is_ok() {
        dump(&graph, &p);
    }
    p
}

fn hoop(dynamics: [&str; 3]) -> Programs {
    let kinematics = [
        "n1",
        "n2/sinq",
        "n3 - n2*cosq/sinq",
        "a*n1*sinq*sinp - a*n3*cosp",
        "-a*n1*sinq*cosp - a*n3*sinp",
        "a*n1*cosq",
    ];
    let rates: Vec<&str> = kinematics.into_iter().chain(dynamics).collect();
    system(&["a", "A", "C", "g"], &["q", "p", "f", "x", "y", "z"], &["n1", "n2", "n3"], &rates)
}

#[test]
fn hoop_counts() {
    let normal = hoop([
        "A*cosq*n2^2/sinq/(A+a^2) - (C+a^2)*n2*n3/(A+a^2) - a*g*cosq/(A+a^2)",
        "-cosq/sinq*n1*n2 + C*n1*n3/A",
        "a^2*n1*n2/(C+a^2)",
    ]);
    report("hoop, normal form", &normal);
    let solved = hoop([
        "(A*cosq*n2^2/sinq - (C+a^2)*n2*n3 - a*g*cosq)/(A+a^2)",
        "(C*n1*n3 - A*cosq/sinq*n1*n2)/A",
        "a^2*n1*n2/(C+a^2)",
    ]);
    report("hoop, solved", &solved);
    let factored = hoop([
        "(n2*(A*cosq*n2/sinq - C*n3 - a^2*n3) - a*g*cosq)/(A+a^2)",
        "n1*(C*n3 - A*cosq/sinq*n2)/A",
        "a^2*n1*n2/(C+a^2)",
    ]);
    report("hoop, factored", &factored);
    for programs in [normal, solved, factored] {
        let cost = programs.functions[0].cost;
        assert!(cost.operations() <= 25 && cost.sines == 2, "{cost:?}");
    }
}

#[test]
fn sled_counts() {
    let d = "(al^2+k^2)";
    let first = format!("al*n1*(be*n1-n2)/{d} - al*g*sini*sinp/{d}");
    let kinematics = ["n1", "n2*cosp", "n2*sinp"];
    let seconds = [
        format!("al*n1*((al^2+be^2+k^2)*n1-be*n2)/{d} + g*sini*({d}*cosp-al*be*sinp)/{d}"),
        format!("al*(al^2+be^2+k^2)*n1^2/{d} - al*be*n1*n2/{d} + g*sini*cosp-g*sini*al*be*sinp/{d}"),
    ];
    for second in seconds {
        let rates: Vec<&str> = kinematics.into_iter().chain([first.as_str(), second.as_str()]).collect();
        let programs = system(&["al", "be", "k", "g", "i"], &["p", "x", "y"], &["n1", "n2"], &rates);
        report("sled", &programs);
        let cost = programs.functions[0].cost;
        assert!(cost.operations() <= 14 && cost.sines == 1, "{cost:?}");
    }
}

/// A planar chain in absolute angles: `sum_j k_ij cos(q_i - q_j) w_j' = - sum_j k_ij sin(q_i - q_j) w_j^2 - h_i sin(q_i)`.
fn chain(graph: &mut Graph, n: usize) -> (Vec<ExprId>, Vec<Vec<ExprId>>, Vec<ExprId>) {
    let q: Vec<_> = (0..n).map(|i| graph.symbol(&format!("q{i}"), Role::Coordinate)).collect();
    let w: Vec<_> = (0..n).map(|i| graph.symbol(&format!("w{i}"), Role::QuasiVelocity)).collect();
    let mass: Vec<_> = (0..n).map(|i| graph.symbol(&format!("m{i}"), Role::Constant)).collect();
    let length: Vec<_> = (0..n).map(|i| graph.symbol(&format!("l{i}"), Role::Constant)).collect();
    let gravity = graph.symbol("g", Role::Constant);
    let mut m = vec![vec![graph.zero(); n]; n];
    let mut f = Vec::new();
    for i in 0..n {
        let outer = graph.sum(mass[i..].iter().copied());
        let s = graph.sin(q[i]);
        let weight = graph.product(&[(outer, 1), (gravity, 1), (length[i], 1), (s, 1)]);
        let mut terms = vec![graph.neg(weight)];
        for j in 0..n {
            let outer = graph.sum(mass[i.max(j)..].iter().copied());
            let k = graph.product(&[(outer, 1), (length[i], 1), (length[j], 1)]);
            let angle = graph.sub(q[i], q[j]);
            let (s, c) = graph.sin_cos(angle);
            m[i][j] = graph.mul(k, c);
            let product = graph.product(&[(k, 1), (s, 1), (w[j], 2)]);
            terms.push(graph.neg(product));
        }
        f.push(graph.sum(terms));
    }
    (w, m, f)
}

/// The accelerations as expressions, without names.
fn solved(graph: &mut Graph, mut m: Vec<Vec<ExprId>>, mut f: Vec<ExprId>) -> Vec<ExprId> {
    let n = f.len();
    let mut multipliers = vec![vec![graph.zero(); n]; n];
    for k in 0..n {
        for r in k + 1..n {
            multipliers[r][k] = graph.div(m[r][k], m[k][k]);
        }
        for r in k + 1..n {
            for c in k + 1..=r {
                let product = graph.mul(multipliers[r][k], m[c][k]);
                m[r][c] = graph.sub(m[r][c], product);
                m[c][r] = m[r][c];
            }
            let product = graph.mul(multipliers[r][k], f[k]);
            f[r] = graph.sub(f[r], product);
        }
    }
    let mut x = vec![graph.zero(); n];
    for k in (0..n).rev() {
        let mut terms = vec![graph.div(f[k], m[k][k])];
        for r in k + 1..n {
            let product = graph.mul(multipliers[r][k], x[r]);
            terms.push(graph.neg(product));
        }
        x[k] = graph.sum(terms);
    }
    x
}

/// The same with a name for every entry of `M` and `f`, and, if asked for, of the factors.
fn named(graph: &mut Graph, m: &[Vec<ExprId>], f: &[ExprId], factors: bool) -> Formulation {
    let n = f.len();
    let mut definitions = Vec::new();
    let mut name = |graph: &mut Graph, e: ExprId| {
        if graph.as_symbol(e).is_some() || graph.roles(e).is_constant() {
            return e;
        }
        let symbol = graph.symbol("let", Role::QuasiAcceleration);
        definitions.push((symbol, e));
        symbol
    };
    let mut entries = vec![vec![graph.zero(); n]; n];
    for r in 0..n {
        for c in 0..=r {
            let symbol = name(graph, m[r][c]);
            (entries[r][c], entries[c][r]) = (symbol, symbol);
        }
    }
    let mut right: Vec<ExprId> = f.iter().map(|e| name(graph, *e)).collect();
    if !factors {
        let outputs = solved(graph, entries, right);
        return Formulation { definitions, outputs };
    }
    let mut multipliers = vec![vec![graph.zero(); n]; n];
    for k in 0..n {
        for r in k + 1..n {
            let l = graph.div(entries[r][k], entries[k][k]);
            multipliers[r][k] = name(graph, l);
        }
        for r in k + 1..n {
            for c in k + 1..=r {
                let product = graph.mul(multipliers[r][k], entries[c][k]);
                let e = graph.sub(entries[r][c], product);
                let e = name(graph, e);
                (entries[r][c], entries[c][r]) = (e, e);
            }
            let product = graph.mul(multipliers[r][k], right[k]);
            let e = graph.sub(right[r], product);
            right[r] = name(graph, e);
        }
    }
    let mut x = vec![graph.zero(); n];
    for k in (0..n).rev() {
        let mut terms = vec![graph.div(right[k], entries[k][k])];
        for r in k + 1..n {
            let product = graph.mul(multipliers[r][k], x[r]);
            terms.push(graph.neg(product));
        }
        let e = graph.sum(terms);
        x[k] = name(graph, e);
    }
    Formulation { definitions, outputs: x }
}

#[test]
fn chain_counts() {
    for n in [2, 5, 10] {
        let mut graph = Graph::new();
        let (w, m, f) = chain(&mut graph, n);
        let outputs: Vec<ExprId> =
            w.iter().copied().chain(solved(&mut graph, m.clone(), f.clone())).collect();
        let plain = Formulation { definitions: Vec::new(), outputs: outputs.clone() };
        let mut formulations = vec![plain];
        for factors in [false, true] {
            let mut formulation = named(&mut graph, &m, &f, factors);
            formulation.outputs.splice(0..0, w.iter().copied());
            formulations.push(formulation);
        }
        for formulation in formulations {
            let start = std::time::Instant::now();
            let mut builder = ProgramBuilder::new(&mut graph);
            builder.add_cheapest("f", &[formulation]);
            let programs = builder.finish();
            println!("{:?}", start.elapsed());
            report(&format!("chain of {n}"), &programs);
            agree(&graph, &outputs, &programs, &mut Dice(7));
        }
    }
}
#[allow(dead_code)]
fn dump(graph: &Graph, programs: &Programs) {
    use super::Operation;
    for i in &programs.functions[0].instructions {
        let text = match &i.operation {
            Operation::Symbol(s) => graph.symbol_info(*s).name.clone(),
            other => format!("{other:?}").replace("Value", ""),
        };
        println!("  {} = {text}", i.result.0);
    }
    println!("  out {:?}", programs.functions[0].outputs);
}
