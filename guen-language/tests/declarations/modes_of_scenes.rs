//! Modes of scenes that run through several: their rates by the elimination of smooth systems.

use crate::common::derived;
use guen_language::derive::DerivedLevel;
use guen_language::derive::function::{FREE_MOTION, RHS, mode_rates};

fn operations(level: &DerivedLevel, name: &str) -> u32 {
    let cost = level.program(name).expect("a program").cost;
    cost.operations() + cost.calls + cost.sines
}

/// A system by its contacts and its scene, and the same with the rows of a mode as constraints.
struct Pair {
    contacts: String,
    by_hand: String,
}

fn wheel() -> Pair {
    let system = |forms: &str, rest: &str| {
        format!(
            "system Wheel {{
                constants {{ m > 0, a > 0, J > 0, c >= 0, g = 9.81, mu >= 0 }}
                inputs {{ torque }}
                coordinates {{ x, z, phi }}
                bodies {{ wheel {{ mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) }} }}
                gravity = vec(0, -g);
                {forms}
                forces {{ torque along dot(phi); -c*dot(x) along dot(x); }}
                let p = vec(x, z - a);
                {rest}
            }}"
        )
    };
    Pair {
        contacts: system(
            "parameters { ahead = dot(x); up = dot(z); spin = dot(phi); }",
            "contacts { tyre: gap = z - a, slip = wheel.velocity_at(p).x, friction = mu; }
             scene Through { modes { tyre: stick, slip; } track ahead; }",
        ),
        by_hand: system(
            "parameters { ahead = dot(x); }",
            "holonomic { touches: z - a = 0; } constraints { rolls: wheel.velocity_at(p).x = 0; } scene Through { track ahead; }",
        ),
    }
}

fn hoop() -> Pair {
    let system = |forms: &str, rest: &str| {
        format!(
            "system Hoop {{
                constants {{ a > 0, A > 0, C > 0, g = 9.81, mu >= 0 }}
                coordinates {{ theta, psi, phi, xi, eta, zeta }}
                let slip_x = dot(xi) - a*sin(theta)*sin(psi)*dot(theta) + a*cos(theta)*cos(psi)*dot(psi) + a*cos(psi)*dot(phi);
                let slip_y = dot(eta) + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi);
                parameters {{ eta1 = dot(theta); eta2 = dot(psi)*sin(theta); eta3 = dot(psi)*cos(theta) + dot(phi); {forms} }}
                kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
                force_function = -g*zeta;
                {rest}
            }}"
        )
    };
    Pair {
        contacts: system(
            "u = dot(xi); v = dot(eta); w = dot(zeta);",
            "contacts { floor: gap = zeta - a*sin(theta), slip = vec(slip_x, slip_y), friction = mu; }
             scene Through { modes { floor: stick, open; } }",
        ),
        by_hand: system("", "").replace(
            "kinetic_energy",
            "holonomic { touches: zeta - a*sin(theta) = 0; } constraints { one: slip_x = 0; two: slip_y = 0; } kinetic_energy",
        ) ,
    }
}

/// A leg of two links on its foot.
fn leg() -> Pair {
    let system = |forms: &str, rest: &str| {
        format!(
            "system Leg {{
                constants {{ m > 0, M > 0, l > 0, g = 9.81, mu >= 0 }}
                inputs {{ knee }}
                coordinates {{ x, z, p, q }}
                let hip = vec(x, z);
                let middle = hip + l*vec(sin(p), -cos(p));
                let foot = middle + l*vec(sin(q), -cos(q));
                particles {{ M at hip; m at middle; m/2 at foot; }}
                gravity = vec(0, -g);
                {forms}
                forces {{ knee along dot(p) - dot(q); }}
                {rest}
            }}"
        )
    };
    Pair {
        contacts: system(
            "parameters { u = dot(x); w = dot(z); a = dot(p); b = dot(q); }",
            "contacts { sole: gap = foot.y, slip = dot(foot).x, friction = mu; }
             scene Through { modes { sole: stick, slip; } track p, q; }",
        ),
        by_hand: system(
            "parameters { a = dot(p); b = dot(q); }",
            "holonomic { touches: foot.y = 0; } constraints { holds: dot(foot).x = 0; } scene Through { track p, q; }",
        ),
    }
}

/// A mode by itself takes what the constrained system takes, and what the rates of the parameters take that follow there: one operation of
/// the wheel, which has three. The common program gives no rates yet: the solve of the mode's rows comes to it.
#[test]
fn modes_that_stick_cost_little_more_than_constrained_systems() {
    for (Pair { contacts, by_hand }, most) in [(wheel(), 4), (hoop(), 33), (leg(), 40)] {
        let expected =
            derived(&by_hand, |derived| operations(derived.scenes.first().unwrap_or(&derived.system), RHS));
        derived(&contacts, |derived| {
            let level = &derived.scenes[0];
            let (own, common) = (operations(level, &mode_rates(0)), operations(level, FREE_MOTION));
            assert!(expected <= own && own <= most && own < common, "{expected} {own} {common}");
            assert!(own == expected + 1 || 10 * own <= 13 * expected, "{expected} {own}");
        });
    }
}

/// A slip along a line takes what the scene in that mode alone takes, and the rates of what follows.
#[test]
fn modes_that_slip_cost_little_more_than_scenes_in_one_mode() {
    for (Pair { contacts, .. }, contact) in [(wheel(), "tyre"), (leg(), "sole")] {
        let in_mode = |direction| {
            let one =
                contacts.replace(&format!("{contact}: stick, slip;"), &format!("{contact}: {direction};"));
            derived(&one, |derived| {
                let (_, system) = &derived.in_modes[0];
                operations(system.scenes.first().unwrap_or(&system.system), RHS)
            })
        };
        let expected = [in_mode("slip+"), in_mode("slip-")];
        derived(&contacts, |derived| {
            let level = &derived.scenes[0];
            assert_eq!(level.contacts.as_ref().unwrap().eliminated, [0, 1, 2]);
            for (place, expected) in [1, 2].into_iter().zip(expected) {
                let own = operations(level, &mode_rates(place));
                assert!(own <= expected + 2 || 10 * own <= 13 * expected, "{expected} {own}");
            }
        });
    }
}
