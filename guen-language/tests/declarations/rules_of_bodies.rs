//! The rules by which bodies are derived, one by one: each declaration reaches rules that few systems do. No other formulation is tried,
//! so that a wrong sign cannot hide behind a cheaper one. Rates that are not those of (2.7) end a derivation with an error, and rows of
//! reactions that are not proved are replaced by longer ones. `docs/design/checks.md` says which signs were
//! flipped.

use crate::common::derived_without;
use guen_language::derive::function;

/// Asserts that the rates are found body by body where nothing else is tried.
fn assert_by_bodies(text: &str) {
    let is_by_bodies = |name: &str| {
        derived_without(text, |other| other != name, |derived| derived.system.derivation.is_by(name))
    };
    assert!(is_by_bodies("bodies"), "{text}");
}

/// A knife that slides along the middle of a sled on a slope, and carries a mass; `further` is where it is beside that.
fn knife(further: &str) -> String {
    format!(
        "system Sled {{
            constants {{ m, k, I, g }}
            coordinates {{ x, y, heading, slide }}
            let F = rot_z(heading);
            let middle = vec(x, y, 0);
            let edge = middle - slide*F.x{further};
            bodies {{
                sled {{ mass: m, inertia: diag(I, I, I), center: middle, orientation: F }}
                knife {{ mass: k, inertia: diag(I, I, I/2), center: edge, orientation: F }}
            }}
            gravity = vec(0, -g, 0);
            parameters {{ turn = dot(heading); push = dot(slide); speed = inner(F.x, dot(middle)); }}
            constraints {{ grip: inner(F.y, dot(edge)) = 0; }}
        }}"
    )
}

#[test]
fn a_velocity_follows_from_one_that_vanishes_further_out() {
    assert_by_bodies(&knife(""));
}

#[test]
fn a_place_that_is_driven_moves_what_follows_from_it() {
    assert_by_bodies(&knife(" + sin(t)*F.y"));
}

#[test]
fn links_on_a_slope_fall_along_the_velocities_that_turn_them() {
    // Of each link the velocity ahead is a multiple of the spin of the next one.
    assert_by_bodies(
        "system Snake {
            constants { m, I, l, g }
            coordinates { x, y, a, b, c }
            let A = rot_z(a); let B = rot_z(b); let C = rot_z(c);
            let first = vec(x, y, 0) + l*A.x;
            let second = first + l*A.x + l*B.x;
            let third = second + l*B.x + l*C.x;
            bodies {
                one { mass: m, inertia: diag(I, I, I), center: first, orientation: A }
                two { mass: m, inertia: diag(I, I, I), center: second, orientation: B }
                three { mass: m, inertia: diag(I, I, I), center: third, orientation: C }
            }
            gravity = vec(g/3, -g, 0);
            constraints {
                front: inner(A.y, dot(first)) = 0;
                middle: inner(B.y, dot(second)) = 0;
                rear: inner(C.y, dot(third)) = 0;
            }
            parameters { speed = inner(A.x, dot(first)); turn = dot(a); }
        }",
    );
}

#[test]
fn what_is_pinned_in_space_turns_back_into_the_axes_before() {
    // Rods whose centres are coordinates beside two angles each.
    assert_by_bodies(
        "system Rods {
            constants { m, I, l, g }
            coordinates { x, y, h, a, c, u, v, k, b, d }
            let A = rot_z(a)*rot_x(c); let B = rot_z(b)*rot_x(d);
            let first = vec(x, y, h); let second = vec(u, v, k);
            holonomic { hung: first - l*A.z = vec(0, 0, 0); pinned: first + l*A.z = second - l*B.z; }
            bodies {
                one { mass: m, inertia: diag(I, I, 2*I), center: first, orientation: A }
                two { mass: m, inertia: diag(I, I, 2*I), center: second, orientation: B }
            }
            gravity = vec(0, 0, -g);
            parameters { wa = dot(a); wb = dot(b); wc = dot(c); wd = dot(d); }
        }",
    );
}

#[test]
fn a_velocity_that_a_form_gives_turns_back_with_its_rate() {
    // A wheel whose radius changes; the energy speaks of the rate of a coordinate in the world.
    assert_by_bodies(
        "system Cart {
            constants { m, I, r, k, l, g }
            coordinates { x, y, heading, w, q }
            let F = rot_z(heading); let middle = vec(x, y, 0);
            bodies {
                cart { mass: m, inertia: diag(I, I, I), center: middle, orientation: F }
                ball { mass: m, inertia: diag(I, I, I), center: middle + q*F.x + l*F.y, orientation: F*rot_x(w) }
            }
            kinetic_energy = 1/2*k*dot(x)^2;
            gravity = vec(0, -g, 0);
            parameters { turn = dot(heading); roll = dot(w); slide = dot(q); }
            constraints {
                side: inner(F.y, dot(middle)) = 0;
                ahead: inner(F.x, dot(middle)) = (r + k*q)*dot(w);
            }
        }",
    );
}

