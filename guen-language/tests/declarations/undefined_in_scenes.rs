//! Scenes at whose fixed values a contact, a switch or a reset divides by zero: each part of these is looked at.

use crate::common::fault_messages;

/// The messages about a ball with a contact, a grip, a latch, a switch and a reset, of which one text is replaced by another; with a scene.
fn messages(right: &str, other: &str, scene: &str) -> Vec<String> {
    let text = "system Ball {
        constants { m > 0, g = 9.81, mu >= 0, a, b }
        coordinates { x, z, angle }
        parameters { u = dot(x); w = dot(z); spin = dot(angle); }
        kinetic_energy = m/2*(u^2 + w^2 + spin^2);
        potential_energy = m*g*z;
        states { dot(count) = 0; }
        switches { ice: x - 5; }
        forces { -ice*u along u; }
        contacts {
            floor: gap = z, slip = u + spin, friction = mu, stiction = mu + 1, when = x + 1, restitution = 1/2;
            brake: grip = spin - u, limit = 3;
            bolt:  latch = angle - 1, release = x - 2;
        }
        resets { tick: x - 7 rises, u = -u, count = count + 1; }
        scene S { SCENE }
    }";
    assert_eq!(text.matches(right).count(), 1, "{right}");
    fault_messages(&text.replacen(right, other, 1).replace("SCENE", scene))
}

#[test]
fn every_part_that_divides_by_zero_is_refused() {
    let parts = [
        ("gap = z", "gap = z - 1/a", "floor"),
        ("slip = u + spin", "slip = u + spin/a", "floor"),
        ("friction = mu,", "friction = mu/(1 + 1/a^2),", "floor"),
        ("stiction = mu + 1", "stiction = mu + 1 + 1/a^2", "floor"),
        ("when = x + 1", "when = x + 1/a", "floor"),
        ("restitution = 1/2", "restitution = 1/(2 + 1/a^2)", "floor"),
        ("grip = spin - u", "grip = spin - u/a", "brake"),
        ("limit = 3", "limit = 3 + 1/a^2", "brake"),
        ("latch = angle - 1", "latch = angle - 1/a", "bolt"),
        ("release = x - 2", "release = x - 2/a", "bolt"),
        ("ice: x - 5", "ice: x - 5/a", "ice"),
        ("tick: x - 7", "tick: x - 7/a", "tick"),
        ("u = -u", "u = -u/a", "tick"),
    ];
    for (right, divided, name) in parts {
        let found = messages(right, divided, "fix a = 0; track x;");
        assert_eq!(found, [format!("fixing `a` at this value makes `{name}` divide by zero")], "{divided}");
        assert_eq!(messages(right, divided, "fix a = 2; track x;"), [""; 0], "{divided}");
    }
}

/// A ball that rolls in the only mode of a scene has no friction there, unless a reset makes the scene run through that mode.
#[test]
fn what_a_single_mode_does_not_need_may_divide_by_zero() {
    let of = |tracked: &str| {
        fault_messages(&format!(
            "system Ball {{
                constants {{ m > 0, g = 9.81, mu >= 0, a }}
                coordinates {{ x, z, angle }}
                parameters {{ u = dot(x); w = dot(z); spin = dot(angle); }}
                kinetic_energy = m/2*(u^2 + w^2 + spin^2);
                potential_energy = m*g*z;
                states {{ dot(count) = 0; }}
                contacts {{ floor: gap = z, slip = u + spin, friction = mu/(1 + 1/a^2); }}
                resets {{ tick: x - 7 rises, count = count + 1; }}
                scene S {{ fix a = 0; modes {{ floor: stick; }} track {tracked}; }}
            }}"
        ))
    };
    assert_eq!(of("x"), [""; 0]);
    assert_eq!(of("count"), ["fixing `a` at this value makes `floor` divide by zero"]);
}

#[test]
fn of_several_values_the_one_that_divides_is_named() {
    let of = |scene| messages("limit = 3", "limit = 3 + 1/(a - b)^2", scene);
    // Either value is possible, and both together are not: the last one is named.
    let last = ["fixing `b` at this value makes `brake` divide by zero"];
    assert_eq!(of("fix a = 1; fix b = 1; track x;"), last);
    assert_eq!(of("fix a = 1; fix b = 2; track x;"), [""; 0]);
    let first = messages("limit = 3", "limit = 3 + 1/a^2", "fix a = 0; fix b = 1; track x;");
    assert_eq!(first, ["fixing `a` at this value makes `brake` divide by zero"]);
}
