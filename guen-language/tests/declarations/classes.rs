//! Classes, growth and integrable combinations where coefficients jump, and where positions are bound by equations that nothing solves.

use crate::common::derived;
use guen_symbolic::Class;

/// A coefficient is constant between the places where it jumps, and another constant beyond them.
#[test]
fn coefficients_that_jump_are_no_constants() {
    let class = |coefficient: &str, held: &str| {
        let text = format!(
            "pub system Ramp {{
                constants {{ a }}
                coordinates {{ x, y, z, w }}
                kinetic_energy = dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(w)^2 + a*0;
                constraints {{ c: dot(z) = ({coefficient})*dot(y); }}
                holonomic {{ h: w = {held}; }}
            }}"
        );
        derived(&text, |derived| derived.system.derivation.class)
    };
    for held in ["x", "0"] {
        for coefficient in ["abs(x)", "a*max(x, 0)", "clamp(x, -1, 1)", "x*abs(a*x)/x"] {
            assert_eq!(class(coefficient, held), Class::Nonholonomic, "{coefficient} {held}");
        }
        // The branches agree, or differ by constants of the system alone.
        for coefficient in
            ["a*x", "abs(a)*x", "max(a, 0)*x", "x*(asin(x) + acos(x))", "max(x, y) + min(x, y)"]
        {
            assert_eq!(class(coefficient, held), Class::IncompleteLieGroup, "{coefficient} {held}");
        }
    }
    let class = |coefficient: &str| {
        let text = format!(
            "pub system Free {{
                coordinates {{ x, y, z }}
                kinetic_energy = dot(x)^2 + dot(y)^2 + dot(z)^2;
                constraints {{ c: dot(z) = ({coefficient})*dot(y); }}
            }}"
        );
        derived(&text, |derived| derived.system.derivation.class)
    };
    for coefficient in ["sqrt(x^2)", "x*(atan(x) + atan(1/x))"] {
        assert_eq!(class(coefficient), Class::Nonholonomic, "{coefficient}");
    }
}

/// Equations that no points modulo the prime satisfy, beside rows that are known to be integrable or not.
#[test]
fn brackets_are_followed_where_no_equation_is_solved() {
    let equations = [
        "norm(vec(x, y) - vec(1, 0)) + norm(vec(x, y) + vec(1, 0)) = l",
        "x + sin(x) = y + 3/10*sin(y)",
        "x^3 + y^3 = l",
        "sin(x)*sin(y) = 1/3",
        "cosh(x)*cos(y) = 1",
    ];
    for equation in equations {
        let closure = |rows: &str| {
            let text = format!(
                "pub system Bead {{
                    constants {{ l > 0 }}
                    coordinates {{ x, y, u, v, w }}
                    kinetic_energy = dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(v)^2 + dot(w)^2 + l*0;
                    holonomic {{ h: {equation}; }}
                    constraints {{ {rows} }}
                }}"
            );
            derived(&text, |derived| {
                let closure = &derived.system.derivation.closure;
                assert!(closure.complete, "{text}");
                (closure.growth.clone(), closure.integrable.len())
            })
        };
        assert_eq!(closure("c: dot(w) = u*dot(v);"), ([3, 4].into(), 1), "{equation}");
        assert_eq!(
            closure("c: dot(v) = u*dot(x); d: dot(w) = v*dot(x);"),
            ([2, 3, 4].into(), 1),
            "{equation}"
        );
        // u exp(y) = w + constant.
        assert_eq!(closure("c: dot(w) = exp(y)*(dot(u) + u*dot(y));"), ([3].into(), 2), "{equation}");
        // The difference of the rows is integrable.
        let rows = "c: dot(v) = u*dot(x) + sin(v)*dot(v); d: dot(w) = u*dot(x);";
        assert_eq!(closure(rows), ([2, 3].into(), 2), "{equation}");
    }
}

