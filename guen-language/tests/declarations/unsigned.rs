//! Constants of which nothing is promised: without which nothing has inertia may be divided by, whatever its sign is; a mass
//! that may be zero or negative may not.

use crate::common::{derived, evaluated};
use guen_language::derive::{DerivedSystem, function};
use guen_language::report::ReportLines;
use guen_symbolic::{SymbolId, evaluate_f64};

/// Particles on massless links, in absolute angles.
fn chain(constants: &str, masses: [&str; 5]) -> String {
    let list = |entry: &dyn Fn(usize) -> String| (1..=5).map(entry).collect::<Vec<_>>().join(" ");
    format!(
        "pub system Chain {{
            constants {{ {constants}, g = 9.81 }}
            coordinates {{ q1, q2, q3, q4, q5 }}
            let p0 = vec(0, 0);
            {}
            parameters {{ {} }}
            particles {{ {} }}
            gravity = vec(0, -g);
        }}",
        list(&|i| format!("let p{i} = p{} + l*vec(sin(q{i}), -cos(q{i}));", i - 1)),
        list(&|i| format!("w{i} = dot(q{i});")),
        list(&|i| format!("{} at p{i};", masses[i - 1])),
    )
}

/// The operations of the right-hand side.
fn operations(text: &str) -> u32 {
    derived(text, |derived| {
        let mut functions = derived.system.programs.functions.iter();
        functions.find(|own| own.name == function::RHS).unwrap().cost.operations()
    })
}

/// What is left of the equations of motion with the rates of the program, relative to the forces in them.
fn residual(derived: &DerivedSystem<'_>, constants: &[(&str, f64)]) -> f64 {
    let graph = &derived.model.bench.graph;
    let value = |symbol: SymbolId| {
        let name = &graph.symbol_info(symbol).name;
        let place = 1.0 + name.bytes().map(f64::from).sum::<f64>();
        let known = constants.iter().find(|(known, _)| known == name).map(|(_, value)| *value);
        known.unwrap_or((7.3 * place).sin())
    };
    let rates = evaluated(&derived.system, function::RHS, value).unwrap();
    let equations = &derived.system.derivation.equations;
    let forces = evaluate_f64(graph, &equations.forces, &value);
    let mut worst: f64 = 0.0;
    for (row, force) in equations.mass.iter().zip(&forces) {
        let row = evaluate_f64(graph, row, &value);
        let inertia: f64 = row.iter().zip(&rates[5..]).map(|(m, rate)| m * rate).sum();
        worst = worst.max((inertia - force).abs() / (1.0 + force.abs()));
    }
    worst
}

/// The constants that `prepare` wants to differ from zero.
fn pivots(derived: &DerivedSystem<'_>) -> Vec<String> {
    let graph = &derived.model.bench.graph;
    derived.system.constant_pivots.iter().map(|e| graph.text(*e)).collect()
}

#[test]
fn one_mass_needs_no_sign() {
    let unsigned = chain("m, l", ["m"; 5]);
    assert_eq!(operations(&unsigned), operations(&chain("m > 0, l > 0", ["m"; 5])));
    derived(&unsigned, |derived| {
        assert_eq!(pivots(derived), ["m", "l"]);
        for [m, l] in [[1.5, 0.4], [-1.5, 0.4], [1.5, -0.4]] {
            let residual = residual(derived, &[("m", m), ("l", l), ("g", 9.81)]);
            assert!(residual < 1e-12, "{m} {l}: {residual:e}");
        }
    });
}

#[test]
fn a_mass_that_may_be_zero_is_no_divisor() {
    derived(&chain("a, b, c, d, e, l", ["a", "b", "c", "d", "e"]), |derived| {
        // Without the last particle the last link has no inertia.
        assert_eq!(pivots(derived), ["e", "l"]);
        for c in [0.7, 0.0, -0.1] {
            let masses = [("a", 1.0), ("b", 0.5), ("c", c), ("d", 0.8), ("e", 1.2)];
            let constants: Vec<_> = masses.into_iter().chain([("l", 0.4), ("g", 9.81)]).collect();
            let residual = residual(derived, &constants);
            assert!(residual < 1e-11, "{c}: {residual:e}");
        }
    });
}

