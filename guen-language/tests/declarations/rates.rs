//! Parameters that are left out: which the macro chooses, and that they are what they would be if they were declared.

use guen_language::derive::{derive, function};
use guen_language::diagnostics::collect;
use guen_language::report::ReportLines;
use guen_language::{model, parse};

use crate::common::{derived, evaluated};

/// The names of the parameters of a declaration, and its right-hand side at a state in bits.
fn outcome(text: &str) -> (Vec<String>, Vec<u64>) {
    derived(text, |derived| {
        let degrees = derived.model.mechanics.forms.degrees;
        let names = derived.model.forms[..degrees].iter().map(|form| form.name.clone()).collect();
        // A value for each name: the order in which names occur differs.
        let value = |symbol| {
            let name = &derived.model.bench.graph.symbol_info(symbol).name;
            name.bytes().fold(0.3, |value, byte| (value * 7.0 + f64::from(byte) / 50.0) % 1.7)
        };
        let rates = evaluated(&derived.system, function::RHS, value);
        (names, rates.expect("a right-hand side").into_iter().map(f64::to_bits).collect())
    })
}

fn faults(text: &str) -> String {
    let (declaration, report) = parse::parse(text.parse().unwrap());
    assert!(report.is_empty(), "{}", report.to_compile_errors());
    let declaration = declaration.unwrap();
    let (derived, report) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults));
    assert!(derived.is_none());
    report.to_compile_errors().to_string()
}

fn sled(parameters: &str) -> String {
    format!(
        "pub system Sled {{
            constants {{ m > 0, J > 0, c >= 0 }}
            coordinates {{ phi, x, y }}
            {parameters}
            constraints {{ blade: dot(x)*sin(phi) - dot(y)*cos(phi) = 0; }}
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*phi_rate^2;
            forces {{ -c*x_rate along x_rate; }}
        }}"
    )
}

#[test]
fn rates_of_coordinates_are_chosen_as_if_they_were_declared() {
    let (names, rates) = outcome(&sled(""));
    assert_eq!(names, ["phi_rate", "x_rate"]);
    let written = outcome(&sled("parameters { phi_rate = dot(phi); x_rate = dot(x); }"));
    assert_eq!((names, rates), written);
}

#[test]
fn a_list_that_is_too_short_is_completed_behind_its_end() {
    let (names, _) = outcome(&sled("speeds { x_rate = dot(x); }"));
    assert_eq!(names, ["x_rate", "phi_rate"]);
    let (names, rates) = outcome(&sled("quasi_velocities { x_rate = dot(x); }"));
    assert_eq!((names, rates), outcome(&sled("parameters { x_rate = dot(x); phi_rate = dot(phi); }")));
}

/// The slider stands still twice a turn: its rate is no parameter, although it comes first.
#[test]
fn a_rate_that_stops_is_not_chosen() {
    let crank = |first: &str| {
        format!(
            "pub system Crank {{
                constants {{ m > 0, r > 0 }}
                coordinates {{ {first} }}
                constraints {{ drive: dot(x) = r*cos(turn)*dot(turn); }}
                kinetic_energy = m/2*dot(x)^2 + m*r^2/2*dot(turn)^2;
            }}"
        )
    };
    for first in ["x, turn", "turn, x"] {
        assert_eq!(outcome(&crank(first)).0, ["turn_rate"]);
    }
    // Where the slider is coupled by a constant, both are alike, and the first is chosen.
    assert_eq!(outcome(&crank("x, turn").replace("cos(turn)", "3")).0, ["x_rate"]);
    // By a constant whose default makes it slow its rate is not.
    let slow = crank("x, turn").replace("cos(turn)", "1").replace("r > 0", "s = 1/10, r > 0 = s/2");
    assert_eq!(outcome(&slow).0, ["turn_rate"]);
}

/// States are those on the manifold: off it both sets would be alike.
#[test]
fn sets_are_compared_where_the_holonomic_constraints_hold() {
    let text = "pub system Rail {
        coordinates { x, y, z }
        holonomic { rail: z = 0; }
        constraints { slope: dot(y) = (1 + 40*z)*dot(x) - 40*x*dot(z); }
        kinetic_energy = dot(x)^2 + dot(y)^2 + dot(z)^2;
    }";
    assert_eq!(outcome(text).0, ["x_rate"]);
    derived(text, |derived| {
        let chosen = derived.model.chosen.as_ref().unwrap();
        // T = (1, 0) everywhere on the rail.
        assert!((chosen.condition - 2.0_f64.sqrt()).abs() < 1e-9, "{}", chosen.condition);
    });
}

