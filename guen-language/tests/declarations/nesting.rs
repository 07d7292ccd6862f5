//! Everything that may be nested, as deep as the limits allow, in half of the stack of a small compiler thread; and what is nested deeper
//! in an error. Unoptimised, where frames are largest; the compiler ends without a word where its stack does.

use std::thread::Builder;

use guen_language::limits::{
    MAX_BRANCHES, MAX_CALLED_DEPTH, MAX_CONDITION_OPERATIONS, MAX_DEPTH, MAX_INDEX_OPERATIONS,
};

/// Half of the stack of a thread of Rust that asks for none.
const STACK: usize = 1 << 20;

/// The first error of a declaration, or none; a stack that overflows ends the test.
fn first_error(text: String) -> Option<String> {
    first_error_within(STACK, text)
}

fn first_error_within(stack: usize, text: String) -> Option<String> {
    let expand = move || {
        let items = guen_language::expand(text.parse().unwrap()).to_string();
        let at = items.find("compile_error")?;
        Some(items[at..].chars().take(200).collect())
    };
    Builder::new().stack_size(stack).spawn(expand).unwrap().join().unwrap()
}

fn nested(times: usize, open: &str, middle: &str, close: &str) -> String {
    format!("{}{middle}{}", open.repeat(times), close.repeat(times))
}

/// A system with a force, and with entries before it.
fn system(entries: &str, force: &str) -> String {
    format!(
        "pub system S {{ constants {{ a[2] > 0 }} coordinates {{ x, y }} fn f(u) = u + 1; functions {{ p(u); }} {entries}
        kinetic_energy = dot(x)^2 + dot(y)^2; forces {{ {force} along dot(y); }} }}"
    )
}

#[test]
fn what_the_limits_allow_fits_into_half_of_a_small_stack() {
    let half = MAX_DEPTH / 2;
    for (times, open, middle, close) in [
        (MAX_DEPTH, "sin(", "x", ")"),
        (MAX_DEPTH, "f(", "x", ")"),
        (MAX_DEPTH, "p(", "x", ")"),
        (MAX_DEPTH, "select(x >= 0, x, ", "x", ")"),
        (MAX_DEPTH, "(", "x", ")"),
        (MAX_DEPTH, "(1 + 2*", "x", ")"),
        (MAX_DEPTH, "-", "x", ""),
        (MAX_DEPTH, "1^", "1", ""),
        (MAX_DEPTH - 1, "", "x", ".sin()"),
        // Two levels each.
        (half, "(1 + ", "x", ")^1"),
        (half, "norm(vec(x, 1, ", "x", "))"),
        (half, "inner(vec(x, 1, 0), vec(1, 1, ", "x", "))"),
        (MAX_DEPTH, "sum(i in 0..1: ", "x", ")"),
        (MAX_DEPTH - 1, "abs(", "a[0]", ")"),
    ] {
        assert_eq!(
            first_error(system("", &nested(times, open, middle, close))),
            None,
            "{open}{middle}{close}"
        );
    }
    for (open, close) in [("(", ")"), ("-", ""), ("", " + 0")] {
        let index = nested(MAX_INDEX_OPERATIONS, open, "0", close);
        let force = nested(MAX_DEPTH, "abs(", &format!("a[{index}]"), ")");
        assert_eq!(first_error(system("", &force)), None, "{open}0{close}");
    }
    for (open, close) in [("!", ""), ("(", ")"), ("", " && 1 < 2"), ("", " || 1 < 2")] {
        let condition = nested(MAX_CONDITION_OPERATIONS, open, "0 < 1", close);
        let force = format!("for i in 0..2 {{ if {condition} {{ x along dot(x); }} }} x");
        assert_eq!(first_error(system("", &force)), None, "{open}0 < 1{close}");
    }
    let branches = " else if i > 7 { x along dot(x); }".repeat(MAX_BRANCHES - 1);
    let force = format!("for i in 0..2 {{ if i > 5 {{ x along dot(y); }} {branches} }} x");
    assert_eq!(first_error(system("", &force)), None);
}

