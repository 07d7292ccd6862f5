//! Functions that the language has not: the message says what to write instead, and does not guess another function.

/// The message for a force with a call of a function.
fn message(call: &str) -> String {
    let text = format!(
        "pub system S {{ coordinates {{ x }} parameters {{ u = dot(x); }} kinetic_energy = u^2/2; forces {{ {call} along u; }} }}"
    );
    guen_language::expand(text.parse().unwrap()).to_string()
}

#[test]
fn a_missing_function_is_told_by_what_to_write() {
    for (call, help) in [
        ("min(x, u)", "(a + b - abs(a - b))/2"),
        ("max(x, u)", "(a + b + abs(a - b))/2"),
        ("sec(x)", "write `1/cos(x)`"),
        ("csc(x)", "write `1/sin(x)`"),
        ("pow(x, 2)", "a power is written `x^2`"),
        ("norm2(x)", "`inner(v, v)`"),
        ("diff(x)", "`dot(x)` is the rate of `x`"),
    ] {
        let message = message(call);
        assert!(message.contains(help), "{call}: {message}");
        assert!(!message.contains("did you mean"), "{call}: {message}");
    }
}
