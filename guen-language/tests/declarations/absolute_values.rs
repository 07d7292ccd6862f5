//! Absolute values: at a point modulo p they are one of a number and its opposite, and in a state the other.

use crate::common::{derived, derived_without, evaluated};
use guen_language::derive::{DerivedSystem, function};
use guen_symbolic::SymbolId;

#[test]
fn loads_of_bodies_keep_their_signs() {
    let text = "pub system Bar {
        constants { m > 0, l > 0, I > 0, k > 0, stop }
        coordinates { q }
        let R = rot_z(q);
        bodies { bar { mass: m, inertia: diag(I, I, I), center: R*vec(l, 0, 0), orientation: R } }
        parameters { w = dot(q); }
        potential_energy = k*abs(q^3 - stop);
        forces { -k*abs(w)*w along w; }
    }";
    derived(text, |derived| {
        let graph = &derived.model.bench.graph;
        for (stop, w) in [(-3.0, 0.3), (-3.0, -0.3), (5.0, 0.3), (5.0, -0.3)] {
            let (m, l, inertia, k, q): (f64, f64, f64, f64, f64) = (1.3, 0.7, 0.2, 2.1, 0.9);
            let value = |symbol: SymbolId| match graph.symbol_info(symbol).name.as_str() {
                "m" => m,
                "l" => l,
                "I" => inertia,
                "k" => k,
                "stop" => stop,
                "q" => q,
                _ => w,
            };
            let rates = evaluated(&derived.system, function::RHS, value).unwrap();
            let slope = 3.0 * k * q * q * (q.powi(3) - stop).signum();
            let expected = (-slope - k * w.abs() * w) / (inertia + m * l * l);
            assert!((rates[1] - expected).abs() < 1e-13, "{rates:?} {expected}");
        }
    });
}

/// Brackets that vanish for one sign of a coordinate or of a constant only: at half of all points modulo p, too.
#[test]
fn brackets_are_seen_for_both_signs() {
    let growth = |coefficient: &str| {
        let text = format!(
            "pub system Ramp {{
                constants {{ a }}
                coordinates {{ x, y, z }}
                parameters {{ p = dot(x); q = dot(y); }}
                kinetic_energy = dot(x)^2 + dot(y)^2 + dot(z)^2 + a*0;
                constraints {{ c: dot(z) = ({coefficient})*dot(y); }}
            }}"
        );
        derived(&text, |derived| derived.system.derivation.closure.growth.clone())
    };
    for coefficient in [
        "abs(x) - x",
        "abs(x) + x",
        "(abs(a) - a)*x",
        "(sqrt(a^2) - a)*x",
        "(1 - sign(a))*x",
        "sqrt(1 - cos(x)^2) - sin(x)",
        "max(0, x)",
        "x*abs(x)",
    ] {
        assert_eq!(growth(coefficient), [2, 3], "{coefficient}");
    }
    assert_eq!(growth("y*abs(y) - abs(a)"), [2]);
}

/// A second level of brackets that vanishes where a coordinate is positive.
#[test]
fn brackets_of_brackets_are_seen_for_both_signs() {
    let growth = |coefficient: &str| {
        let text = format!(
            "pub system Levels {{
                coordinates {{ x, y, z, w }}
                parameters {{ p = dot(x); q = dot(y); }}
                kinetic_energy = dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(w)^2;
                constraints {{ c: dot(z) = x*dot(y); d: dot(w) = ({coefficient})*dot(y); }}
            }}"
        );
        derived(&text, |derived| derived.system.derivation.closure.growth.clone())
    };
    assert_eq!(growth("x^2"), [2, 3, 4]);
    assert_eq!(growth("x*(abs(x) - x)"), [2, 3, 4]);
    // [X1, X2] is X3 + x^2 X4 for one sign of y and X3 for the other; y is constant along X1.
    assert_eq!(growth("(abs(y) - y)*x^3"), [2, 3, 4]);
    assert_eq!(growth("abs(y)*0"), [2, 3]);
}

/// Energies and constraints that have no velocity for one sign of a constant.
#[test]
fn energies_and_constraints_for_one_sign_of_a_constant_are_accepted() {
    let text = |factor: &str, constraint: &str| {
        format!(
            "pub system One {{
                constants {{ a = -2 }}
                coordinates {{ x, y }}
                parameters {{ u = dot(y); {} }}
                kinetic_energy = dot(x)^2*({factor}) + dot(y)^2 + a*0;
                {constraint}
            }}",
            if constraint.is_empty() { "v = dot(x);" } else { "" }
        )
    };
    for text in [
        text("abs(a) - a", ""),
        text("1", "constraints { c: (sqrt(a^2) - a)*dot(x) = 0; }"),
        text("1", "constraints { c: (abs(a) - a)*dot(x) = dot(y); }"),
    ] {
        derived(&text, |derived| assert_eq!(derived.system.derivation.closure.growth.len(), 1, "{text}"));
    }
}