/// A vehicle that carries a closed loop of four bars in space, whose coupler has a quaternion.
#[test]
fn a_loop_on_wheels_is_nonholonomic() {
    let text = "pub system Carried {
        constants { m > 0, l > 0 }
        coordinates { p, q, h, a, b, q0, q1, q2, q3, x, y, z }
        let base = vec(p, q, 0);
        let B = rot_z(h);
        let C = quaternion(q0, q1, q2, q3);
        let first = base + B*vec(1/2*cos(a), 1/2*sin(a), 0);
        let second = base + B*(vec(2, 3/10, 0) + rot_x(1/2)*vec(0, 4/5*cos(b), 4/5*sin(b)));
        let center = base + B*vec(x, y, z);
        bodies {
            coupler { mass: m, inertia: diag(1, 2, 3), center: center, orientation: C }
            base_body { mass: m, inertia: diag(1, 2, 3), center: base, orientation: B }
        }
        holonomic {
            one: q0^2 + q1^2 + q2^2 + q3^2 = 1;
            hinge: center - C*vec(l/2, 0, 0) = first;
            rod: norm(center + C*vec(l/2, 0, 0) - second)^2 = 1/25;
        }
        constraints { wheels: inner(dot(base), vec(-sin(h), cos(h), 0)) = 0; }
    }";
    derived(text, |derived| {
        let derivation = &derived.system.derivation;
        assert_eq!(derivation.class, Class::Nonholonomic);
        assert_eq!(derivation.closure.growth, [6, 7]);
        assert!(derivation.closure.complete && derivation.closure.integrable.len() == 5);
    });
}

/// Coefficients whose functions are the same only where the positions hold, and at points modulo the prime are not.
#[test]
fn brackets_that_vanish_where_positions_hold_are_none() {
    let closure = |coefficient: &str, equation: &str| {
        let text = format!(
            "pub system Coupled {{
                coordinates {{ a, b, x, y, z }}
                kinetic_energy = dot(a)^2 + dot(b)^2 + dot(x)^2 + dot(y)^2 + dot(z)^2;
                constraints {{ c: dot(z) = ({coefficient})*x*dot(y); }}
                holonomic {{ h: {equation}; }}
            }}"
        );
        derived(&text, |derived| {
            let closure = &derived.system.derivation.closure;
            (closure.growth.clone(), closure.integrable.len(), derived.system.derivation.class)
        })
    };
    for (coefficient, equation) in [
        ("cos(a) - cos(b)", "a = b"),
        ("exp(a) - exp(2*b - a)", "a = b"),
        ("acos(a) + asin(b) - pi/2", "a = b"),
        ("cos(a) - cos(2*b + t)*cos(b) + sin(2*b + t)*sin(b)", "a = 3*b + t"),
    ] {
        assert_eq!(closure(coefficient, equation), ([3].into(), 2, Class::LieGroup), "{coefficient}");
    }
    let (growth, integrable, class) = closure("cos(a) - cos(b)", "a = b + 2*t");
    assert_eq!((growth, integrable, class), ([3, 4].into(), 1, Class::Nonholonomic));
}

/// Forces and loads that vanish only where the positions hold change no energy.
#[test]
fn energy_is_kept_by_what_vanishes_where_positions_hold() {
    let is_conservative = |load: &str| {
        let text = format!(
            "pub system Pushed {{
                coordinates {{ a, b, x }}
                kinetic_energy = dot(a)^2 + dot(b)^2 + dot(x)^2;
                holonomic {{ h: a = b; }}
                {load}
            }}"
        );
        derived(&text, |derived| derived.system.derivation.conservative)
    };
    assert!(is_conservative("forces { (cos(a) - cos(b))*dot(x) along dot(x); }"));
    assert!(is_conservative("force_function = t*(exp(a) - exp(b));"));
    assert!(!is_conservative("forces { (cos(a) - cos(2*b))*dot(x) along dot(x); }"));
}
