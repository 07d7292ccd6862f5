//! Holonomic equations that follow from others wherever all hold: which they are, and what is said where the count is wrong. Equations
//! that hold nowhere.

use guen_language::derive::{derive, function};
use guen_language::diagnostics::collect;
use guen_language::report::ReportLines;
use guen_language::{model, parse};

use crate::common::{derived, evaluated};

/// A coupler on three parallel cranks of one length: two loops of which one would do, for the coupler cannot turn.
fn cranks(lengths: [&str; 3], parameters: &str) -> String {
    let [a, b, c] = lengths;
    let further = if lengths.contains(&"k") { "k > 0, " } else { "" };
    format!(
        "pub system Cranks {{
            constants {{ m > 0, l > 0, {further}d > 0, g = 9.81 }}
            coordinates {{ q1, q2, q3, turn }}
            let start = {a}*rot_z(q1).x;
            let way = rot_z(turn).x;
            bodies {{ coupler {{ mass: m, inertia: diag(0, 0, m*d^2/3), center: start + d*way, orientation: rot_z(turn) }} }}
            particles {{ m at {b}*rot_z(q2).x; m at {c}*rot_z(q3).x; }}
            gravity = vec(0, -g);
            parameters {{ {parameters} }}
            holonomic {{
                middle: start + d*way = vec(d, 0) + {b}*rot_z(q2).x;
                end: start + 2*d*way = vec(2*d, 0) + {c}*rot_z(q3).x;
            }}
        }}"
    )
}

/// The message of the one fault of a declaration.
fn fault(text: &str) -> String {
    let (declaration, report) = parse::parse(text.parse().unwrap());
    assert!(report.is_empty(), "{}", report.to_compile_errors());
    let declaration = declaration.unwrap();
    let (derived, report) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
    assert!(derived.is_none());
    report.to_compile_errors().to_string()
}

#[test]
fn three_parallel_cranks_of_one_length_move() {
    derived(&cranks(["l", "l", "l"], "v = dot(q1);"), |derived| {
        let names: Vec<&str> = derived.model.redundant.iter().map(|one| one.entry.name.as_str()).collect();
        assert_eq!(names.len(), 1, "{names:?}");
        assert!(derived.system.program(function::RHS).is_some());
        assert_eq!(derived.model.mechanics.holonomic.len(), 3);
    });
}

#[test]
fn cranks_of_different_lengths_have_one_equation_too_many() {
    let text = fault(&cranks(["l", "l", "k"], "v = dot(q1);"));
    assert!(text.contains("4 coordinates need 4 forms, and 5 are declared"), "{text}");
    assert!(text.contains("as one constant where they are equal"), "{text}");
}

#[test]
fn without_a_parameter_the_mechanism_moves_with_one_that_is_chosen() {
    derived(&cranks(["l", "l", "l"], ""), |derived| {
        let chosen = derived.model.chosen.as_ref().expect("a choice");
        assert_eq!((chosen.names.len(), derived.model.redundant.len()), (1, 1));
        assert!(derived.system.program(function::RHS).is_some());
    });
}

/// Forms of a frame in direction cosines, by rows and by columns: three of six say everything.
#[test]
fn rows_and_columns_of_a_rotation_say_the_same() {
    let text = "pub system Turn {
        constants { J > 0 }
        coordinates { a, b, c, d }
        kinetic_energy = J/2*(dot(a)^2 + dot(b)^2 + dot(c)^2 + dot(d)^2);
        parameters { w = a*dot(c) + b*dot(d) - c*dot(a) - d*dot(b); }
        holonomic {
            first: a^2 + b^2 = 1; second: c^2 + d^2 = 1; across: a*c + b*d = 0;
            left: a^2 + c^2 = 1; right: b^2 + d^2 = 1; between: a*b + c*d = 0;
        }
    }";
    derived(text, |derived| {
        let names: Vec<&str> = derived.model.redundant.iter().map(|one| one.entry.name.as_str()).collect();
        assert_eq!(names, ["left", "right", "between"]);
    });
}

/// Two wheels that share an axle: the rows of velocities are the same where the angles are.
fn wheels(second: &str, parameters: &str) -> String {
    format!(
        "pub system Wheels {{
            constants {{ m > 0, r = 2 }}
            coordinates {{ a, b, x, y, z }}
            kinetic_energy = m/2*(dot(a)^2 + dot(b)^2 + dot(x)^2 + dot(y)^2 + dot(z)^2) + r*0;
            parameters {{ {parameters} }}
            constraints {{ first: dot(z) = r*sin(a)*dot(x) + t; second: {second} = 0; }}
            holonomic {{ axle: a = b; }}
            forces {{ x along dot(y); 3*y along dot(x); }}
        }}"
    )
}

