//! States beside the motion: their rates, what may depend on them, and what scenes keep of them.

use guen_language::derive::{DerivedSystem, function};
use guen_language::report::ReportLines;
use guen_symbolic::SymbolId;

use crate::common::{derived, evaluated, fault_messages};

/// A pendulum that a motor swings; a filter sees its acceleration, and an integrator the error of the angle.
pub const MOTOR: &str = "pub system Motor {
    constants { m > 0, l > 0, R > 0, L > 0, k > 0, tau > 0, g = 9.81 }
    inputs { voltage, wanted }
    coordinates { phi }
    parameters { omega = dot(phi); }
    let torque = k*current - heat*omega;
    states {
        dot(current) = (voltage - R*current - k*omega)/L;
        dot(error) = phi - wanted - bias;
        dot(bias) = 0;
        dot(seen) = (l*dot(omega) - seen)/tau;
        dot(heat) = current*torque/10 + dot(current)/7;
    }
    kinetic_energy = m/2*l^2*omega^2;
    force_function = -m*g*l*sin(phi);
    forces { torque - error along omega; }
    outputs { slope = dot(current); jolt = dot(seen*phi); power = dot(heat)*t; }
    scene Electric { track current; fix bias; provide power; }
    scene Angle { track seen; provide linearization; }
    scene Whole { track error, heat; provide taylor, carried, energy; }
}";

fn at(derived: &DerivedSystem<'_>, known: &[(&str, f64)]) -> impl Fn(SymbolId) -> f64 {
    let graph = &derived.model.bench.graph;
    let names: Vec<String> = graph.symbols().map(|s| graph.symbol_info(s).name.clone()).collect();
    let known: Vec<(String, f64)> = known.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    move |symbol| {
        let name = &names[symbol.index()];
        known.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("{name}")).1
    }
}

#[test]
fn rates_are_those_written() {
    derived(MOTOR, |derived| {
        let names = [
            "m", "l", "R", "L", "k", "tau", "g", "voltage", "wanted", "phi", "omega", "current", "error",
            "bias", "seen", "heat", "t",
        ];
        let values = [1.3, 0.7, 2.1, 0.4, 0.9, 0.3, 9.81, 5.0, 0.2, 0.6, 1.7, 0.8, -0.3, 0.05, 2.2, 0.5, 0.9];
        let known: Vec<(&str, f64)> = names.into_iter().zip(values).collect();
        let [
            m,
            l,
            r,
            inductance,
            k,
            tau,
            g,
            voltage,
            wanted,
            phi,
            omega,
            current,
            error,
            bias,
            seen,
            heat,
            t,
        ] = values;
        let found = evaluated(&derived.system, function::RHS, at(derived, &known)).unwrap();
        let torque = k * current - heat * omega;
        let acceleration = (torque - error - m * g * l * phi.cos()) / (m * l * l);
        let slope = (voltage - r * current - k * omega) / inductance;
        let heating = current * torque / 10.0 + slope / 7.0;
        let filtered = (l * acceleration - seen) / tau;
        let expected = [omega, acceleration, slope, phi - wanted - bias, 0.0, filtered, heating];
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() < 1e-12, "{found:?} {expected:?}");
        }
        let outputs = evaluated(&derived.system, function::OUTPUTS, at(derived, &known)).unwrap();
        for (a, b) in outputs.iter().zip([slope, filtered * phi + seen * omega, heating * t]) {
            assert!((a - b).abs() < 1e-12, "{outputs:?}");
        }
        assert!(!derived.system.derivation.conservative);
    });
}

/// The weighted cost of a declaration's right-hand side.
fn cost(text: &str) -> u64 {
    derived(text, |derived| derived.system.program(function::RHS).map_or(0, |rhs| rhs.cost.weighted()))
}

/// States that act on nothing leave the rest as it is, and share with it what they have in common.
#[test]
fn a_state_costs_its_own_expression() {
    let hoop = |states: &str| {
        format!(
            "pub system Hoop {{
                constants {{ a > 0, A > 0, C > 0, g = 9.81, k }}
                coordinates {{ theta, psi, phi, xi, eta, zeta }}
                parameters {{
                    eta1 = dot(theta);
                    eta2 = dot(psi)*sin(theta);
                    eta3 = dot(psi)*cos(theta) + dot(phi);
                }}
                constraints {{
                    eta4: dot(xi) = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
                    eta5: dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
                    eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
                }}
                states {{ {states} }}
                kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
                force_function = -a*g*sin(theta);
                outputs {{ seen = k*theta; }}
            }}"
        )
    };
    let bare = cost(&hoop(""));
    // Of rates and velocities that are there anyway; then a product, a sum, an acceleration with its sign, and a sine that is known.
    let further = [
        ("dot(way) = dot(xi);", 0),
        ("dot(turned) = eta3;", 0),
        ("dot(lag) = k*lag;", 1),
        ("dot(lag) = theta - lag;", 1),
        ("dot(seen_rate) = dot(eta1) - seen_rate;", 2),
        ("dot(lag) = sin(theta)*lag;", 1),
        ("dot(one) = k*(theta - one); dot(two) = k*(one - two);", 4),
    ];
    for (states, more) in further {
        assert_eq!(cost(&hoop(states)), bare + more, "{states}");
    }
}

