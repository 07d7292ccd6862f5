//! Absolute values: at a point modulo p they are one of a number and its opposite, and in a state the other.

use crate::common::{derived, evaluated};
use guen_language::derive::function;
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