/// Functions that call each other, each in the middle of an expression of so many levels.
fn calling(functions: usize, levels: usize) -> String {
    let call = |k: usize| if k == 0 { "u".to_owned() } else { format!("f{}(u)", k - 1) };
    let one = |k: usize| format!("fn f{k}(u) = {};", nested(levels, "sin(", &call(k), ")"));
    (0..functions).map(one).collect()
}

#[test]
fn functions_that_call_each_other_are_bounded_together() {
    let error = |functions: usize, levels: usize| {
        let force = nested(MAX_DEPTH - 1, "sin(", &format!("f{}(x)", functions - 1), ")");
        // Half of what the compiler's thread has.
        first_error_within(4 * STACK, system(&calling(functions, levels), &force))
    };
    // A call and its argument are two expressions more.
    let within = MAX_CALLED_DEPTH / 16 - 2;
    assert_eq!(error(16, within), None);
    for (functions, levels) in [(16, within + 1), (16, MAX_DEPTH - 1), (4, MAX_DEPTH - 1)] {
        let error = error(functions, levels).expect("an error");
        assert!(error.contains("functions that call each other nest more than 512"), "{error}");
    }
}

#[test]
fn what_is_nested_deeper_is_an_error_however_deep() {
    const FAR: usize = 2_000;
    for (force, expected) in [
        (nested(MAX_DEPTH + 1, "sin(", "x", ")"), "nested more than"),
        (format!("a[{}]", nested(MAX_INDEX_OPERATIONS + 1, "", "0", " + 0")), "an index of more than"),
        (format!("a[{}]", nested(FAR, "", "0", " + 0")), "an index of more than"),
        (format!("a[{}]", nested(FAR, "-", "0", "")), "an index of more than"),
    ] {
        let error = first_error(system("", &force)).expect("an error");
        assert!(error.contains(expected), "{error}");
    }
    for (open, close) in [("!", ""), ("", " && 1 < 2"), ("", " || 1 < 2")] {
        let condition = nested(FAR, open, "0 < 1", close);
        let force = format!("for i in 0..2 {{ if {condition} {{ x along dot(x); }} }} x");
        let error = first_error(system("", &force)).expect("an error");
        assert!(error.contains("a condition of more than"), "{error}");
    }
    let branches = " else if i > 7 { x along dot(x); }".repeat(FAR);
    let force = format!("for i in 0..2 {{ if i > 5 {{ x along dot(y); }} {branches} }} x");
    let error = first_error(system("", &force)).expect("an error");
    assert!(error.contains("more than 64 branches"), "{error}");
}

/// Entries that read the one before them several times: each is looked at once, and not on every way down to it, of which there are 3^39.
#[test]
fn entries_that_stand_in_each_other_are_looked_at_once() {
    let declaration = |rest: &str| {
        format!(
            "pub system S {{
                count n = 40;
                constants {{ c[n] }}
                coordinates {{ x, y, z }}
                let u[0] = x;
                for i in 1..n {{ let u[i] = u[i-1]*sin(y + c[i]) + u[i-1]*cos(z*c[i]) + u[i-1]; }}
                let v[0] = dot(x);
                for i in 1..n {{ let v[i] = v[i-1]*sin(y + c[i]) + v[i-1]*cos(z*c[i]) + v[i-1]; }}
                let T = (dot(x)^2 + dot(y)^2 + dot(z)^2)/2;
                {rest}
            }}"
        )
    };
    for rest in [
        "kinetic_energy = T + v[n-1]^2;",
        "kinetic_energy = T + z*v[n-1];",
        "kinetic_energy = T; potential_energy = u[n-1];",
        "kinetic_energy = T; forces { 3 along v[n-1]; }",
        "kinetic_energy = T; constraints { w: v[n-1] + dot(y) = 0; }",
        "kinetic_energy = T; parameters { w = v[n-1]; }",
        "kinetic_energy = T; states { dot(s) = u[n-1]; } outputs { o = v[n-1]; p = dot(v[n-1]); }",
    ] {
        let (sender, receiver) = std::sync::mpsc::channel();
        let text = declaration(rest);
        Builder::new().stack_size(8 * STACK).spawn(move || sender.send(first_error(text)).unwrap()).unwrap();
        let error = receiver.recv_timeout(std::time::Duration::from_secs(120)).expect(rest);
        assert!(error.is_none(), "{rest} {error:?}");
    }
}