#[test]
fn a_quaternion_and_a_closed_loop_get_rates_that_follow_the_motion() {
    let ball = "pub system Ball {
        constants { m > 0, a > 0, I > 0 = 2/5*m*a^2 }
        coordinates { w, i, j, k, x, y }
        bodies { ball { mass: m, inertia: diag(I, I, I), center: vec(x, y, a), orientation: quaternion(w, i, j, k) } }
        constraints { rolling: ball.velocity_at(vec(x, y, 0)) = 0; }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
    }";
    let (names, _) = outcome(ball);
    assert_eq!(names.len(), 3);
    let loop_of_four = "pub system FourBar {
        constants { m > 0 = 1, a > 0 = 1, b > 0 = 3, c > 0 = 2, d > 0 = 5/2 }
        coordinates { p, q, r }
        holonomic { close: a*rot_z(p).x + b*rot_z(q).x = vec(d, 0) + c*rot_z(r).x; }
        kinetic_energy = m*(dot(p)^2 + dot(q)^2 + dot(r)^2);
    }";
    assert_eq!(outcome(loop_of_four).0.len(), 1);
}

/// Too many sets to compare them all: seven bodies on rails that are coupled in a ring.
/// Four rods of one length fold, and where they are folded one of their rates vanishes, whichever is given.
#[test]
fn loops_of_equal_rods_get_the_rate_of_what_is_beside_them() {
    for (base, given) in ["p", "q", "r"].iter().flat_map(|given| [("d", given), ("1", given)]) {
        let text = format!(
            "pub system Rhombus {{
                constants {{ a > 0, b > 0, c > 0, d > 0, m > 0 }}
                coordinates {{ p, q, r, s }}
                parameters {{ w = dot({given}); }}
                let elbow = a*vec(cos(p), sin(p));
                let hand = elbow + b*vec(cos(q), sin(q));
                particles {{ m at elbow; m at hand; m at hand + vec(s, 0); }}
                holonomic {{ closes: hand = {base}*vec(1, 0) + c*vec(cos(r), sin(r)); }}
            }}"
        );
        assert_eq!(outcome(&text).0, ["w", "s_rate"], "{base} {given}");
        derived(&text, |derived| assert!(derived.model.chosen.is_some(), "{base} {given}"));
    }
}

#[test]
fn large_systems_get_rates_too() {
    let count = 24;
    let names: Vec<String> = (0..count).map(|i| format!("q{i}")).collect();
    let rows = (0..count / 2).map(|i| format!("c{i}: dot(q{}) = 2*dot(q{});", 2 * i + 1, 2 * i));
    let energy: Vec<String> = names.iter().map(|name| format!("dot({name})^2")).collect();
    let text = format!(
        "pub system Ring {{ coordinates {{ {} }} constraints {{ {} }} kinetic_energy = {}; }}",
        names.join(", "),
        rows.collect::<String>(),
        energy.join(" + ")
    );
    let expected: Vec<String> = (0..count / 2).map(|i| format!("q{}_rate", 2 * i)).collect();
    assert_eq!(outcome(&text).0, expected);
}

#[test]
fn scenes_and_outputs_know_the_chosen_names() {
    let text = sled("").replace(
        "forces {",
        "outputs { turn = phi_rate; push = dot(x_rate); }
         scene Turning { track phi_rate; provide turn; }
         forces {",
    );
    derived(&text, |derived| {
        assert_eq!(derived.scenes.len(), 1);
        let report = ReportLines::of(&derived.model, &derived.system).to_text();
        assert!(report.contains("phi_rate and x_rate are chosen by the macro"), "{report}");
    });
}

#[test]
fn what_is_not_chosen_and_what_is_taken_is_said() {
    let text = faults(&sled("").replace("forces {", "forces { c*y_rate along dot(y);"));
    assert!(text.contains("`y_rate` is used in a force and is no parameter"), "{text}");
    assert!(text.contains("the macro chose `phi_rate`, `x_rate`"), "{text}");
    let text = faults(
        &sled("")
            .replace("c >= 0", "c >= 0, x_rate")
            .replace("-c*x_rate along x_rate", "x_rate along dot(x)"),
    );
    assert!(text.contains("the rate of `x` is chosen as a parameter, and `x_rate` is a constant"), "{text}");
    // With as many parameters as are needed the name is as unknown as any.
    let text = faults(&sled("parameters { a = dot(phi); b = dot(x); }"));
    assert!(text.contains("unknown name `phi_rate` in the kinetic energy"), "{text}");
    assert!(text.contains("the rate of `phi` is written `dot(phi)`"), "{text}");
    // Dependent constraints are named, and not what completes them.
    let twice = sled("").replace("constraints {", "constraints { again: dot(y)*cos(phi) = dot(x)*sin(phi);");
    let text = faults(&twice);
    assert!(text.contains("`again`") || text.contains("`blade`"), "{text}");
    assert!(!text.contains("_rate"), "{text}");
    // One fault is one fault.
    let text = faults(&sled("").replace("J/2*phi_rate^2", "J/2*phi_rate^2 + unknown"));
    assert_eq!(text.matches("compile_error").count(), 1, "{text}");
}
