//! Bodies on hinges, each with a quaternion and its centre in the world: the motion is that of the angles about the hinges.

use std::fmt::Write;

use crate::common::{derived, evaluated};
use crate::families::robots;
use guen_language::derive::function;
use guen_symbolic::SymbolId;

/// A state of rods: the angles about the hinges and their rates, and for each hinge beyond the first whether its axis is the opposite one
/// of the rod before.
struct State {
    angles: Vec<f64>,
    rates: Vec<f64>,
    is_opposite: Vec<bool>,
}

impl State {
    fn new(count: usize, branch: usize) -> Self {
        let draw = |i: usize| (1.9 * (i as f64 + 1.0)).sin();
        State {
            angles: (0..count).map(|i| 2.0 * draw(i)).collect(),
            rates: (0..count).map(|i| 1.5 * draw(i + 7)).collect(),
            is_opposite: (0..count).map(|i| i > 0 && branch >> (i - 1) & 1 == 1).collect(),
        }
    }

    /// The rods in the angles, with the same constants.
    fn in_angles(&self) -> String {
        let count = self.angles.len();
        let list = |entry: &dyn Fn(usize) -> String| (1..=count).map(entry).collect::<Vec<_>>().join(", ");
        let mut lets = "let R0 = rot_z(0); let e0 = vec(0, 0, 0);".to_owned();
        let mut bodies = String::new();
        for (i, opposite) in (1..).zip(&self.is_opposite) {
            let old = i - 1;
            let bend = match (i, opposite) {
                (1, _) => "0",
                (_, false) => "-pi/2",
                (_, true) => "pi/2",
            };
            let _ = write!(lets, "let R{i} = R{old}*rot_x({bend})*rot_z(t{i});");
            let _ = write!(lets, "let e{i} = e{old} + l{i}*R{i}.x;");
            let _ = write!(
                bodies,
                "B{i} {{ mass: m{i}, inertia: diag(0, I{i}, I{i}), center: e{old} + l{i}/2*R{i}.x, orientation: R{i} }}"
            );
        }
        format!(
            "pub system Angles {{ constants {{ g = 9.81, {} }} coordinates {{ {} }} {lets} bodies {{ {bodies} }} \
             parameters {{ {} }} gravity = vec(0, -g, 0); }}",
            list(&|i| format!("l{i} > 0, m{i} > 0, I{i} > 0")),
            list(&|i| format!("t{i}")),
            (1..=count).map(|i| format!("turn{i} = dot(t{i});")).collect::<String>(),
        )
    }

