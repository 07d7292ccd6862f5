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
        ("Piecewise(x, u)", "write `select(c >= 0, a, b)`"),
        ("ite(x, u, 1)", "write `select(c >= 0, a, b)`"),
        ("smoothstep(0, 1, x)", "`s = clamp((x - a)/(b - a), 0, 1)`"),
        ("mod(x, 2)", "`x - b*floor(x/b)`"),
        ("saturate(x, 0, 1)", "`clamp(x, low, high)`"),
        ("interp1(x)", "`functions { curve(x); }`"),
        ("CubicSpline(x)", "a `guen::Table` or `guen::Grid`"),
        ("lambda(x)", "`fn name(x) = e;`"),
        ("ceil(x)", "`-floor(-x)`"),
        ("sec(x)", "write `1/cos(x)`"),
        ("csc(x)", "write `1/sin(x)`"),
        ("coth(x)", "write `1/tanh(x)`"),
        ("sech(x)", "write `1/cosh(x)`"),
        ("asinh(x)", "`ln(x + sqrt(x^2 + 1))`"),
        ("round(x)", "`floor(x + 1/2)`"),
        ("pow(x, 2)", "a power is written `x^2`"),
        ("norm2(x)", "`inner(v, v)`"),
        ("diff(x)", "`dot(x)` is the rate of `x`"),
        ("der(x)", "the rate of `x` is written `dot(x)`"),
        ("square(x)", "a square is written `x^2`"),
        ("heaviside(x)", "`select(x >= 0, 1, 0)`"),
    ] {
        let message = message(call);
        assert!(message.contains(help), "{call}: {message}");
        assert!(!message.contains("did you mean"), "{call}: {message}");
    }
}

#[test]
fn functions_under_other_names_are_told() {
    for (call, name) in [("fmin(x, u)", "min"), ("fmax(x, u)", "max"), ("Max(x, u)", "max")] {
        let message = message(call);
        assert!(message.contains(&format!("did you mean `{name}`?")), "{call}: {message}");
    }
}

#[test]
fn a_derivative_in_other_notations_is_one_mistake() {
    for call in ["d/dt(x)", "dx/dt", "xdot", "x_dot"] {
        let message = message(call);
        assert!(message.contains("the rate of `x` is written `dot(x)`"), "{call}: {message}");
        assert!(!message.contains("did you mean `x`"), "{call}: {message}");
    }
    assert_eq!(message("dx/dt").matches("compile_error").count(), 1);
}

#[test]
fn branches_are_not_taken_for_names() {
    for call in ["if x > 0 { 1 } else { 2 }", "match x {}", "x ? 1 : 2"] {
        let message = message(call);
        assert!(message.contains("an expression has no branches: write `select("), "{call}: {message}");
        assert!(!message.contains("r#"), "{call}: {message}");
    }
}

#[test]
fn a_missing_section_is_told_by_what_to_write() {
    for (section, help) in [
        ("params { a }", "physical constants stand in `constants`, quasi-velocities in `parameters`"),
        ("vars { q }", "did you mean `coordinates`?"),
        ("lagrangian = 1;", "`kinetic_energy = e;` and `potential_energy = e;`"),
        ("while true {}", "entries repeat as `for i in 0..n { .. }`"),
        ("fn f(x) { x }", "a function is one expression: write `fn name(x, y) = e;`"),
    ] {
        let text = format!("pub system S {{ coordinates {{ x }} {section} kinetic_energy = dot(x)^2/2; }}");
        let message = guen_language::expand(text.parse().unwrap()).to_string();
        assert!(message.contains(help), "{section}: {message}");
        assert!(!message.contains("the sections are"), "{section}: {message}");
    }
}