#[test]
fn a_bead_is_carried_by_its_rod_while_a_form_drives_it() {
    assert_by_bodies(
        "system Bead {
            constants { m, k, I, g }
            coordinates { phi, tilt, u }
            let R = rot_z(phi)*rot_x(tilt);
            bodies {
                rod { mass: k, inertia: diag(I, 2*I, I), center: vec(0, 0, 0), orientation: R }
                bead { mass: m, inertia: diag(I, I, 2*I), center: u*R.x, orientation: R }
            }
            gravity = vec(0, 0, -g);
            parameters { turn = dot(phi); nod = dot(tilt); }
            constraints { spiral: inner(R.x, dot(u*R.x)) = (1 + u)*dot(tilt); }
        }",
    );
}

#[test]
fn directions_of_a_core_turn_with_the_bodies_and_within_them() {
    assert_by_bodies(
        "system Cart {
            constants { m, I, a, b, g }
            coordinates { x, y, heading, q }
            let F = rot_z(heading); let middle = vec(x, y, 0);
            bodies {
                cart { mass: m, inertia: diag(I, I, I), center: middle, orientation: F }
                ball { mass: m, inertia: diag(I, I, I), center: middle + q*F.x, orientation: F }
            }
            gravity = vec(0, -g, 0);
            parameters { slide = dot(q); drive = inner(F.x + q*F.y, cart.velocity_at(middle + b*F.x)); }
            constraints { rear: inner(F.y + q*F.x, cart.velocity_at(middle - a*F.x)) = 0; }
        }",
    );
}

#[test]
fn a_steered_wheel_determines_the_core_by_its_own_axes() {
    assert_by_bodies(
        "system Cart {
            constants { m, I, k, J, a, b, g }
            coordinates { x, y, heading, steer }
            let F = rot_z(heading); let W = F*rot_z(steer); let middle = vec(x, y, 0);
            bodies {
                cart { mass: m, inertia: diag(I, I, I), center: middle, orientation: F }
                wheel { mass: k, inertia: diag(J, J, J), center: middle + b*F.x, orientation: W }
            }
            gravity = vec(0, -g, 0);
            parameters { steering = dot(steer); drive = inner(W.x, cart.velocity_at(middle + b*F.x)); }
            constraints {
                rear: inner(F.y, cart.velocity_at(middle - a*F.x)) = 0;
                front: inner(W.y, cart.velocity_at(middle + b*F.x)) = 0;
            }
        }",
    );
}

/// A cart with a steered wheel whose place is driven, on ground that moves; `rear` is how its rear moves.
fn cart_on_a_belt(rear: &str) -> String {
    format!(
        "system Cart {{
            constants {{ m, I, k, J, a, b, v, g }}
            coordinates {{ x, y, heading, steer }}
            let F = rot_z(heading); let W = F*rot_z(steer); let middle = vec(x, y, 0);
            let nose = middle + (b + sin(t))*F.x;
            bodies {{
                cart {{ mass: m, inertia: diag(I, I, I), center: middle, orientation: F }}
                wheel {{ mass: k, inertia: diag(J, J, J), center: nose, orientation: W }}
            }}
            gravity = vec(0, -g, 0);
            parameters {{ steering = dot(steer); drive = inner(W.x, dot(nose)); }}
            constraints {{ rear: {rear}; front: inner(W.y, dot(nose) - vec(0, v*t, 0)) = 0; }}
        }}"
    )
}

#[test]
fn a_core_moves_where_its_ground_moves() {
    // Both rows of the core, and the rate of a place, have parts without parameters.
    assert_by_bodies(&cart_on_a_belt("inner(F.y, cart.velocity_at(middle - a*F.x) - vec(v*x, 0, 0)) = 0"));
    // One velocity follows from its row before the core.
    assert_by_bodies(&cart_on_a_belt("inner(F.y, dot(middle)) = v*t"));
}

#[test]
fn an_angle_that_is_a_function_turns_faster_the_faster_it_turns() {
    assert_by_bodies(
        "system Nod {
            constants { m, I, J, l, g }
            coordinates { a, u }
            let A = rot_z(a); let B = A*rot_x(u^3);
            bodies {
                one { mass: m, inertia: diag(I, J, I), center: l*A.x, orientation: A }
                two { mass: m, inertia: diag(I, J, 2*I), center: l*A.x + l*B.y, orientation: B }
            }
            gravity = vec(0, 0, -g);
            parameters { turn = dot(a); push = dot(u); }
        }",
    );
}