    /// The centres and quaternions of all rods, `a, b, c, w, x, y, z` of each, at a time from now.
    fn coordinates(&self, time: f64) -> Vec<f64> {
        let mut found = Vec::new();
        let (mut q, mut end) = ([1.0, 0.0, 0.0, 0.0], [0.0; 3]);
        for (i, angle) in self.angles.iter().enumerate() {
            let bend = match (i, self.is_opposite[i]) {
                (0, _) => 0.0_f64,
                (_, false) => -0.25 * std::f64::consts::PI,
                (_, true) => 0.25 * std::f64::consts::PI,
            };
            let half = 0.5 * (angle + time * self.rates[i]);
            q = times(q, [bend.cos(), bend.sin(), 0.0, 0.0]);
            q = times(q, [half.cos(), 0.0, 0.0, half.sin()]);
            let [w, x, y, z] = q;
            let along = [w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
            let length = constant(&format!("l{}", i + 1));
            found.extend([0, 1, 2].map(|k| end[k] + 0.5 * length * along[k]));
            found.extend(q);
            end = [0, 1, 2].map(|k| end[k] + length * along[k]);
        }
        found
    }

    fn value(&self, name: &str) -> f64 {
        let (letter, number) = name.split_at(name.len() - 1);
        let place = number.parse::<usize>().map_or(0, |number| number - 1);
        match letter {
            "turn" => self.rates[place],
            "t" => self.angles[place],
            "l" | "m" | "I" => constant(name),
            _ => match ["a", "b", "c", "w", "x", "y", "z"].iter().position(|own| *own == letter) {
                Some(own) => self.coordinates(0.0)[7 * place + own],
                None => 9.81,
            },
        }
    }
}

fn constant(name: &str) -> f64 {
    1.5 + (7.3 * name.bytes().fold(0.0, |sum, byte| 1.7 * sum + f64::from(byte))).sin()
}

/// The product of quaternions.
fn times([a, b, c, d]: [f64; 4], [w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}

/// A hinge points along an axis of the rod before or against it: both are solutions of the same equations.
#[test]
fn rods_on_hinges_move_as_in_angles_whichever_way_their_axes_point() {
    for count in 1..=3 {
        derived(&robots::hinged_rods(count), |in_quaternions| {
            let level = &in_quaternions.system;
            let graph = &in_quaternions.model.bench.graph;
            assert!(level.derivation.is_by("bodies"));
            // 26, 223 and 547 as this is written; without the tree that the hinges make 42, 1,755 and 3,050.
            let cost = level.program(function::RHS).unwrap().cost.operations();
            assert!(cost <= [30, 240, 580][count - 1], "{count}: {cost}");
            for branch in 0..1 << (count - 1) {
                let state = State::new(count, branch);
                let value = |symbol: SymbolId| state.value(&graph.symbol_info(symbol).name);
                let rates = evaluated(level, function::RHS, value).unwrap();
                let (moving, turning) = rates.split_at(7 * count);
                let step = 1e-5;
                let (after, before) = (state.coordinates(step), state.coordinates(-step));
                for (rate, (after, before)) in moving.iter().zip(after.iter().zip(&before)) {
                    let expected = (after - before) / (2.0 * step);
                    assert!((rate - expected).abs() < 1e-8, "{count} {branch}: {rate} and {expected}");
                }
                derived(&state.in_angles(), |in_angles| {
                    let graph = &in_angles.model.bench.graph;
                    let value = |symbol: SymbolId| state.value(&graph.symbol_info(symbol).name);
                    let expected = evaluated(&in_angles.system, function::RHS, value).unwrap();
                    for (own, other) in turning.iter().zip(&expected[count..]) {
                        let size = 1.0 + other.abs();
                        assert!((own - other).abs() < 1e-12 * size, "{count} {branch}: {own} and {other}");
                    }
                });
            }
        });
    }
}

/// A quaternion against a turntable, and the spin in space as parameters: its rates follow from the difference of two spins.
#[test]
fn a_quaternion_on_a_turntable_turns_against_it() {
    let text = "pub system Turntable {
        constants { m > 0, J > 0, A > 0, B > 0, C > 0, h, g = 9.81 }
        coordinates { a, w, x, y, z }
        let T = rot_z(a);
        let R = T*quaternion(w, x, y, z);
        holonomic { length: w^2 + x^2 + y^2 + z^2 = 1; }
        bodies {
            table { mass: 0, inertia: diag(0, 0, J), center: vec(0, 0, 0), orientation: T }
            top { mass: m, inertia: diag(A, B, C), center: h*R.z, orientation: R }
        }
        parameters { turn = dot(a); spin = angular_velocity_body(R); }
        gravity = vec(0, 0, -g);
    }";
    let value = |name: &str| match name {
        // A quaternion of length one.
        "w" | "z" => 0.1_f64,
        "x" => 0.7,
        "y" => 0.7,
        "turn" => 2.0,
        _ => constant(name),
    };
    derived(text, |derived| {
        let graph = &derived.model.bench.graph;
        assert!(derived.system.derivation.is_by("bodies"));
        let named = |symbol: SymbolId| value(&graph.symbol_info(symbol).name);
        let rates = evaluated(&derived.system, function::RHS, named).unwrap();
        // The spin against the table, R^T (0, 0, 2) less than that in space, by 2 q* q'.
        let [w, x, y, z] = ["w", "x", "y", "z"].map(value);
        let q = times([w, -x, -y, -z], [rates[1], rates[2], rates[3], rates[4]]);
        let carried = times(times([w, -x, -y, -z], [0.0, 0.0, 0.0, 2.0]), [w, x, y, z]);
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let own = 2.0 * q[k + 1] + carried[k + 1];
            assert!((own - value(&format!("spin_{axis}"))).abs() < 1e-12, "{rates:?}");
        }
        assert!(q[0].abs() < 1e-12, "{rates:?}");
    });
}
