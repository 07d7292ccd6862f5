//! Limbs on a floating body: the rate of each joint leaves the equations before the velocities of the link that carries it.

use std::fmt::Write;

use crate::common::{derived, evaluated};
use crate::families::robots;
use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_symbolic::{Graph, SymbolId, evaluate_f64};

/// A level's rates, put into its equations at a state.
fn residual(derived: &DerivedSystem<'_>) -> f64 {
    let level = &derived.system;
    let graph = &derived.model.bench.graph;
    let value = |symbol: SymbolId| {
        let name = &graph.symbol_info(symbol).name;
        let draw = (7.3 * (1.0 + name.bytes().fold(0.0, |sum, byte| 1.7 * sum + f64::from(byte)))).sin();
        match name.as_bytes()[0] {
            b'm' | b'I' => 1.5 + draw,
            _ => 0.4 * draw,
        }
    };
    left(level, graph, &value)
}

/// The residual of the equations of motion at a level's rates, relative to the largest of their terms.
fn left(level: &DerivedLevel, graph: &Graph, value: &impl Fn(SymbolId) -> f64) -> f64 {
    let rates = evaluated(level, function::RHS, value).unwrap();
    let equations = &level.derivation.equations;
    let forces = evaluate_f64(graph, &equations.forces, value);
    let accelerations = &rates[rates.len() - forces.len()..];
    let mut worst = 0.0_f64;
    for (row, force) in equations.mass.iter().zip(&forces) {
        let row = evaluate_f64(graph, row, value);
        let parts: Vec<f64> = row.iter().zip(accelerations).map(|(m, rate)| m * rate).collect();
        let size: f64 = parts.iter().map(|part| part.abs()).sum();
        worst = worst.max((parts.iter().sum::<f64>() - force).abs() / (1.0 + size + force.abs()));
    }
    worst
}

/// Joints about oblique axes; the tip of the last link is held by three equations.
fn held(axes: &[&str]) -> String {
    let names = |letter: char| {
        let all: Vec<String> = (1..=axes.len()).map(|i| format!("{letter}{i}")).collect();
        all.join(", ")
    };
    let mut text = format!(
        "pub system Held {{ constants {{ g = 9.81, {} > 0, {} > 0, {} > 0 }} coordinates {{ {} }} let R0 = rot_z(0); let o0 = vec(0, 0, 0);\n",
        names('l').replace(',', " > 0,"),
        names('m').replace(',', " > 0,"),
        names('I').replace(',', " > 0,"),
        names('q'),
    );
    let mut bodies = String::new();
    for (i, axis) in (1..).zip(axes) {
        let old = i - 1;
        let _ = writeln!(text, "let R{i} = R{old}*rot(unit(vec({axis})), q{i});");
        let _ = writeln!(text, "let o{i} = o{old} + R{old}*vec(l{i}, 1/4, 1/3);");
        let _ = writeln!(
            bodies,
            "B{i} {{ mass: m{i}, inertia: diag(I{i}, 2*I{i}, 3/2*I{i}), center: o{i} + R{i}*vec(1/2, 0, 1), orientation: R{i} }}"
        );
    }
    let last = axes.len();
    let _ = write!(
        text,
        "holonomic {{ tip: o{last} + R{last}*vec(1/2, 0, 1/3) = vec(3/2, 0, 0); }} bodies {{ {bodies} }} gravity = vec(0, 0, -g); parameters {{"
    );
    for i in 1..=last - 3 {
        let _ = write!(text, "w{i} = dot(q{i});");
    }
    text + "} }"
}

#[test]
fn a_held_chain_is_not_multiplied_out() {
    let axes = ["0, 1, -1", "2, 1, -2", "1, 0, 1", "2, -2, 1", "1, 2, 2"];
    derived(&held(&axes), |derived| {
        let level = &derived.system;
        let cost = level.program(function::RHS).unwrap().cost;
        // 1,575 as this is written.
        assert!(cost.operations() <= 1_700, "{}", cost.operations());
        let much = ("multiplied out", "the equations of bodies are much shorter");
        assert!(level.derivation.is_by("bodies") && level.derivation.declined.contains(&much));
        assert!(residual(derived) < 1e-11);
    });
}