#[test]
fn scenes_leave_states_that_act_on_nothing() {
    derived(MOTOR, |derived| {
        let kept = |scene: usize| {
            let names: Vec<&str> = derived.scenes[scene]
                .selection
                .variables
                .iter()
                .map(|place| derived.model.variable_name(*place))
                .collect();
            names.join(" ")
        };
        assert_eq!(
            [kept(0), kept(1), kept(2)],
            [
                "phi omega current error heat",
                "phi omega current error bias seen heat",
                "phi omega current error bias heat",
            ]
        );
        let report = ReportLines::of(&derived.model, &derived.scenes[0]).to_text();
        assert!(
            report.contains("bias: its rate vanishes identically, and it is a constant here"),
            "{report}"
        );
        assert!(report.contains("error' = -bias + phi - wanted"), "{report}");
    });
}

/// A ladder of filters in a loop is the ladder that is written out, and costs what it costs.
#[test]
fn loops_declare_states() {
    let system = |states: &str, last: &str| {
        format!(
            "pub system Ladder {{
                count n = 4;
                constants {{ m > 0, k > 0 }}
                coordinates {{ x }}
                parameters {{ v = dot(x); }}
                states {{ {states} }}
                kinetic_energy = m/2*v^2;
                forces {{ -k*{last} along v; }}
                outputs {{ slope = dot({last}); }}
                scene Two {{ track {last}; provide slope; }}
            }}"
        )
    };
    let looped = system(
        "dot(z[0]) = x - z[0]; for i in 1..n { if i < 2 { dot(z[i]) = k*(z[i-1] - z[i]); } else { dot(z[i]) = z[i-1] - sum(j in 0..i: 1)*z[i]; } }",
        "z[n-1]",
    );
    let written = system("dot(a) = x - a; dot(b) = k*(a - b); dot(c) = b - 2*c; dot(d) = c - 3*d;", "d");
    let rates = |text: &str| {
        derived(text, |derived| {
            let names: Vec<String> =
                (0..6).map(|place| derived.model.variable_name(place).to_owned()).collect();
            let values = [0.3, -1.2, 0.7, 0.4, -0.9, 1.6];
            let mut known: Vec<(&str, f64)> = names.iter().map(|name| &name[..]).zip(values).collect();
            known.extend([("m", 1.3), ("k", 0.8)]);
            let levels = [&derived.system, &derived.scenes[0]];
            levels.map(|level| {
                let slope = evaluated(level, function::OUTPUTS, at(derived, &known)).unwrap();
                [evaluated(level, function::RHS, at(derived, &known)).unwrap(), slope].concat()
            })
        })
    };
    assert_eq!(rates(&looped), rates(&written));
    assert_eq!(cost(&looped), cost(&written));
    derived(&looped, |derived| {
        assert_eq!(derived.model.variable_name(5), "z[3]");
        let report = ReportLines::of(&derived.model, &derived.system).to_text();
        assert!(report.contains("z[1]' = "), "{report}");
    });
}

#[test]
fn an_instance_that_is_tracked_keeps_its_states() {
    let text = "system Filtered {
        component Filter(v: scalar) { states { dot(y) = v - y; } }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = v^2;
        use Filter as filter { v }
        scene Slow { track filter; }
    }";
    derived(text, |derived| assert_eq!(derived.scenes[0].selection.variables.len(), 2));
}

#[test]
fn a_rate_with_a_fault_is_declared() {
    let faults = fault_messages(
        "pub system S { coordinates { x } kinetic_energy = dot(x)^2; states { dot(a) = dot(b) + nothing; dot(b) = 1; } forces { a + b along x_rate; } outputs { o = dot(a); } }",
    );
    assert_eq!(
        faults,
        ["the rate of `b` is used before it is declared", "unknown name `nothing` in the rate of state `a`"]
    );
}