#[test]
fn rows_of_velocities_that_follow_where_positions_hold_do_not_count() {
    let rates = |text: &str, names: &[&str]| {
        derived(text, |derived| {
            let redundant = derived.model.redundant.iter().map(|one| one.entry.name.as_str());
            assert_eq!(redundant.collect::<Vec<_>>(), names, "{text}");
            let value = |symbol| match derived.model.bench.graph.symbol_info(symbol).name.as_str() {
                "a" | "b" => 0.7,
                "x" => 0.3,
                "y" => -0.4,
                "u" => 1.1,
                _ => 0.9,
            };
            evaluated(&derived.system, function::RHS, value).expect("rates")
        })
    };
    let parameters = "u = dot(x); v = dot(y); w = dot(a);";
    let alone = wheels("0*dot(x)", parameters).replace("second: 0*dot(x) = 0;", "");
    let expected = rates(&alone, &[]);
    for second in [
        "dot(z) - r*sin(b)*dot(x) - t",
        "(1 + y^2)*(dot(z) - r*sin(b)*dot(x) - t)",
        "first + (cos(a) - cos(b))*dot(x)",
        "dot(a) - dot(b) + (a - b)*dot(z)",
        "2*(dot(z) - r*sin(b)*dot(x) - t) + sin(x)*(dot(a) - dot(b))",
    ] {
        assert_eq!(rates(&wheels(second, parameters), &["second"]), expected, "{second}");
        let lines = derived(&wheels(second, ""), |derived| {
            ReportLines::of(&derived.model, &derived.system).to_text()
        });
        assert!(lines.contains("second is no form: it follows from "), "{lines}");
    }
    // A row that follows from others everywhere, or contradicts them, is a mistake.
    for second in ["dot(z) - r*sin(a)*dot(x) - t", "dot(a) - dot(b)", "dot(z) - r*sin(b)*dot(x) - t - 1"] {
        fault(&wheels(second, ""));
    }
    let asked = wheels("dot(z) - r*sin(b)*dot(x) - t", "")
        .replace("forces", "outputs { o = reaction(second); } forces");
    assert!(fault(&asked).contains("the reaction of `second` is not determined"));
}

/// A row whose velocities vanish where the positions hold is told by what is left of it there.
#[test]
fn rows_without_velocities_where_positions_hold_are_told() {
    for factor in ["a - b", "cos(a) - cos(b)"] {
        for (rest, note) in [("1", "there it requires `1 = 0`"), ("sin(y)", "`second: sin(y) = 0;`")] {
            let text = fault(&wheels(&format!("({factor})*dot(x) - {rest}"), ""));
            assert!(text.contains("the velocities of constraint `second` vanish wherever"), "{text}");
            assert!(text.contains(note), "{text}");
        }
        let text = fault(&wheels(&format!("({factor})*dot(x)"), ""));
        assert!(
            text.contains("constraint `second` vanishes wherever the holonomic constraints hold"),
            "{text}"
        );
    }
    let divided = wheels("dot(z) - dot(x)/(cos(a) - cos(b))", "");
    assert!(fault(&divided).contains("`cos(a) - cos(b)` vanishes wherever the `holonomic` constraints hold"));
}

/// Where one branch of the positions makes rows dependent and another does not, none of them is left out.
#[test]
fn rows_that_follow_on_one_branch_only_stay() {
    let text = wheels("dot(z) - r*cos(b)*dot(x) - t", "")
        .replace("a = b", "sin(a) = sin(b)")
        .replace("r*sin(a)", "r*cos(a)");
    derived(&text, |derived| assert!(derived.model.redundant.is_empty()));
}

/// A particle in the plane with a second equation on its distance.
fn circle(second: &str) -> String {
    format!(
        "pub system Circle {{
            constants {{ m > 0, l > 0 }}
            coordinates {{ x, y }}
            particles {{ m at vec(x, y); }}
            parameters {{ u = x*dot(y) - y*dot(x); }}
            holonomic {{ first: x^2 + y^2 = l^2; second: {second} = 0; }}
        }}"
    )
}

#[test]
fn what_is_said_twice_everywhere_is_named() {
    for second in ["(x^2 + y^2)^2 - l^4", "x^2 + y^2 - 2*l^2"] {
        let text = fault(&circle(second));
        let note = "the velocities of `second` are those of `first`: it repeats or contradicts them";
        assert!(text.contains(note), "{text}");
    }
}

