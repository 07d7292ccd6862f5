//! The parser against the language: what is right gives the expected tree, what is wrong the expected words at
//! the expected token, and damage of any kind no panic.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use super::{parse, parse_expression};
use crate::limits::MAX_DEPTH;

const HOOP: &str = r#"
/// A hoop of radius `a` that rolls without slipping on a horizontal plane.
pub system Hoop {
    constants   { a > 0, A > 0, C > 0, g = 9.81 }
    coordinates { theta, psi, phi, xi, eta, zeta }

    let rolling = dot(psi)*cos(theta) + dot(phi);

    parameters {
        eta1 = dot(theta);
        eta2 = dot(psi)*sin(theta);
        eta3 = rolling;
    }
    constraints {
        eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(psi)*dot(phi);
        eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) = 0;
        eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
    }
    kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)
                   + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
    force_function = -a*g*sin(theta);
}
"#;

const EVERYTHING: &str = r#"
crate = ::my::guen;
/// A cart.
#[doc = "Second line."]
pub(crate) system Cart {
    constants { /// Mass.
        m > 0, c >= 0, k != 0, g = 9.81, I > 0 = 2/5*m*k^2, free, }
    inputs { /// Torque.
        tau, F }
    coordinates { x, r#type, θ, η_1 }
    let p = vec(x, θ);
    let R = rot_z(θ);
    holonomic { on_ground: p.y - k = 0; loop_c: p = 0; }
    parameters { v = dot(x); w = dot(θ); }
    constraints { c: wheel.velocity_at(contact) = 0; }
    kinetic_energy = v^2/2 + 0*c;
    particles { m at p; 2*m at vec(x, 0, -1e-3); }
    bodies {
        wheel { mass: m, inertia: diag(I, I, 2*I), center: p, orientation: R, }
        rod { inertia: sym(1, 2, 3, 4, 5, 6), orientation: rot(vec(0, 0, 1), θ) },
        ball { mass: 1, center: vec(0, 0, 0) }
    }
    gravity = vec(0, -g);
    potential_energy = k*x.powi(2).sqrt();
    states { dot(i) = tau - i; dot(r#e: A*s) = -i/2; }
    forces { tau - c*dot(x) along dot(θ); F*R.x along dot(p); }
    resets { hop: p.y - k falls, x = x + 1, v = -v; r#in: x rises, w = 0; }
    outputs { height = p.y; }
    provide operators, reactions(c, on_ground);
    /// Small.
    scene Tilt { track θ, x; fix m = 1, g = -9.81; fix v; provide energy, reactions(c); }
    scene Empty {}
}
"#;

fn tokens(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|error| panic!("{error} in {text}"))
}

fn tree(text: &str) -> String {
    let (expression, report) = parse_expression(tokens(text));
    assert!(report.is_empty(), "{text}: {report}");
    expression.unwrap().to_string()
}

/// Every fault as `beginning of what is underlined | text`.
fn faults_of(report: &crate::diagnostics::FaultReport) -> Vec<String> {
    report
        .faults()
        .iter()
        .map(|fault| {
            let source = fault.span().source_text().unwrap_or_default();
            let first: String = source.chars().take(12).collect();
            format!("{first} | {}", fault.to_string().replace('\n', " | "))
        })
        .collect()
}

fn expression_faults(text: &str) -> Vec<String> {
    let (expression, report) = parse_expression(tokens(text));
    assert_eq!(expression.is_none(), !report.is_empty(), "{text}");
    faults_of(&report)
}

/// Faults of a system with these sections, which may leave out what every system needs.
fn section_faults(sections: &str) -> Vec<String> {
    let mut text = format!("system S {{ {sections}\n");
    if !sections.contains("coordinates") {
        text.push_str("coordinates { x } ");
    }
    if !["kinetic_energy", "bodies", "particles"].iter().any(|word| sections.contains(word)) {
        text.push_str("kinetic_energy = dot(x)^2; ");
    }
    text.push('}');
    let (declaration, report) = parse(tokens(&text));
    assert!(declaration.is_some(), "{text}");
    faults_of(&report)
}

#[track_caller]
fn assert_faults(found: &[String], expected: &[&str]) {
    let fits = found.len() == expected.len()
        && found.iter().zip(expected).all(|(fault, expected)| {
            let (token, words) = expected.split_once(" | ").unwrap();
            fault
                .split_once(" | ")
                .is_some_and(|(at, text)| at == token && words.split(" | ").all(|words| text.contains(words)))
        });
    assert!(fits, "found\n    {}\nexpected\n    {}", found.join("\n    "), expected.join("\n    "));
}

#[test]
fn precedence_and_association() {
    for (text, expected) in [
        ("-x^2", "(-(x^2))"),
        ("2^-1", "(2^(-1))"),
        ("a*R*v", "((a*R)*v)"),
        ("a-b-c", "((a - b) - c)"),
        ("a/b/c", "((a/b)/c)"),
        ("a/b*c", "((a/b)*c)"),
        ("2^3^2", "(2^(3^2))"),
        ("-a*b", "((-a)*b)"),
        ("a*-b", "(a*(-b))"),
        ("a - -b + c", "((a - (-b)) + c)"),
        ("--a", "(-(-a))"),
        ("x^2/2", "((x^2)/2)"),
        ("x^(1/2)", "(x^(1/2))"),
        ("-2.sqrt()", "(-(2).sqrt())"),
        ("1.*x", "(1.*x)"),
        ("(a + b)*c", "((a + b)*c)"),
        ("u.x^2", "(u.x^2)"),
        ("x.powi(2).sqrt()", "x.powi(2).sqrt()"),
        ("a(b + c)", "a((b + c))"),
        ("wheel.velocity_at(p).x", "wheel.velocity_at(p).x"),
        ("sin(x,)", "sin(x)"),
        ("f()", "f()"),
        ("1/2*(dot(xi)^2 + 6.62607015e-34)", "((1/2)*((dot(xi)^2) + 6.62607015e-34))"),
        ("r#type + θ", "(r#type + θ)"),
        ("1_000.5", "1_000.5"),
    ] {
        assert_eq!(tree(text), expected, "{text}");
        // What is displayed means the same again.
        assert_eq!(tree(expected), expected);
    }
}

#[test]
fn invisible_groups_are_parentheses() {
    let fragment = TokenTree::Group(Group::new(Delimiter::None, tokens("a + b")));
    let stream: TokenStream = tokens("2*").into_iter().chain([fragment]).chain(tokens("^2")).collect();
    let (expression, report) = parse_expression(stream);
    assert!(report.is_empty(), "{report}");
    assert_eq!(expression.unwrap().to_string(), "(2*((a + b)^2))");

    let exponent = TokenTree::Group(Group::new(Delimiter::None, tokens("1")));
    let stream = tokens("x^").into_iter().chain([exponent]).chain(tokens("/2")).collect();
    assert_eq!(parse_expression(stream).0.unwrap().to_string(), "((x^1)/2)");

    // A literal that a macro passes on stands in such a group too.
    let zero = TokenTree::Group(Group::new(Delimiter::None, tokens("0")));
    let inside = tokens("a >").into_iter().chain([zero]).collect();
    let (constants, report) = crate::diagnostics::collect(|faults| {
        super::constants::constants(&Group::new(Delimiter::Brace, inside), faults)
    });
    assert!(report.is_empty(), "{report}");
    assert_eq!(constants.list[0].to_string(), "a > 0");

    let visibility = TokenTree::Group(Group::new(Delimiter::None, tokens("pub")));
    let stream = [visibility].into_iter().chain(tokens(HOOP.split_once("pub").unwrap().1)).collect();
    let (declaration, report) = parse(stream);
    assert!(report.is_empty(), "{report}");
    assert_eq!(declaration.unwrap().visibility.outside().to_string(), "pub");
}

#[test]
fn sources_have_few_parentheses() {
    for source in [
        "a*(b + c)^2 - sin(x)",
        "-x^2 + (-x)^-2 - (a - b)",
        "(a + b)/(c*d)*e - a/b/c",
        "a*-b^(1/2) + (a^b)^c",
        "(u + v).x + R.y.z + f(a, b + c).powi(2)",
        "2^(x + 1)*(2).sqrt()",
    ] {
        let (expression, _) = parse_expression(tokens(source));
        let expression = expression.unwrap();
        assert_eq!(expression.source(), source);
        assert_eq!(tree(&expression.source()), expression.to_string());
    }
}

#[test]
fn nodes_know_their_place() {
    let (expression, _) = parse_expression(tokens("a*(b + c)^2 - sin(x)"));
    let expression = expression.unwrap();
    let text = |span: proc_macro2::Span| span.source_text().unwrap();
    assert_eq!(text(expression.span), "-");
    assert_eq!(text(expression.extent()), "a");
    assert_eq!(text(expression.first_token()), "a");
    let (expression, _) = parse_expression(tokens("(b + c)"));
    assert_eq!(text(expression.unwrap().extent()), "(b + c)");
}

#[test]
fn the_hoop() {
    let (declaration, report) = parse(tokens(HOOP));
    assert!(report.is_empty(), "{report}");
    let declaration = declaration.unwrap();
    assert_eq!(
        declaration.docs.lines,
        [" A hoop of radius `a` that rolls without slipping on a horizontal plane."]
    );
    assert_eq!(
        declaration.to_string(),
        "pub system Hoop {
    constants { a > 0, A > 0, C > 0, g = 9.81 }
    coordinates { theta, psi, phi, xi, eta, zeta }
    let rolling = ((dot(psi)*cos(theta)) + dot(phi));
    parameters { eta1 = dot(theta); eta2 = (dot(psi)*sin(theta)); eta3 = rolling; }
    constraints { eta4: dot(xi) = ((((a*sin(theta))*sin(psi))*dot(theta)) - ((a*cos(psi))*dot(phi))); \
         eta5: (dot(eta) + (((a*sin(theta))*cos(psi))*dot(theta))) = 0; \
         eta6: (dot(zeta) - ((a*cos(theta))*dot(theta))) = 0; }
    kinetic_energy = (((1/2)*(((dot(xi)^2) + (dot(eta)^2)) + (dot(zeta)^2))) \
         + ((1/2)*(((A*(eta1^2)) + (A*(eta2^2))) + (C*(eta3^2)))));
    force_function = (((-a)*g)*sin(theta));
}"
    );
}

#[test]
fn every_section() {
    let (declaration, report) = parse(tokens(EVERYTHING));
    assert!(report.is_empty(), "{report}");
    let declaration = declaration.unwrap();
    let expected = "crate = :: my :: guen;
pub (in crate) system Cart {
    constants { m > 0, c >= 0, k != 0, g = 9.81, I > 0 = (((2/5)*m)*(k^2)), free }
    inputs { tau, F }
    coordinates { x, r#type, θ, η_1 }
    let p = vec(x, θ);
    let R = rot_z(θ);
    holonomic { on_ground: (p.y - k) = 0; loop_c: p = 0; }
    parameters { v = dot(x); w = dot(θ); }
    constraints { c: wheel.velocity_at(contact) = 0; }
    kinetic_energy = (((v^2)/2) + (0*c));
    particles { m at p; (2*m) at vec(x, 0, (-1e-3)); }
    bodies { wheel { mass: m, inertia: diag(I, I, (2*I)), center: p, orientation: R, } \
         rod { inertia: sym(1, 2, 3, 4, 5, 6), orientation: rot(vec(0, 0, 1), θ), } \
         ball { mass: 1, center: vec(0, 0, 0), } }
    gravity = vec(0, (-g));
    potential_energy = (k*x.powi(2).sqrt());
    states { dot(i) = (tau - i); dot(r#e: A*s) = ((-i)/2); }
    forces { (tau - (c*dot(x))) along dot(θ); (F*R.x) along dot(p); }
    resets { hop: (p.y - k) falls, x = (x + 1), v = (-v); r#in: x rises, w = 0; }
    outputs { height = p.y; }
    provide operators, reactions(c, on_ground);
    scene Tilt { track θ, x; fix m = 1, g = (-9.81), v; provide energy, reactions(c); }
    scene Empty { }
}";
    assert_eq!(declaration.to_string(), expected);
    assert_eq!(declaration.docs.lines, [" A cart.", "Second line."]);
    assert_eq!(declaration.visibility.inside().to_string(), "pub (in crate)");
    let (again, report) = parse(tokens(expected));
    assert!(report.is_empty(), "{report}");
    assert_eq!(again.unwrap().to_string(), expected);
}

#[test]
fn habits_in_expressions() {
    for (text, expected) in [
        ("2x + 1", "2x | cannot run into the name `x` | help: a product is written with `*`: `2*x`"),
        ("2sin(x)", "2sin | `2*sin(..)`"),
        ("1.0f64*x", "1.0f64 | numbers are exact and have no types: write `1.0`"),
        ("3usize", "3usize | write `3`"),
        ("a**b", "* | `**` is not an operator | `a^b`"),
        ("x^1/2", "/ | write `x^(1/2)`"),
        ("sin(a)^1/2 + 1", "/ | write `sin(a)^(1/2)`"),
        ("dot(u, v)", "dot | `inner(u, v)`"),
        ("m*dot(x'y)", "' | `dot(x)`"),
        ("x'y", "' | `dot(x)`"),
        ("2(x + 1)", "( | expected an operator before `(` | write `*` between its factors"),
        ("(a)(b)", "( | expected an operator"),
        ("(a, b)", ", | `vec(x, y, z)`"),
        ("[a, b]", "[ | `vec(x, y, z)`"),
        ("v.0", "0 | `.x`, `.y` and `.z`"),
        ("f64::sqrt(x)", "f64 | paths have no meaning here"),
        ("vec![a, b]", "vec | without `!`"),
        ("0x10", "0x10 | not a decimal number"),
        ("1e999", "1e999 | between 10^-400 and 10^400"),
        ("a + * b", "* | expected an expression, found `*`"),
        ("a b", "b | found `b` | write `*`"),
        ("a +", " | expected an expression, found the end"),
        ("a == b", "= | found `==`"),
        ("a % b", "% | remainder"),
        ("|x|", "| | `abs(x)`"),
        ("+x", "+ | remove this sign"),
        ("x as f64", "as | leave out `as`"),
        ("if a", "if | keyword `if`"),
        ("\"a\"", "\"a\" | expected a number"),
        ("sin(a b)", "b | expected `,`"),
        ("()", ") | expected an expression, found the end"),
    ] {
        assert_faults(&expression_faults(text), &[expected]);
    }
}

#[test]
fn several_faults_in_one_expression() {
    assert_faults(
        &expression_faults("sin(2x) + a**3y - (x^1/2)*f(4z, 5)"),
        &["2x | `2*x`", "* | `**`", "3y | `3*y`", "/ | `x^(1/2)`", "4z | `4*z`"],
    );
}

#[test]
fn habits_in_sections() {
    for (sections, expected) in [
        ("constants { a, b > 1 }", "1 | compares with `0`"),
        ("constants { 0 < a < 1, b }", "0 | expected the name of a constant"),
        ("constants { a > 0 > 1 }", "> | cannot be chained"),
        ("constants { a < 0 }", "< | does not begin a bound"),
        ("constants { a = 2 > 0 }", "> | before the default"),
        ("constants { a: f64, b }", "f64 | names have no types"),
        ("constants { a: m/s^x }", "x | expected the power of a unit"),
        ("constants { a: kg*b }", "b | unknown unit `b`"),
        ("constants { a: (m/s s) }", "s | expected `)`"),
        ("constants { a b }", "b | expected `,` before `b`"),
        ("constants { g = 9.81 m/s, b }", "m | expected `,`, found `m`"),
        ("constants { a; b }", "; | expected `,`, found `;`"),
        ("constants { g == 1 }", "= | found `==`"),
        ("constants { pub a }", "pub | only before `system`"),
        ("constants { type }", "type | `r#type`"),
        ("constants { self }", "self | choose another name"),
        ("constants { 2a }", "2a | expected the name of a constant"),
        ("constants = 1;", "= | expected `{` after `constants`"),
        ("coordinates { x y }", "y | expected `,` before `y`"),
        ("coordinates { x: f64 }", "f64 | names have no types"),
        ("coordinates { x = 0 }", "= | initial values"),
        ("let a = x\nlet b = x;", "let | expected `;` before keyword `let`"),
        ("let a x;", "x | expected `=` after `a`"),
        ("let mut a = x;", "mut | remove `mut`"),
        ("let a = b = c;", "= | one `=`"),
        ("let a = 1,", ", | expected `;`, found `,`"),
        ("parameters { v: dot(x); }", ": | expected `=` after `v`"),
        ("parameters { v := dot(x); }", ": | found `:=`"),
        ("parameters { m, }", "m | `constants"),
        ("parameters { m > 0 }", "m | `constants"),
        ("parameters { g = 9.81, }", "g | `constants"),
        ("parameters { v = dot(x) w = 1; }", "w | expected `;` before `w`"),
        ("parameters { v = dot(x) }", ") | expected `;` after this"),
        ("parameters { v = ; }", "; | expected an expression, found `;`"),
        ("constraints { c = dot(x) = 0; }", "= | expected `:` after `c` | `name: left = right;`"),
        ("constraints { dot(x) = 0; }", "dot | needs a name"),
        ("constraints { c: dot(x); }", ") | `c` is an equation"),
        ("constraints { c: dot(x) == 0; }", "= | found `==`"),
        ("constraints { c: x = y = 0; }", "= | one `=`"),
        ("holonomic { c: x > 0; }", "> | constraints are equations"),
        ("kinetic_energy: 1;", ": | write `kinetic_energy = e;`"),
        ("kinetic_energy { 1 }", "{ | expected `=`"),
        ("kinetic_energy = 1 force_function = 2;", "force_functi | expected `;` before"),
        ("gravity = vec(0, -1) forces { }", "forces | expected `;` before"),
        ("particles { m, vec(0, 0); }", ", | expected `at`"),
        ("particles { m x at vec(0, 0); }", "x | `at` or an operator"),
        ("forces { F = 1; }", "= | `force along velocity;`"),
        ("bodies { b { mas: 1, center: c } }", "mas | did you mean `mass`?"),
        ("bodies { b { mass = 1, center: c } }", "= | expected `:`"),
        ("bodies { b { mass: 1 } }", "mass | no `center`"),
        ("bodies { b { inertia: diag(1, 2), orientation: R } }", "diag | takes 3 entries, 2 are given"),
        ("bodies { b { inertia: 1, orientation: R } }", "1 | `diag` or `sym`"),
        ("bodies { b { mass: 1, mass: 2, center: c } }", "mass | given twice"),
        ("bodies { b { mass: 1 center: c } }", "center | expected `,` before `center`"),
        ("bodies { b { } }", "b | neither mass nor inertia"),
        ("bodies { b = 1; }", "= | expected `{`"),
        ("scene A { trak x; }", "trak | did you mean `track`?"),
        ("scene A { track x y; }", "y | expected `,` before `y`"),
        ("scene A { track x fix a = 1; }", "fix | expected `;` before `fix`"),
        ("scene A { fix a == 1; }", "= | found `==`"),
        ("scene A { track; }", "; | expected a name"),
        ("coordinate { x } ", "coordinate | did you mean `coordinates`?"),
        ("lagrangian = 1;", "lagrangian | `kinetic_energy = e;`"),
        ("constants { a } constants { b }", "constants | given twice | first given at line 1"),
        ("force_function = 1; potential_energy = 2;", "potential_en | both given"),
        ("let a = 1;;", "; | ends nothing"),
        ("pub let a = 1;", "pub | only before"),
        ("#[cfg(test)] let a = 1;", "cfg | attribute `cfg`"),
        ("constants { a, /// lost\n }", "/// lost | documents nothing"),
        ("(a)", "( | expected a section"),
    ] {
        assert_faults(&section_faults(sections), &[expected]);
    }
}

#[test]
fn several_faults_in_one_declaration() {
    let faults = section_faults(
        "constants { a > 2, b: f64, c }
         parameters { v = 2x; w = dot(u, v); z = + ; }
         constraints { c: x == 0; d: y; e: z = 1q; }
         kinetic_enrgy = 1;
         scene A { track 3; fix a = 2b; }",
    );
    assert_faults(
        &faults,
        &[
            "2 | compares",
            "f64 | names have no types",
            "2x | `2*x`",
            "dot | inner",
            "+ | remove this sign",
            "; | expected an expression",
            "= | `==`",
            "y | is an equation",
            "1q | `1*q`",
            "kinetic_enrg | `kinetic_energy`",
            "3 | expected a name",
            "2b | `2*b`",
        ],
    );
}

#[test]
fn heads() {
    for (text, expected) in [
        ("", " | expected `system`, found the end"),
        ("pub Hoop { }", "Hoop | expected `system`"),
        ("system { }", "{ | expected the name of the system"),
        ("system A<R> { }", "< | remove the parameters"),
        ("system A; ", "; | expected `{` after `A`"),
        ("crate = 1; system A { coordinates { x } particles {} }", "1 | expected a path"),
        ("crate = a system A { coordinates { x } particles {} }", "system | expected `;` after the path"),
        ("pub(x) system A { coordinates { x } particles {} }", "( | visibility is unknown"),
        ("#[derive(Debug)] system A { coordinates { x } particles {} }", "derive | attribute `derive`"),
        ("system A { coordinates { x } particles {} } system B {}", "system | one invocation"),
        ("system A { coordinates { x } particles {} } fn", "fn | expected nothing"),
        ("system A { particles {} }", "A | no `coordinates`"),
        ("system A { coordinates { x } }", "A | no kinetic energy"),
    ] {
        let (_, report) = parse(tokens(text));
        assert_faults(&faults_of(&report), &[expected]);
    }
}

#[test]
fn names_survive_faults() {
    let (declaration, report) = parse(tokens(
        "system S { constants { a > 3, b: f64 } coordinates { x = 0 } parameters { v = 2x; w; } \
                      constraints { c: y; } particles { 1 at 2q; } }",
    ));
    assert_eq!(report.faults().len(), 7, "{report}");
    let text = declaration.unwrap().to_string();
    assert!(text.contains("constants { a, b }") && text.contains("coordinates { x }"), "{text}");
    assert!(text.contains("parameters { v = ?; w = ?; }") && text.contains("c: ? = ?;"), "{text}");
}

#[test]
fn deep_nesting_is_an_error() {
    let deep = |open: &str, close: &str| {
        let text = format!("{}x{}", open.repeat(MAX_DEPTH + 1), close.repeat(MAX_DEPTH + 1));
        assert_faults_contain(&expression_faults(&text), "nested more than");
    };
    deep("(", ")");
    deep("-", "");
    deep("+ -", "");
    deep("2^", "");
    deep("sin(", ")");
    deep("", ".a");
    deep("", ".f(1)");
    let fits = format!("{}x{}", "(".repeat(MAX_DEPTH), ")".repeat(MAX_DEPTH));
    assert_eq!(tree(&fits), "x");
    // Long is not deep.
    assert!(tree(&vec!["x"; 10_000].join(" + ")).ends_with("x)"));
}

#[track_caller]
fn assert_faults_contain(found: &[String], words: &str) {
    assert!(found.iter().any(|fault| fault.contains(words)), "{found:?}");
}

#[test]
fn too_many_entries_are_an_error() {
    let names = |count: usize| (0..count).map(|i| format!("x{i}")).collect::<Vec<_>>().join(", ");
    assert!(section_faults(&format!("coordinates {{ {} }}", names(1000))).is_empty());
    assert_faults(
        &section_faults(&format!("coordinates {{ {} }}", names(1100))),
        &["x1000 | more than 1000"],
    );
}

/// A fixed sequence of numbers that looks random (a linear congruential generator, upper bits).
struct Sequence(u64);

impl Sequence {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

/// Deletes, doubles or exchanges tokens somewhere in a stream.
fn damaged(stream: TokenStream, sequence: &mut Sequence) -> TokenStream {
    let mut tokens: Vec<TokenTree> = stream.into_iter().collect();
    let groups: Vec<usize> =
        (0..tokens.len()).filter(|i| matches!(tokens[*i], TokenTree::Group(_))).collect();
    if !groups.is_empty() && sequence.below(5) > 0 {
        let at = groups[sequence.below(groups.len())];
        if let TokenTree::Group(group) = &tokens[at] {
            let delimiter = match sequence.below(12) {
                0 => Delimiter::None,
                1 => Delimiter::Brace,
                2 => Delimiter::Parenthesis,
                3 => Delimiter::Bracket,
                _ => group.delimiter(),
            };
            let mut inner = Group::new(delimiter, damaged(group.stream(), sequence));
            inner.set_span(group.span());
            tokens[at] = TokenTree::Group(inner);
        }
    } else if !tokens.is_empty() {
        let (at, other) = (sequence.below(tokens.len()), sequence.below(tokens.len()));
        match sequence.below(3) {
            0 => drop(tokens.remove(at)),
            1 => tokens.insert(other, tokens[at].clone()),
            _ => tokens.swap(at, other),
        }
    }
    tokens.into_iter().collect()
}

/// Every word of counts, arrays and loops.
const FAMILY: &str = "system S {
    count n = 4 - 1;
    constants { m[n] > 0 = 1, k[n, n], for i in 0..n { l[i] = i } }
    coordinates { q[n] }
    let p[0] = q[0];
    for i in 1..=n-1 { let p[i] = p[i-1] + l[i % 2]*q[i]; }
    parameters { for i in 0..n { if i == 0 || !(i > 1) { w[i] = dot(q[i]); } else { w[i] = 2*dot(p[i]); } } }
    kinetic_energy = sum(i in 0..n: m[i]*w[i]^2) + product(i in 0..0: m[i]);
    forces { for i in 0..n { for j in 0..i { -k[i, j]*q[j] along w[i]; } } }
    scene A { track q, w[0]; fix m = 1, k[0, 1] = 2; }
}";

#[test]
fn damage_never_panics() {
    let valid = [tokens(HOOP), tokens(EVERYTHING), tokens(FAMILY)];
    let mut sequence = Sequence(1);
    let mut refused = 0;
    for round in 0..3000 {
        let mut stream = valid[round % 3].clone();
        for _ in 0..=sequence.below(6) {
            stream = damaged(stream, &mut sequence);
        }
        let (declaration, report) = parse(stream);
        refused += usize::from(!report.is_empty());
        assert!(declaration.is_some() || !report.is_empty());
        // The tree without faults has nothing missing; the errors are tokens again.
        if report.is_empty() {
            assert!(!declaration.unwrap().to_string().contains('?'));
        } else {
            assert!(!report.to_compile_errors().is_empty());
        }
    }
    assert!(refused > 1500, "the damage is too gentle: {refused}");
}