/// Two masses of which neither is known to have the sign of the other.
#[test]
fn masses_of_unknown_signs_are_not_taken_for_those_of_one_sign() {
    derived(&chain("m, M > 0, l > 0", ["M", "M", "M", "M", "m"]), |derived| {
        for m in [0.6, -0.05] {
            let constants = [("m", m), ("M", 1.1), ("l", 0.4), ("g", 9.81)];
            let residual = residual(derived, &constants);
            assert!(residual < 1e-11, "{m}: {residual:e}");
        }
        assert!(!derived.system.derivation.is_by("constraint forces"));
    });
}

/// A length that vanishes leaves the inertia of the body: neither is divided by.
#[test]
fn what_has_inertia_otherwise_is_no_divisor() {
    let text = "pub system Pendulum {
        constants { m, l, I, g = 9.81 }
        coordinates { phi }
        bodies { rod { mass: m, inertia: diag(0, 0, I), center: l*rot_z(phi).x, orientation: rot_z(phi) } }
        gravity = vec(0, -g, 0);
        parameters { w = dot(phi); }
    }";
    derived(text, |derived| assert_eq!(pivots(derived), ["I + m*l^2"]));
}

/// Of parts side by side each constant changes some entries of the mass matrix: a mass on a cart, the inertia of a ball that rolls, what
/// two velocities have between them. Without the mass of a cart or of a ball there is inertia enough.
#[test]
fn constants_of_parts_side_by_side_are_looked_at_one_by_one() {
    let text = "pub system Parts {
        count n = 3;
        constants { M[n], m[n], l[n], A, I, r > 0, c, k, g = 9.81 }
        coordinates { x[n], q[n], qw, qx, qy, qz, X, Y, u, v, w }
        for i in 0..n {
            let cart[i] = vec(x[i], i, 0);
            let bob[i] = cart[i] + l[i]*vec(sin(q[i]), 0, -cos(q[i]));
        }
        let turn = quaternion(qw, qx, qy, qz);
        let p = vec(X, Y, r);
        holonomic { length: qw^2 + qx^2 + qy^2 + qz^2 = 1; }
        particles { for i in 0..n { M[i] at cart[i]; m[i] at bob[i]; } }
        bodies { ball { mass: A, inertia: diag(I, I, I), center: p, orientation: turn } }
        parameters { spin = angular_velocity(turn); }
        constraints {
            roll_x: ball.velocity_at(p - vec(0, 0, r)).x = 0;
            roll_y: ball.velocity_at(p - vec(0, 0, r)).y = 0;
        }
        kinetic_energy = (dot(u) + w*dot(v))^2/2 + c*w*dot(u)*dot(v) + dot(w)^2/2;
        potential_energy = k/2*inner(p - bob[0], p - bob[0]) + sum(i in 1..n: k/2*inner(bob[i] - bob[i-1], bob[i] - bob[i-1]));
        gravity = vec(0, 0, -g);
    }";
    derived(text, |derived| {
        let graph = &derived.model.bench.graph;
        let is_refused = |zero: SymbolId| {
            let value =
                |symbol: SymbolId| if symbol == zero { 0.0 } else { (7.3 * symbol.index() as f64).sin() };
            evaluate_f64(graph, &derived.system.constant_pivots, &value).contains(&0.0)
        };
        let constants = derived.model.constants.iter();
        let refused = constants.filter(|entry| is_refused(graph.as_symbol(entry.symbol).unwrap()));
        let refused: Vec<&str> = refused.map(|entry| entry.name.text.as_str()).collect();
        assert_eq!(refused, ["m[0]", "m[1]", "m[2]", "l[0]", "l[1]", "l[2]", "I", "c"]);
    });
}

