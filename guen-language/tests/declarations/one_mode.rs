//! Scenes in a single mode of contacts: the system with these rows as constraints, as a user would declare it.

use crate::common::{derived, evaluated};
use guen_language::derive::DerivedLevel;
use guen_language::derive::function::RHS;
use guen_language::model::Model;
use guen_language::report::ReportLines;
use guen_symbolic::SymbolId;

/// The wheel of the design, with a scene that rolls.
const WHEEL: &str = "
    pub system Wheel {
        constants { m > 0, a > 0, J > 0, c >= 0, g = 9.81, mu_road = 4/5, mu_ice = 1/10, e in 0..1 = 0 }
        inputs { torque }
        coordinates { x, z, phi }
        bodies { wheel { mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) } }
        gravity = vec(0, -g);
        parameters { speed_ahead = dot(x); up = dot(z); spin = dot(phi); }
        forces { torque along spin; -c*speed_ahead along speed_ahead; }
        switches { ice: (x - 5)*(9 - x); }
        let p = vec(x, z - a);
        contacts {
            tyre: gap = z - a, slip = wheel.velocity_at(p).x, friction = mu_road + (mu_ice - mu_road)*ice, restitution = e;
        }
        outputs { force = reaction(tyre); }
        scene Rolling { modes { tyre: stick; } track speed_ahead; }
        scene Spinning { modes { tyre: stick; } track spin, x; provide force, energy, reactions(tyre); }
        scene Flying { modes { tyre: open; } }
    }";

const BY_HAND: &str = "
    pub system Wheel {
        constants { m > 0, a > 0, J > 0, c >= 0, g = 9.81, mu_road = 4/5, mu_ice = 1/10, e in 0..1 = 0 }
        inputs { torque }
        coordinates { x, z, phi }
        bodies { wheel { mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) } }
        gravity = vec(0, -g);
        parameters { speed_ahead = dot(x); }
        let spin = dot(phi);
        forces { torque along spin; -c*speed_ahead along speed_ahead; }
        let p = vec(x, z - a);
        holonomic { touches: z - a = 0; }
        constraints { rolls: wheel.velocity_at(p).x = 0; }
        scene Rolling { track speed_ahead; }
    }";

fn names(model: &Model<'_>, level: &DerivedLevel) -> Vec<String> {
    level.selection.variables.iter().map(|place| model.variable_name(*place).to_owned()).collect()
}

fn operations(level: &DerivedLevel) -> u32 {
    let rates = level.program(RHS).unwrap().cost;
    rates.operations() + rates.calls + rates.sines
}

#[test]
fn a_wheel_that_rolls_is_the_rolling_wheel() {
    let by_hand = derived(BY_HAND, |derived| operations(&derived.scenes[0]));
    derived(WHEEL, |derived| {
        let (_, own) = &derived.in_modes[0];
        let level = &own.scenes[0];
        assert_eq!(names(&own.model, level), ["speed_ahead"]);
        assert_eq!(operations(level), by_hand);
        let followers: Vec<&str> =
            level.scene.as_ref().unwrap().followers.iter().map(|(name, _)| &name[..]).collect();
        assert_eq!(followers, ["up", "spin"]);
        // (m + J/a^2) v' = torque/a - c v.
        let value = |symbol: SymbolId| match &own.model.bench.graph.symbol_info(symbol).name[..] {
            "m" => 20.0,
            "a" => 0.3,
            "J" => 1.5,
            "c" => 0.7,
            "torque" => 5.0,
            "speed_ahead" => 2.0,
            other => panic!("{other}"),
        };
        let rate = evaluated(level, RHS, value).unwrap()[0];
        assert!((rate - (5.0 / 0.3 - 0.7 * 2.0) / (20.0 + 1.5 / 0.09)).abs() < 1e-15);
        let (_, own) = &derived.in_modes[1];
        assert_eq!(names(&own.model, &own.scenes[0]), ["x", "spin"]);
        let (_, own) = &derived.in_modes[2];
        assert_eq!(names(&own.model, &own.scenes[0]), ["speed_ahead", "up", "spin"]);
    });
}

/// Asserts that a scene in one mode has these variables, and as many operations as the system that is declared by hand.
fn is_as_by_hand(text: &str, by_hand: &str, variables: &[&str], followers: &[&str]) {
    let expected = derived(by_hand, |derived| operations(&derived.scenes[0]));
    derived(text, |derived| {
        let (_, own) = &derived.in_modes[0];
        let level = &own.scenes[0];
        assert_eq!(names(&own.model, level), variables, "{text}");
        let found = &level.scene.as_ref().unwrap().followers;
        assert_eq!(found.iter().map(|(name, _)| &name[..]).collect::<Vec<_>>(), followers, "{text}");
        assert_eq!(operations(level), expected, "{text}");
    });
}

