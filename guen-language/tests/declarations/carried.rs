//! Carried forms of systems drawn at random, with every elementary function of the language: no call is left, the rates are
//! those of the system, and those of the functions are what central differences along the motion show.

use crate::common::{derived, evaluated, rounds};
use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_symbolic::{Role, SymbolId};

/// A fixed sequence of numbers that looks random (a linear congruential generator, upper bits).
struct Sequence(u64);

impl Sequence {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit
    }

    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

/// An expression that is finite and smooth wherever the variables are below one.
fn call(draw: &mut Sequence, depth: usize, variables: &[&str]) -> String {
    let inner = if depth > 0 && draw.below(2) == 0 {
        call(draw, depth - 1, variables)
    } else {
        let (a, b) = (draw.pick(variables), draw.pick(variables));
        draw.pick(&["A", "2*A", "A + B", "A - 2*B", "A*B", "a*A + t", "3*A/2 + b"])
            .replace('A', a)
            .replace('B', b)
    };
    draw.pick(&[
        "sin(U)",
        "cos(U)",
        "tan(U/8)",
        "sin(2*U)",
        "exp(U/4)",
        "ln(9 + U^2)",
        "sqrt(2 + U^2)",
        "atan(U)",
        "asin(sin(U)/2)",
        "acos(cos(U)/2)",
        "sinh(U/4)",
        "cosh(U/4)",
        "tanh(U)",
        "atan2(1 + U^2, 2 + U)",
        "(3 + U^2)^(1/3)",
        "(3 + U^2)^(-3/2)",
        "cot(2 + U/16)",
        "abs(3 + U^2)",
        "sin(U)^2*cos(U)",
    ])
    .replace('U', &format!("({inner})"))
}

fn declaration(draw: &mut Sequence) -> String {
    let place = |draw: &mut Sequence| call(draw, 1, &["x", "y", "z"]);
    let any = |draw: &mut Sequence| call(draw, 1, &["x", "y", "z", "u", "v"]);
    format!(
        "pub system Drawn {{
            constants {{ a, b, m > 0 }} coordinates {{ x, y, z }}
            parameters {{ u = dot(x)*(3 + sin(y)); v = dot(y); }}
            constraints {{ c: dot(z) = {}*dot(x) + sin(x - y)*dot(y); }}
            kinetic_energy = m*(dot(x)^2*(2 + cos(y)) + dot(y)^2 + dot(z)^2)/2;
            potential_energy = {} + {};
            forces {{ {} along u; {}*u along v; }}
            provide carried;
        }}",
        place(draw),
        place(draw),
        place(draw),
        any(draw),
        any(draw),
    )
}

/// The values of a function of a level; symbols without a value are refused.
fn values(
    derived: &DerivedSystem<'_>,
    level: &DerivedLevel,
    name: &str,
    known: &[(SymbolId, f64)],
) -> Vec<f64> {
    let at = |symbol: SymbolId| {
        let known = known.iter().find(|(other, _)| *other == symbol);
        known
            .unwrap_or_else(|| panic!("{} is not given", derived.model.bench.graph.symbol_info(symbol).name))
            .1
    };
    evaluated(level, name, at).expect("a program")
}

fn close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    for (k, (x, y)) in found.iter().zip(expected).enumerate() {
        assert!((x - y).abs() <= tolerance * size, "{what}: entry {k} is {x}, expected {y}");
    }
}

fn check(text: &str, derived: &DerivedSystem<'_>, draw: &mut Sequence) {
    let (system, carried) = (&derived.system, derived.system.carried.as_deref().unwrap());
    let graph = &derived.model.bench.graph;
    let rates = carried.program(function::RHS).unwrap();
    // `abs` stays, and is the only one that is drawn to.
    assert_eq!((rates.cost.sines, rates.cost.roots), (0, 0), "{text}");
    assert!(text.contains("abs") || rates.cost.calls == 0, "{text}");

    let mut unit = || 0.2 + 0.6 * draw.below(1 << 20) as f64 / f64::from(1 << 20);
    let constants: Vec<(SymbolId, f64)> = graph
        .symbols()
        .filter(|symbol| graph.symbol_info(*symbol).role == Role::Constant)
        .map(|symbol| (symbol, unit()))
        .collect();
    let time = graph.symbols().find(|symbol| graph.symbol_info(*symbol).role == Role::Time).unwrap();
    let variables: Vec<SymbolId> =
        (0..5).map(|p| graph.as_symbol(derived.model.variable(p)).unwrap()).collect();
    let functions: Vec<SymbolId> =
        carried.selection.carried.iter().map(|f| graph.as_symbol(f.symbol).unwrap()).collect();
    let (t, x): (f64, Vec<f64>) = (unit(), (0..5).map(|_| unit()).collect());
    let with = |t: f64, x: &[f64], w: &[f64]| -> Vec<(SymbolId, f64)> {
        let state = variables.iter().copied().zip(x.iter().copied());
        let own = functions.iter().copied().zip(w.iter().copied());
        constants.iter().copied().chain([(time, t)]).chain(state).chain(own).collect()
    };
    let carry = |t: f64, x: &[f64]| values(derived, carried, function::CARRY, &with(t, x, &[]));
    let w = carry(t, &x);
    let expected = values(derived, system, function::RHS, &with(t, &x, &[]));
    let found = values(derived, carried, function::RHS, &with(t, &x, &w));
    close(&found[..5], &expected, 1e-12, text);

    // Differences of order four along the motion: their error is 1e-11 and less.
    let h = 1e-3;
    let along = |k: f64| {
        let moved: Vec<f64> = x.iter().zip(&expected).map(|(x, rate)| x + k * h * rate).collect();
        carry(t + k * h, &moved)
    };
    let (ahead, behind, far, back) = (along(1.0), along(-1.0), along(2.0), along(-2.0));
    let slopes: Vec<f64> =
        (0..w.len()).map(|k| (8.0 * (ahead[k] - behind[k]) - (far[k] - back[k])) / (12.0 * h)).collect();
    close(&found[5..], &slopes, 1e-6, text);

    if carried.program(function::INVARIANTS).is_none() {
        return;
    }
    let invariants = |w: &[f64]| values(derived, carried, function::INVARIANTS, &with(t, &x, w));
    close(&invariants(&w), &vec![0.0; invariants(&w).len()], 1e-13, text);
    // A small fault is seen, and renormalizing leaves its square of it.
    let off: Vec<f64> = w.iter().map(|w| w * (1.0 + 1e-4)).collect();
    let again = values(derived, carried, function::RENORMALIZED, &with(t, &x, &off));
    for (before, after) in invariants(&off).iter().zip(invariants(&again)) {
        assert!(before.abs() > 1e-5 && after.abs() < 2e-3 * before.abs(), "{text}: {before} became {after}");
    }
}

#[test]
fn random_systems_move_as_they_did() {
    let mut draw = Sequence(7);
    for _ in 0..rounds(6) {
        let text = declaration(&mut draw);
        derived(&text, |derived| check(&text, derived, &mut draw));
    }
}