/// A gear between two discs that roll: by its ratio a pivot that depends on the headings vanishes at all of them.
#[test]
fn constant_factors_of_pivots_are_not_zero() {
    let text = "pub system Discs {
        constants { m > 0, I > 0, r > 0, e }
        coordinates { x, y, z, h, s }
        constraints {
            roll_x: dot(x) = r*cos(h)*dot(s);
            gear: dot(y) = e*cos(h)*dot(x);
            lift: dot(z) = e*cos(h)*dot(y);
        }
        parameters { turn = dot(h); up = dot(z); }
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2 + dot(z)^2) + I/2*(dot(h)^2 + dot(s)^2);
    }";
    derived(text, |derived| assert_eq!(pivots(derived), ["e"]));
}

/// Where a bound would save operations the report says which, and how many: as many as the declaration with that bound has less.
#[test]
fn a_bound_that_saves_operations_is_told() {
    let linked = |constants: &str| {
        format!(
            "pub system Linked {{
                constants {{ {constants} }}
                coordinates {{ x, y, q, r }}
                parameters {{ u = dot(x)*cos(q) + dot(y)*sin(q); }}
                constraints {{
                    one: -dot(x)*sin(q) + dot(y)*cos(q) + a*dot(q) = 0;
                    two: c*dot(r) - dot(x)*cos(r) = 0;
                    three: a*dot(r) + sin(r)*dot(q) - dot(y) = 0;
                }}
                kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + I/2*(dot(q)^2 + dot(r)^2);
            }}"
        )
    };
    let costs = |constants: &str| {
        derived(&linked(constants), |derived| {
            let report = ReportLines::of(&derived.model, &derived.system);
            let lines = report.sections.into_iter().find(|section| section.title == "Cost").unwrap().text;
            (lines.iter().any(|line| line.starts_with("declare")), lines)
        })
    };
    let all = |constants: &str| {
        let (_, lines) = costs(constants);
        let count = lines[0].strip_prefix("right-hand side: ").unwrap().split(' ').next().unwrap();
        count.parse::<u32>().unwrap()
    };
    let (is_told, lines) = costs("m > 0, I > 0, a > 0, c");
    let saved = all("m > 0, I > 0, a > 0, c") - all("m > 0, I > 0, a > 0, c != 0");
    assert!(is_told && saved > 3, "{lines:?}");
    assert_eq!(lines.last().unwrap(), &format!("declare `c != 0`: {saved} operations less"));
    // Nothing is said of others, which cost as much without a bound, nor of a bound that is there.
    assert!(!costs("m, I, a > 0, c > 0").0);
}

/// The operators divide by the lengths, whose signs nobody has to promise: velocities that follow from one another may, too.
#[test]
fn a_trailer_of_unsigned_lengths_costs_what_one_of_positive_lengths_does() {
    let text = "pub system CarWithTrailer {
            constants   { m > 0, I > 0, l > 0, d > 0, k > 0 }
            inputs      { push, steering }
            coordinates { x, y, theta, beta, phi }
            let C = rot_z(theta);
            let T = rot_z(beta);
            let F = C*rot_z(phi);
            let rear = vec(x, y);
            let axle = rear - k*C.x - d*T.x;
            bodies {
                car     { mass: m, inertia: diag(0, 0, I), center: rear + l/2*C.x, orientation: C }
                wheels  { inertia: diag(0, 0, I/20), orientation: F }
                trailer { mass: m/2, inertia: diag(0, 0, I/2), center: axle, orientation: T }
            }
            parameters { speed = inner(C.x, dot(rear)); steer = dot(phi); }
            constraints {
                rear_axle:    inner(C.y, car.velocity_at(rear)) = 0;
                front_axle:   inner(F.y, car.velocity_at(rear + l*C.x)) = 0;
                trailer_axle: inner(T.y, trailer.velocity_at(axle)) = 0;
            }
            forces {
                push along speed;
                vec(0, 0, steering) along wheels.angular_velocity - car.angular_velocity;
            }
            outputs { hitch = beta - theta; }
        }";
    assert_eq!(operations(&text.replace(" > 0", "")), operations(text));
}