/// Of a coin's velocities those of its centre would be a bad chart: the macro keeps its angular velocities.
#[test]
fn parameters_that_are_kept_are_those_of_the_best_condition() {
    let coin = |forms: &str, rest: &str| {
        format!(
            "system Coin {{
                constants {{ m > 0, r > 0, I > 0, g = 9.81 }}
                coordinates {{ x, y, z, heading, lean, roll }}
                let axes = rot_z(heading)*rot_x(lean);
                bodies {{ coin {{ mass: m, inertia: diag(I, I, 2*I), center: vec(x, y, z), orientation: axes*rot_z(roll) }} }}
                gravity = vec(0, 0, -g);
                let rim = coin.center - r*axes.y;
                {forms} {rest}
            }}"
        )
    };
    let whole = "parameters { v = dot(vec(x, y, z)); tipping = dot(lean); turning = dot(heading); spinning = dot(roll); }";
    let hand = "let v = dot(vec(x, y, z)); parameters { tipping = dot(lean); turning = dot(heading); spinning = dot(roll); }";
    let contact = "contacts { floor: gap = rim.z, slip = vec(coin.velocity_at(rim).x, coin.velocity_at(rim).y), friction = 1/2; }";
    let rows = "holonomic { floor_n: rim.z = 0; } constraints { floor_t: vec(coin.velocity_at(rim).x, coin.velocity_at(rim).y) = 0; }";
    is_as_by_hand(
        &coin(
            whole,
            &format!("{contact} scene Rolling {{ modes {{ floor: stick; }} track lean, spinning; }}"),
        ),
        &coin(hand, &format!("{rows} scene Rolling {{ track lean, spinning; }}")),
        &["lean", "tipping", "turning", "spinning"],
        &["v_z"],
    );
}

/// Parameters that were left out are those of the whole system, as many as move.
#[test]
fn chosen_rates_follow_as_declared_ones() {
    let block = |rest: &str| {
        format!(
            "system Block {{
                constants {{ m > 0, k > 0, g = 9.81 }}
                coordinates {{ x, z }}
                particles {{ m at vec(x, z); }}
                gravity = vec(0, -g);
                potential_energy = k/2*x^2;
                {rest}
            }}"
        )
    };
    is_as_by_hand(
        &block("contacts { slope: gap = z - x/2; } scene On { modes { slope: closed; } }"),
        &block("holonomic { slope: z - x/2 = 0; } scene On { }"),
        &["x", "x_rate"],
        &["z_rate"],
    );
}

/// Grips, latches, switches and the rows of a permanent constraint together, in a component that is used twice.
#[test]
fn a_door_between_two_grips() {
    let text = "system Door {
        component Leaf(hinge: vector) {
            constants { J > 0 }
            coordinates { angle }
            kinetic_energy = J/2*dot(angle)^2 + 0*hinge.x;
            parameters { omega = dot(angle); }
        }
        constants { c > 0, F > 0 }
        coordinates { slide }
        use Leaf as left { hinge: vec(0, 0) }
        use Leaf as right { hinge: vec(1, 0) }
        kinetic_energy = 1/2*dot(slide)^2;
        parameters { v = dot(slide); }
        switches { far: slide - 1; }
        forces { -c*(1 + far)*v along v; F along left.omega; }
        contacts { hand: grip = left.omega - v, limit = F; bolt: latch = right.angle, release = t - 1; }
        modes { hand: stick; bolt: free, locked; }
        scene Held { modes { bolt: locked; } track left.omega; }
    }";
    let by_hand = "system Door {
        constants { J > 0, K > 0, c > 0, F > 0 }
        coordinates { slide, left, right }
        kinetic_energy = J/2*dot(left)^2 + K/2*dot(right)^2 + 1/2*dot(slide)^2;
        parameters { omega = dot(left); }
        let v = dot(slide);
        let far = 1/2 + sign(slide - 1)/2;
        forces { -c*(1 + far)*v along v; F along omega; }
        constraints { hand: omega - v = 0; }
        holonomic { bolt: right = 0; }
        scene Held { track omega; }
    }";
    is_as_by_hand(text, by_hand, &["slide", "left.omega"], &["v", "right.omega"]);
}