/// The turn of a ball joint is declared in the world's axes: its spin is known, and the rates of its quaternion follow from that.
#[test]
fn spins_in_the_axes_of_the_world_are_those_of_bodies() {
    let text = "pub system Ball {
        constants { l > 0, m > 0, I > 0, J > 0, K > 0, g = 9.81 }
        coordinates { q, s, a, b, c, d, u }
        let R = rot_z(q);
        let o = vec(0, l, 0) + s*R.z;
        let Q = R*quaternion(a, b, c, d);
        let p = o + R*vec(0, 1/2, 0);
        let e = p + Q*vec(2/3, 0, 1/2) + u*Q*vec(4/5, 0, -3/5);
        holonomic { length: a^2 + b^2 + c^2 + d^2 = 1; }
        bodies {
            mast { mass: m, inertia: diag(I, J, I), center: o + R*vec(l, 0, 1/2), orientation: R }
            ball { mass: m, inertia: diag(I, J, K), center: p + Q*vec(0, l, 0), orientation: Q }
            slide { mass: m, inertia: diag(I, J, I), center: e, orientation: Q }
        }
        parameters {
            spin = angular_velocity(quaternion(a, b, c, d));
            turn = dot(q); rise = dot(s); out = dot(u);
        }
        gravity = vec(0, 0, -g);
    }";
    derived(text, |derived| {
        let level = &derived.system;
        let cost = level.program(function::RHS).unwrap().cost;
        assert!(level.derivation.is_by("bodies"), "{:?}", level.derivation.declined);
        assert!(cost.operations() <= 1_000, "{}", cost.operations());
    });
}

/// The rate of a coordinate that only the contact determines: a force along it does not keep the reactions from being those of bodies.
#[test]
fn a_pushed_wheel_that_carries_an_arm_reacts_as_bodies_do() {
    let text = "pub system Pushed {
        constants { r > 0, l > 0, h > 0, m > 0, I > 0, J > 0, g = 9.81 }
        inputs { push }
        coordinates { x, y, yaw, lean, turn, a, b, c, d }
        let B = rot_z(yaw)*rot_x(lean)*rot_y(turn);
        let p = vec(x, y, 0) + r*(rot_z(yaw)*rot_x(lean)).z;
        let A = B*rot_x(a)*rot_z(b);
        let C = A*rot_y(c)*rot_x(d);
        let q = p + A*vec(l, 0, h);
        bodies {
            wheel { mass: m, inertia: diag(I, J, I), center: p, orientation: B }
            arm { mass: m, inertia: diag(I, J, 3), center: q, orientation: A }
            hand { mass: m, inertia: diag(J, I, 3), center: q + C*vec(1, 0, h), orientation: C }
        }
        constraints { contact: wheel.velocity_at(vec(x, y, 0)) = 0; }
        parameters { w1 = dot(yaw); w2 = dot(lean); w3 = dot(turn); va = dot(a); vb = dot(b); vc = dot(c); vd = dot(d); }
        forces { push along dot(x); }
        gravity = vec(0, 0, -g);
    }";
    derived(text, |derived| {
        let level = &derived.system;
        let cost = level.program(function::REACTIONS).unwrap().cost;
        // 354 as this is written; the projection takes 2,265.
        assert!(level.derivation.is_by("bodies"));
        assert!(cost.operations() <= 380, "{}", cost.operations());
        assert!(residual(derived) < 1e-11);
    });
}

#[test]
fn a_quadruped_costs_so_many_operations_and_solves_its_equations() {
    let text = robots::quadruped();
    derived(&text, |derived| {
        let level = &derived.system;
        let cost = level.program(function::RHS).unwrap().cost;
        // 3,212 as this is written.
        assert!(cost.operations() + cost.sines + cost.calls <= 3_500, "{}", cost.operations());
        assert!(level.derivation.is_by("bodies"));
        assert!(residual(derived) < 1e-11);
    });
}

/// The quaternions are of length one: elsewhere nothing is promised of what moves on the constraints.
fn residual_on_quaternions(derived: &DerivedSystem<'_>) -> f64 {
    let level = &derived.system;
    let graph = &derived.model.bench.graph;
    let draw =
        |name: &str| (7.3 * (1.0 + name.bytes().fold(0.0, |sum, byte| 1.7 * sum + f64::from(byte)))).sin();
    let value = |symbol: SymbolId| {
        let name = &graph.symbol_info(symbol).name;
        let entry = |letter: char| draw(&format!("{letter}{}", &name[1..]));
        match name.as_bytes()[0] {
            b'w' | b'x' | b'y' | b'z' => {
                let length = ['w', 'x', 'y', 'z'].map(|letter| entry(letter).powi(2)).iter().sum::<f64>();
                draw(name) / length.sqrt()
            }
            b'l' | b'm' | b'I' | b'J' => 1.5 + draw(name),
            _ => 2.0 * draw(name),
        }
    };
    left(level, graph, &value)
}

#[test]
fn a_further_rod_on_a_ball_joint_costs_so_many_operations() {
    for (is_relative, most) in [(false, [45, 320, 640, 1_080]), (true, [45, 320, 700, 1_180])] {
        for (count, most) in (1..).zip(most) {
            derived(&robots::rods(count, is_relative), |derived| {
                let cost = derived.system.program(function::RHS).unwrap().cost;
                assert!(cost.operations() <= most, "{count}: {}", cost.operations());
                assert!(derived.system.derivation.is_by("bodies"));
                assert!(residual_on_quaternions(derived) < 1e-11, "{}", residual_on_quaternions(derived));
            });
        }
    }
}