#[test]
fn the_lever_to_the_lowest_point_of_a_wheel_turns_with_its_plane() {
    assert_by_bodies(
        "system Wheel {
            constants { m > 0, I > 0, k > 0, r > 0, l > 0, g = 9.81 }
            coordinates { x, y, z, yaw, lean, pitch, steer, roll }
            let up = vec(0, 0, 1);
            let B = rot_z(yaw)*rot_x(lean)*rot_y(pitch); let F = B*rot_z(steer);
            let hub = vec(x, y, z);
            let contact = hub - r*unit(up - inner(up, F.y)*F.y);
            bodies {
                wheel { mass: m, inertia: diag(I, 2*I, I), center: hub, orientation: F*rot_y(roll) }
                frame { mass: k, inertia: diag(I, I, I), center: hub + l*B.x, orientation: B }
            }
            gravity = -g*up;
            parameters {
                turning = dot(yaw); falling = dot(lean); nodding = dot(pitch); steering = dot(steer); rolling = dot(roll);
            }
            constraints { ground: wheel.velocity_at(contact) = 0; }
        }",
    );
}

#[test]
fn a_spin_is_held_along_an_axis_that_another_body_turns() {
    assert_by_bodies(
        "system Gripped {
            constants { m, I, J, g }
            coordinates { h, a, b, c }
            let H = rot_z(h)*rot_x(1/3); let R = rot_z(a)*rot_x(b)*rot_z(c);
            bodies {
                ball { mass: m, inertia: diag(I, J, 2*I), center: vec(0, 0, 0), orientation: R }
                ring { mass: m, inertia: diag(I, I, 2*I), center: vec(0, 0, 0), orientation: H }
            }
            gravity = vec(0, 0, -g);
            parameters {
                turn = dot(h);
                first = inner(R.x, ball.angular_velocity);
                second = inner(R.y, ball.angular_velocity);
            }
            constraints { grip: inner(H.y, ball.angular_velocity) = 0; }
        }",
    );
}

#[test]
fn a_belt_moves_what_a_sled_grips() {
    assert_by_bodies(
        "system Belt {
            constants { m, I, l, v, g }
            coordinates { x, y, heading, slide }
            let F = rot_z(heading); let middle = vec(x, y, 0);
            bodies {
                sled { mass: m, inertia: diag(I, I, I), center: middle, orientation: F }
                load { mass: m, inertia: diag(I, I, I), center: middle + slide*F.x + l*F.y, orientation: F }
            }
            gravity = vec(0, -g, 0);
            parameters { turn = dot(heading); speed = inner(F.x, dot(middle)); push = dot(slide); }
            constraints { grip: inner(F.y, sled.velocity_at(middle - l*F.x) - vec(v*slide, 0, 0)) = 0; }
        }",
    );
}

#[test]
fn a_quaternion_that_is_strained_and_turned_has_a_short_reaction() {
    // Along the displacement of the constraint on its length the rates of three entries stay, and the body turns too.
    let text = "system Top {
        constants { m, I, J, K, a, b, c, g }
        coordinates { w, i, j, k, u, p }
        let R = quaternion(w, i, j, k); let S = R*rot_x(p);
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
        bodies {
            top { mass: m, inertia: sym(I, J, K, a, b, c), center: R*vec(a, b, u), orientation: R }
            arm {
                mass: m, inertia: sym(I, J, K, a, b, c), center: R*vec(a, b, u) + S*vec(b, a, c), orientation: S
            }
        }
        gravity = vec(0, 0, -g);
        parameters { di = dot(i); dj = dot(j); dk = dot(k); du = dot(u); dp = dot(p); }
    }";
    assert_by_bodies(text);
    let operations = derived_without(
        text,
        |_| false,
        |derived| derived.system.program(function::REACTIONS).unwrap().cost.operations(),
    );
    // Found by bodies 479; where it is projected it has the derivatives of the energy in it.
    assert!(operations < 700, "{operations}");
}

/// Two frames of the world that one angle turns about different axes are not turned alike, and bodies have places along both.
#[test]
fn one_angle_about_two_axes_turns_two_frames() {
    assert_by_bodies(
        "system Arms {
            constants { m > 0, k > 0, I > 0, l > 0, g = 9.81 }
            coordinates { q, p }
            let Z = rot_z(q); let X = rot_x(q); let Y = X*rot_y(p);
            bodies {
                first { mass: m, inertia: diag(I, 2*I, 3*I), center: l*Z.x, orientation: Z }
                second { mass: k, inertia: diag(2*I, I, 3*I), center: l*X.y + l*Y.x, orientation: Y }
            }
            gravity = vec(0, -g, 0);
        }",
    );
}