/// A block on two feet that stick: four rows, of which one depends on the others. The motion is determined, reactions are not.
#[test]
fn rows_that_depend_on_each_other_are_named() {
    let text = "system Block {
        constants { m > 0, b > 0, h > 0, l > 0, g = 9.81 }
        coordinates { x, z, tilt, q }
        bodies { block { mass: m, center: vec(x, z), inertia: diag(0, 0, m), orientation: rot_z(tilt) } }
        particles { m at vec(x, z) + l*vec(sin(q), -cos(q)); }
        gravity = vec(0, -g);
        parameters { u = dot(x); w = dot(z); omega = dot(tilt); swing = dot(q); }
        let left = vec(x, z) + rot_z(tilt)*vec(-b, -h);
        let right = vec(x, z) + rot_z(tilt)*vec(b, -h);
        contacts {
            left_foot: gap = left.y, slip = block.velocity_at(left).x, friction = 1/2;
            right_foot: gap = right.y, slip = block.velocity_at(right).x, friction = 1/2;
        }
        outputs { load = reaction(right_foot); height = gap(left_foot); }
        scene Resting { modes { left_foot: stick; right_foot: stick; } track q; }
    }";
    derived(text, |derived| {
        let (_, own) = &derived.in_modes[0];
        let level = &own.scenes[0];
        assert_eq!(names(&own.model, level), ["q", "swing"]);
        assert_eq!(own.model.forms.len(), 4);
        let report = ReportLines::of_part(&own.model, level, &derived.model).to_text();
        let note = "rows of `left_foot`, `right_foot` depend on each other: only sums of their reactions are determined";
        assert!(report.contains(note), "{report}");
        assert!(report.contains("left_foot stick, right_foot stick"), "{report}");
        assert!(report.contains("u follows: u = 0") && report.contains("2 of 8 variables"), "{report}");
        // A pendulum: l q'' = -g sin(q).
        let value = |symbol: SymbolId| match &own.model.bench.graph.symbol_info(symbol).name[..] {
            "q" => 0.7,
            "l" => 0.4,
            "g" => 9.81,
            _ => 0.3,
        };
        let place = names(&own.model, level).iter().position(|name| name == "swing").unwrap();
        let rate = evaluated(level, RHS, value).unwrap()[place];
        assert!((rate + 9.81 / 0.4 * 0.7_f64.sin()).abs() < 1e-13, "{rate}");
    });
}

#[test]
fn a_report_has_the_direction_of_a_slip() {
    let text = "system Block {
        constants { m > 0, mu >= 0, g = 9.81 }
        coordinates { x, z }
        parameters { u = dot(x); w = dot(z); }
        kinetic_energy = m/2*(u^2 + w^2);
        potential_energy = m*g*z;
        contacts { floor: gap = z, slip = u, friction = mu; }
        scene Back { modes { floor: slip-; } }
    }";
    derived(text, |derived| {
        let (_, own) = &derived.in_modes[0];
        let report = ReportLines::of_part(&own.model, &own.scenes[0], &derived.model).to_text();
        assert!(report.contains("floor slip-"), "{report}");
    });
}

/// Contacts of instances and of arrays, by their names.
#[test]
fn contacts_of_instances_stay_in_a_mode() {
    let text = "system Trolley {
        component Wheel(axle: vector, ahead: scalar) {
            constants { r > 0, J > 0 }
            coordinates { angle }
            kinetic_energy = J/2*dot(angle)^2;
            parameters { spin = dot(angle); }
            contacts { tyre: gap = axle.y - r, slip = ahead - r*spin, friction = 1/2; }
        }
        count n = 2;
        constants { m > 0 }
        coordinates { x, y }
        parameters { v = dot(x); w = dot(y); }
        particles { m at vec(x, y); }
        for i in 0..n { use Wheel as left[i] { axle: vec(x, y), ahead: v } }
        contacts { for i in 0..n { stop[i]: gap = 2 - x; } }
        scene Rolling { modes { left[0].tyre: stick; left[1].tyre: open; for i in 0..n { stop[i]: open; } } track v; }
    }";
    let by_hand = "system Trolley {
        constants { m > 0, r > 0, J > 0, K > 0 }
        coordinates { x, y, one, two }
        parameters { v = dot(x); }
        particles { m at vec(x, y); }
        kinetic_energy = J/2*dot(one)^2 + K/2*dot(two)^2;
        let spin = dot(two);
        holonomic { tyre_n: y - r = 0; }
        constraints { tyre_t: v - r*dot(one) = 0; }
        scene Rolling { track v; }
    }";
    is_as_by_hand(text, by_hand, &["v"], &["w", "left[0].spin"]);
}

/// Friction may change with the velocity where a switch says so, also of a scene in one mode, in which the switch follows the state.
#[test]
fn a_switch_of_velocities_stands_in_friction() {
    let text = WHEEL.replace("ice: (x - 5)*(9 - x);", "ice: speed_ahead - 3*spin - 2;");
    assert_ne!(text, WHEEL);
    derived(&text, |derived| assert_eq!(derived.in_modes.len(), 3));
}

/// A tracked coordinate does not keep its rate, which the macro has chosen as a parameter: here `x` follows the floor five hundred
/// times as fast as `z`, and a scene that keeps the rate of `z` loses three digits.
#[test]
fn a_tracked_coordinate_does_not_keep_its_rate() {
    let text = "system Block {
        constants { m > 0, g = 9.81 }
        coordinates { x, z }
        particles { m at vec(x, z); }
        gravity = vec(0, -g);
        contacts { floor: gap = z - x/500; }
        scene On { modes { floor: closed; } track z; }
    }";
    derived(text, |derived| {
        let (_, own) = &derived.in_modes[0];
        assert_eq!(names(&own.model, &own.scenes[0]), ["z", "x_rate"]);
    });
}
