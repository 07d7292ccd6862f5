//! Functions of the declaration: calls are what they stand for, and faults are told where they are.

use guen_language::derive::{derive, function};
use guen_language::diagnostics::collect;
use guen_language::{model, parse};

use crate::common::{derived, evaluated};

fn rates(text: &str) -> Vec<u64> {
    derived(text, |derived| {
        let value = |symbol| {
            let name = &derived.model.bench.graph.symbol_info(symbol).name;
            name.bytes().fold(0.3, |value, byte| (value * 7.0 + f64::from(byte) / 50.0) % 1.7)
        };
        let rates = evaluated(&derived.system, function::RHS, value).expect("a right-hand side");
        rates.into_iter().map(f64::to_bits).collect()
    })
}

fn faults(text: &str) -> String {
    let (declaration, parsed) = parse::parse(text.parse().unwrap());
    if !parsed.is_empty() {
        return parsed.to_compile_errors().to_string();
    }
    let declaration = declaration.unwrap();
    let (derived, report) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
    assert!(derived.is_none(), "{text}");
    report.to_compile_errors().to_string()
}

fn pendulum(definitions: &str, position: &str, force: &str) -> String {
    format!(
        "pub system Pendulum {{
            constants {{ m > 0, l > 0, c >= 0, g = 9.81 }}
            inputs {{ u }}
            coordinates {{ q, x }}
            {definitions}
            particles {{ m at {position}; m at vec(x, 0); }}
            gravity = vec(0, -g);
            parameters {{ w = dot(q); v = dot(x); }}
            forces {{ {force}; u along v; }}
        }}"
    )
}

#[test]
fn a_call_is_what_it_stands_for() {
    let written = rates(&pendulum("", "vec(x, 0) + l*vec(sin(q), -cos(q))", "-c*w*abs(w) along w"));
    // Vectors, arguments that hide names of the system, functions in functions, velocities as arguments.
    let by_functions = pendulum(
        "fn way(x) = vec(sin(x), -cos(x));
         fn arm(start, q, x) = start + x*way(q);
         fn drag(w) = -c*w*abs(w);",
        "arm(vec(x, 0), q, l)",
        "drag(w) along w",
    );
    assert_eq!(rates(&by_functions), written);
    // A function of nothing, rotations and their axes.
    let by_rotations = pendulum(
        "fn turned(angle) = rot_z(angle);
         fn tip() = -l*turned(q).y;
         fn drag(w) = -c*w*abs(w);",
        "vec(x, 0) + tip()",
        "drag(dot(q)) along dot(q)",
    );
    let rotations_written = pendulum("", "vec(x, 0) - l*rot_z(q).y", "-c*dot(q)*abs(dot(q)) along dot(q)");
    assert_eq!(rates(&by_rotations), rates(&rotations_written));
}

#[test]
fn faults_are_told_where_they_are() {
    let cases = [
        ("fn f(a) = a*a;", "vec(f(q, x), 0)", "`f` takes 1 argument, and 2 were given"),
        ("fn f(a) = a*a;", "vec(f, 0)", "`f` is a function, and no value"),
        ("fn f(a) = f(a);", "vec(q, 0)", "`f` uses itself"),
        ("fn f(a) = a + b;", "vec(f(q), 0)", "unknown name `b` in `f`"),
        ("fn f(a) = h(a); fn h(a) = a;", "vec(f(q), 0)", "`h` is used before it is declared"),
        ("fn f(a, a) = a;", "vec(f(q, q), 0)", "`a` is an argument twice"),
        ("fn f(a, b) = a;", "vec(f(q, q), 0)", "`f` does not use its argument `b`"),
        ("fn f(t) = t;", "vec(f(q), 0)", "`t` is reserved and cannot name an argument"),
        ("fn sin(a) = a;", "vec(q, 0)", "`sin` is the name of a function and cannot name a function"),
        ("fn q(a) = a;", "vec(q, 0)", "`q` is declared twice"),
        ("fn f(a) = a + vec(1, 0);", "vec(0, 0) + f(q)", "in the call of `f`"),
        ("fn f(a) = a*dot(q);", "vec(f(x), 0)", "cannot depend on a velocity"),
        ("fn f(a) = a*u;", "vec(f(x), 0)", "`f` contains an input by its definition"),
        ("fn f(a: f64) = a;", "vec(f(q), 0)", "arguments and values of functions have no types"),
        ("fn f(a) -> f64 { a }", "vec(q, 0)", "have no types"),
        ("fn f(a) { a }", "vec(q, 0)", "a function is one expression"),
        ("fn f = 1;", "vec(q, 0)", "expected `(` after `f`"),
        ("fn f(1) = 1;", "vec(q, 0)", "the name of an argument"),
        ("fn bump(a) = a;", "vec(bumb(q), 0)", "did you mean `bump`?"),
    ];
    for (definitions, position, expected) in cases {
        let text = faults(&pendulum(definitions, position, "w along w"));
        assert!(text.contains(expected), "{definitions}: {text}");
    }
    // One fault in a function that is called twice is one error.
    let text = faults(&pendulum("fn f(a) = a + vec(1, 0);", "vec(0, 0) + f(q) + f(x)", "w along w"));
    assert_eq!(text.matches("compile_error").count(), 1, "{text}");
}

/// Functions that double their calls, and functions in functions, end in an error and not in a full stack or an hour of work.
#[test]
fn runaways_end_in_errors() {
    let chain = |body: &str, count: usize| -> String {
        let later =
            (1..count).map(|i| format!("fn f{i}(a) = {};", body.replace("PREV", &format!("f{}", i - 1))));
        "fn f0(a) = a;".to_owned() + &later.collect::<String>()
    };
    let position = |count: usize| format!("vec(f{}(q), 0)", count - 1);
    let doubled = |count| pendulum(&chain("PREV(a) + PREV(2*a)", count), &position(count), "w along w");
    assert!(faults(&doubled(15)).contains("more than 10000 calls of functions"));
    let nested = |count| pendulum(&chain("PREV(a + 1)", count), &position(count), "w along w");
    assert!(faults(&nested(17)).contains("more than 16 functions call each other"));
    // The deepest that is accepted fits the stack of a test's thread.
    let deep = format!("{}PREV(a){}", "(1 + a*sin(".repeat(40), "))".repeat(40));
    rates(&pendulum(&chain(&deep, 5), &position(5), "w along w"));
    assert_eq!(rates(&nested(16)).len(), 4);
}
