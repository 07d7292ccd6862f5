//! Operation counts of known systems: golden values.

use super::super::builder::Effort;
use super::super::{Formulation, ProgramBuilder, Programs};
use super::{Dice, agree, check};
use crate::algebra::{ExprId, Graph, Role};

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
    #[allow(clippy::needless_range_loop)]
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
    check(&mut graph, &outputs, &mut Dice(1))
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
// Matrices are clearest with indices.
#[allow(clippy::needless_range_loop)]
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

/// Returns the solution with a name for every entry of `M`, `f` and the factors.
#[allow(clippy::needless_range_loop)]
fn named(graph: &mut Graph, m: &[Vec<ExprId>], f: &[ExprId]) -> Formulation {
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
    // Operations without and with names for the entries, and prepared values; nothing may grow unnoticed.
    let golden = [(2, 29, 25), (5, 234, 209), (10, 991, 894)];
    for (n, whole, with_names) in golden {
        let mut graph = Graph::new();
        let (rates, mass, forces) = chain(&mut graph, n);
        let accelerations = solved(&mut graph, mass.clone(), forces.clone());
        let outputs: Vec<ExprId> = rates.iter().copied().chain(accelerations).collect();
        let plain = Formulation { definitions: Vec::new(), outputs: outputs.clone() };
        let mut entries = named(&mut graph, &mass, &forces);
        entries.outputs.splice(0..0, rates);
        for (formulation, expected) in [(plain, whole), (entries, with_names)] {
            let start = std::time::Instant::now();
            let mut builder = ProgramBuilder::new(&mut graph);
            builder.add("rates", &[formulation], Effort::Hot);
            let programs = builder.finish();
            report(&format!("chain of {n} in {:?}", start.elapsed()), &programs);
            agree(&graph, &outputs, &programs, &mut Dice(7));
            let cost = programs.functions[0].cost;
            assert!(cost.operations() <= expected && cost.sines == n as u32, "{cost:?}");
        }
    }
}

#[test]
fn the_cheapest_formulation_is_taken() {
    let mut graph = Graph::new();
    let (rates, mass, forces) = chain(&mut graph, 5);
    let plain = solved(&mut graph, mass.clone(), forces.clone());
    let plain = Formulation { definitions: Vec::new(), outputs: plain };
    let entries = named(&mut graph, &mass, &forces);
    let mut builder = ProgramBuilder::new(&mut graph);
    assert_eq!(builder.add("accelerations", &[plain, entries], Effort::Hot), 1);
    builder.add_function("rates", &rates);
    let programs = builder.finish();
    assert_eq!(programs.functions[0].outputs.len(), 5);
    assert_eq!(programs.functions[1].cost.operations(), 0);
}

#[test]
fn depths_share_what_they_have_in_common() {
    // x + 2 y is a part of the name's definition and three times in the output: neither depth alone has it twice.
    let mut graph = Graph::new();
    let [x, y, z] = ["x", "y", "z"].map(|name| graph.symbol(name, Role::Coordinate));
    let name = graph.symbol("", Role::QuasiAcceleration);
    let [two, three, six] = [2, 3, 6].map(|n| graph.number(n));
    let [double, triple, sixfold] = [(two, y), (three, x), (six, y)].map(|(n, e)| graph.mul(n, e));
    let definition = graph.sum([x, double, z]);
    let output = graph.sum([name, triple, sixfold]);
    let whole = graph.sum([definition, triple, sixfold]);
    let formulation = Formulation { definitions: vec![(name, definition)], outputs: vec![output, name] };
    let [brief, hot] = [Effort::Brief, Effort::Hot].map(|effort| {
        let mut builder = ProgramBuilder::new(&mut graph);
        builder.add("sums", std::slice::from_ref(&formulation), effort);
        let programs = builder.finish();
        agree(&graph, &[whole, definition], &programs, &mut Dice(7));
        programs.functions[0].cost.operations()
    });
    assert_eq!(hot, 5);
    assert!(brief > hot, "{brief}");
}