/// The rates of a particle on a circle of radius 1 that is declared by this equation, pushed along its first coordinate.
fn rates_on_circle(equation: &str) -> Vec<f64> {
    let text = format!(
        "pub system Circle {{
            constants {{ m > 0, k, n }}
            coordinates {{ x, y }}
            particles {{ m at vec(x, y); }}
            forces {{ 1 along dot(x); }}
            parameters {{ u = x*dot(y) - y*dot(x); }}
            holonomic {{ circle: {equation} = 0; }}
        }}"
    );
    derived(&text, |derived| {
        let value = |symbol| match derived.model.bench.graph.symbol_info(symbol).name.as_str() {
            "x" => 0.6,
            "y" => 0.8,
            "u" => -1.7,
            "k" => -2.5,
            "n" => 0.7,
            _ => 1.3,
        };
        evaluated(&derived.system, function::RHS, value).expect("rates")
    })
}

/// Points of the constraint manifold were found by making the constant factor zero, where every gradient vanishes.
#[test]
fn a_constant_factor_of_an_equation_changes_nothing() {
    let plain = rates_on_circle("x^2 + y^2 - 1");
    // Along the circle with the speed -1.7, pushed by 1/1.3.
    for (rate, expected) in plain.iter().zip([1.7 * 0.8, -1.7 * 0.6, -0.8 / 1.3]) {
        assert!((rate - expected).abs() < 1e-14, "{plain:?}");
    }
    for equation in [
        "k*(x^2 + y^2 - 1)",
        "k*x^2 + k*y^2 - k",
        "n*k^2*x^2/2 + n^2*k*y^2*k/(2*n) - k^2*n/2",
        "(k - n)*(x^2 + y^2 - 1)",
        "(x^2 + y^2 - 1)/k",
    ] {
        let rates = rates_on_circle(equation);
        assert!(rates.iter().zip(&plain).all(|(a, b)| (a - b).abs() < 1e-13), "{equation}: {rates:?}");
    }
    let text = fault(&circle("m*l*(x^2 + y^2)^2 - m*l^5"));
    assert!(text.contains("the velocities of `second` are those of `first`"), "{text}");
}

#[test]
fn an_inertia_of_no_body_has_a_line_in_the_report() {
    let line = |inertia: &str, turn: &str| {
        let text = format!(
            "pub system Top {{
                coordinates {{ a, b, c }}
                let R = {turn};
                bodies {{ top {{ mass: 1, inertia: {inertia}, center: vec(a, b, c), orientation: R }} }}
                parameters {{ u = dot(a); v = dot(b); w = dot(c); }}
            }}"
        );
        derived(&text, |derived| {
            let report = ReportLines::of(&derived.model, &derived.system).to_text();
            report.contains("the inertia of top is that of no body")
        })
    };
    let turn = "rot_z(a)*rot_x(b)*rot_z(c)";
    assert!(
        line("diag(1, 1, 5)", turn) && line("diag(1, -1, 5)", turn) && line("sym(1, 1, 1, 2, 0, 0)", turn)
    );
    assert!(!line("diag(1, 1, 2)", turn) && !line("sym(2, 2, 2, 1/2, 1/2, 0)", turn));
    // About one axis nobody sees the others.
    assert!(!line("diag(0, 0, 5)", "rot_z(a)"));
}

#[test]
fn a_constraint_whose_gradient_vanishes_where_it_holds_is_named() {
    let text = "pub system Pair {
        constants { m > 0 }
        coordinates { x, y }
        particles { m at vec(x, y); }
        parameters { u = dot(x); }
        holonomic { same: (x - y)^2 = 0; }
    }";
    let text = fault(text);
    assert!(text.contains("the rate of `same` vanishes wherever `same` holds"), "{text}");
}

/// Two four-bar linkages side by side, with the angles of all bars.
#[test]
fn where_loops_are_stretched_out_the_domain_ends_in_the_names_of_the_declaration() {
    let text = "pub system Bars {
        constants { g = 9.81 }
        coordinates { a0, a1, a2, b1, b2 }
        let top0 = rot_z(a0).x;
        let top1 = vec(1, 0) + rot_z(a1).x;
        let top2 = vec(2, 0) + rot_z(a2).x;
        particles { 1 at top0; 1 at top1; 1 at top2; }
        gravity = vec(0, -g);
        parameters { turn = dot(a0); }
        holonomic { left: top0 + rot_z(b1).x = top1; right: top1 + rot_z(b2).x = top2; }
    }";
    derived(text, |derived| {
        assert_eq!(derived.system.domain_names[..2], ["-sin(a1 - b1)", "-sin(a2 - b2)"]);
        assert!(derived.model.redundant.is_empty());
    });
}