/// `sqrt(x^2)` is `x` near the rest position and may be `-x` far away, as with an absolute value.
#[test]
fn roots_of_squares_keep_their_signs() {
    let half = |q: f64| (q / 2.0).cos();
    let loads: [(&str, &dyn Fn(f64) -> f64); 16] = [
        ("sqrt(cos(q)^2) + cos(q)", &|q| q.cos().abs() + q.cos()),
        ("sqrt(1 - sin(q)^2) + cos(q)", &|q| q.cos().abs() + q.cos()),
        ("(cos(q)^2)^(3/2) + cos(q)^3", &|q| q.cos().abs().powi(3) + q.cos().powi(3)),
        ("sqrt(2 + 2*cos(q)) + 2*cos(q/2)", &|q| 2.0 * half(q).abs() + 2.0 * half(q)),
        ("norm(vec(cos(q) - 1, sin(q), 0)) + 2*sin(q/2)", &|q| {
            2.0 * (q / 2.0).sin().abs() + 2.0 * (q / 2.0).sin()
        }),
        ("sqrt(1 + sin(2*q)) - cos(q)", &|q| (q.sin() + q.cos()).abs() - q.cos()),
        ("sqrt((q - 3)^2) + q", &|q| (q - 3.0).abs() + q),
        ("sqrt((q + 1000)^2) + q", &|q| (q + 1000.0).abs() + q),
        ("((q - 2)^4)^(1/4) + q", &|q| (q - 2.0).abs() + q),
        ("sqrt(q^2*p^2) + q*p", &|q| (0.3 * q).abs() + 0.3 * q),
        // A root that is a product with another root.
        ("sqrt((q - 3)^2*(1 + q^2)) + q*sqrt(1 + q^2)", &|q| ((q - 3.0).abs() + q) * (1.0 + q * q).sqrt()),
        ("sqrt((m - 7)^2*(1 + q^2)) + m*sqrt(1 + q^2)", &|q| 7.0 * (1.0 + q * q).sqrt()),
        ("sqrt(tanh(q)^2) + tanh(q)", &|q| q.tanh().abs() + q.tanh()),
        ("sqrt(cosh(q)^2 - 1) - sinh(q)", &|q| q.sinh().abs() - q.sinh()),
        ("sqrt((exp(q) - 50)^2) + exp(q)", &|q| (q.exp() - 50.0).abs() + q.exp()),
        ("unit(vec(tanh(q), 0, 0)).x", &f64::signum),
    ];
    for (load, expected) in loads {
        let text = format!(
            "pub system Bar {{
                constants {{ m > 0, l > 0, I > 0 }}
                coordinates {{ q, p }}
                let R = rot_z(q);
                bodies {{
                    bar {{ mass: m, inertia: diag(I, I, I), center: R*vec(l, 0, 0), orientation: R }}
                    end {{ mass: m, inertia: diag(I, I, I), center: vec(0, 0, 0), orientation: rot_x(p) }}
                }}
                parameters {{ w = dot(q); v = dot(p); }}
                forces {{ {load} along w; }}
            }}"
        );
        let compare = |derived: &DerivedSystem<'_>| {
            let graph = &derived.model.bench.graph;
            for at in [0.7, -0.7, 2.9, -2.2, 5.1, -1500.3] {
                let value = |symbol: SymbolId| match graph.symbol_info(symbol).name.as_str() {
                    "m" => 1.3,
                    "l" => 0.7,
                    "I" => 0.2,
                    "q" => at,
                    _ => 0.3,
                };
                let rate = evaluated(&derived.system, function::RHS, value).unwrap()[2];
                let expected = expected(at) / (0.2 + 1.3 * 0.7 * 0.7);
                if expected.is_finite() {
                    let error = (rate - expected).abs();
                    assert!(
                        error < 1e-10 * expected.abs().max(1.0),
                        "{load} at {at}: {rate}, not {expected}"
                    );
                }
            }
        };
        derived(&text, compare);
        derived_without(&text, |name| name != "bodies", compare);
    }
}