#[test]
fn an_equation_that_holds_nowhere_is_refused_and_none_that_may_hold() {
    let is_refused = |equation: &str| {
        let text = format!(
            "pub system Bead {{
                constants {{ m > 0, a > 0, b >= 0, c, d != 0 }}
                coordinates {{ x, y, z }}
                parameters {{ u = dot(x); v = dot(y); }}
                holonomic {{ on: {equation}; }}
                kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + dot(z)^2);
            }}"
        );
        guen_language::expand(text.parse().unwrap()).to_string().contains("`on` cannot be fulfilled")
    };
    for equation in [
        "x^2 + y^2 + z^2 = -1",
        "-a = x^2 + z^2",
        "x^2 + z^2 = -d^2",
        "a*exp(z) = -b",
        "z^2 + sqrt(x) + a = 0",
        "cosh(z) + y^4 = -b",
        "vec(z, 0, -z^2) = vec(x, 0, a)",
        "1/z = 0",
        "a/(x*z) = 0",
        "sin(x) = 2",
        "sin(x)*cos(z) = 3/2 + b",
        "1/(1 + x^2) = 2",
        "tanh(x) = 1",
        "atan(x) = z^2 + 2",
        "exp(-x^2) + sin(z)^2 = 5/2",
        "a + sinh(b + x^2) = 0",
        "(2 + sin(x))^3 = 28",
        "(2 + sin(x))^20 = -z^2",
    ] {
        assert!(is_refused(equation), "{equation}");
    }
    for equation in [
        "x^2 + y^2 + z^2 = 1",
        "x^2 + z^2 = c",
        "x^2 + z^2 = -c",
        "x^2 + z^2 + b = 0",
        "x^2 + z^2 = d",
        "z^3 = -a",
        "exp(z) = 1 + x^2",
        "z*(1 + x^2) = 0",
        "a*z + x^2 + 1 = 0",
        "x^2 - 1 = -z^2",
        "1/z = 1",
        "1/x + 1/z = 0",
        "sin(x) = 1",
        "sin(x) + cos(z) = -2",
        "sin(x) = a",
        "x/z = 0",
        "c/z = 1",
        "tanh(x) = 9/10",
        "1/(1 + x^2) = 1",
        "exp(-x^2) = 1",
        "asin(x) = 3/2",
        "(2 + sin(x))^3 = 27",
        "sin(x)^3 = -1",
        "x^2*sin(z) = -5",
    ] {
        assert!(!is_refused(equation), "{equation}");
    }
}

/// Heel and toe of a foot that stands flat, with and without promises of signs: both equations count. Of a foot without length one would do,
/// and no point of such a foot decides.
#[test]
fn heel_and_toe_are_two_equations() {
    for bound in ["> 0", ""] {
        let text = format!(
            "pub system Foot {{
                constants {{ m > 0, l {bound}, f {bound}, g = 9.81 }}
                coordinates {{ x, z, leg, foot }}
                let ankle = vec(x, z) + l*vec(sin(leg), -cos(leg));
                let toe = ankle + f*vec(cos(foot), sin(foot));
                particles {{ m at vec(x, z); m at ankle; m at toe; }}
                gravity = vec(0, -g);
                holonomic {{ heel_on: ankle.y = 0; toe_on: toe.y = 0; }}
            }}"
        );
        derived(&text, |derived| {
            assert!(derived.model.redundant.is_empty(), "{bound}");
            assert_eq!(derived.system.derivation.system.forms.degrees, 2);
        });
    }
}

#[test]
fn the_report_names_what_an_equation_follows_from_beside_chosen_parameters() {
    let folded = |parameters: &str| {
        format!(
            "pub system Folded {{
                constants {{ a > 0, b > 0, m > 0, g = 9.81 }}
                coordinates {{ p, q, r }}
                {parameters}
                let R1 = rot_x(p);
                let R2 = R1*rot_x(q);
                let R3 = R2*rot_x(r);
                let A = R1*vec(0, 0, a);
                let B = A + R2*vec(0, b, 0);
                let C = B + R3*vec(0, 0, -a);
                particles {{ m at A; m at B; }}
                gravity = vec(0, 0, -g);
                holonomic {{ closed: C = vec(0, b, 0); square: inner(C, C) = b^2; }}
            }}"
        )
    };
    for parameters in ["", "parameters { w = dot(p); }"] {
        let report = derived(&folded(parameters), |folded| {
            let report = ReportLines::of(&folded.model, &folded.system).to_text();
            report.lines().filter(|line| line.contains("is no form")).map(str::to_owned).collect::<Vec<_>>()
        });
        let [line] = &report[..] else { panic!("{report:?}") };
        assert!(line.contains("follows from closed_y wherever"), "{line}");
    }
}
