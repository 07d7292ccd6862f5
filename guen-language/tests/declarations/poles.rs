//! Where the angles of a body have a pole its spins have none: the accelerations next to the edge are right to some
//! roundings of the largest, against 71 digits, in whatever angles the body is turned.

use crate::common::{derived, evaluated, rounds};
use f256::f256;
use guen_language::derive::{DerivedSystem, function};
use guen_symbolic::{SymbolId, evaluate};

/// Roundings of the largest acceleration that may be lost, far from the edge and next to it: there are some hundred
/// operations, a mass matrix to be solved, and the rounding of the rates of angles.
const ROUNDINGS: f64 = 2000.0;

/// An ellipsoid that rolls, its mass centre off its own, its axes of inertia turned.
fn ellipsoid(turns: &str, spin: &str) -> String {
    format!(
        "pub system Ellipsoid {{
            constants {{ m > 0, a > 0, b > 0, c > 0, h, A > 0, B > 0, C > 0, D, g = 9.81 }}
            coordinates {{ p, q, r, x, y, z }}
            let R = {turns};
            let n = transpose(R)*vec(0, 0, 1);
            let size = sqrt((a*n.x)^2 + (b*n.y)^2 + (c*n.z)^2);
            let lowest = vec(a^2*n.x, b^2*n.y, c^2*n.z)/-size;
            bodies {{ stone {{ mass: m, inertia: sym(A, B, C, D, 0, 0), center: vec(x, y, z), orientation: R }} }}
            gravity = vec(0, 0, -g);
            parameters {{ spin = {spin}; }}
            constraints {{ rolling: stone.velocity_at(vec(x, y, z) + R*(lowest + vec(0, 0, h))) = 0; }}
        }}"
    )
}

/// A ball with three moments of inertia on a turning table, whose centre is given in moving axes.
fn ball(turns: &str) -> String {
    format!(
        "pub system Ball {{
            constants {{ m > 0, a > 0, A > 0, B > 0, C > 0, D, W }}
            coordinates {{ p, q, r, x, y }}
            let R = {turns};
            bodies {{ ball {{ mass: m, inertia: diag(A, B, C), center: vec(x, y, a), orientation: R }} }}
            parameters {{ spin = angular_velocity_body(R); }}
            constraints {{ rolling: ball.velocity_at(vec(x, y, 0)) = vec(-W*y, W*x, 0); }}
            forces {{ -D*vec(0, 0, 1) along ball.angular_velocity; }}
        }}"
    )
}

/// The largest error of an acceleration, in roundings of the largest of them, on the way to `q = edge`.
fn roundings(derived: &DerivedSystem<'_>, edge: f64) -> f64 {
    let (graph, level) = (&derived.model.bench.graph, &derived.system);
    let derivation = &level.derivation;
    let exact = &derivation.solution.accelerations;
    let angle = graph.as_symbol(derivation.system.forms.coordinates[1]);
    let mut worst = 0.0_f64;
    for round in 0..60_u32 {
        let distance = 10.0_f64.powf(-f64::from(round) / 6.0);
        let value = |symbol: SymbolId| {
            if Some(symbol) == angle {
                return edge + distance;
            }
            let name = graph.symbol_info(symbol).name.clone();
            let letters = name.bytes().fold(f64::from(round), |sum, letter| 1.7 * sum + f64::from(letter));
            // Constants are those of a body, whatever the state is.
            match &name[..] {
                "m" | "a" => 1.5,
                "b" | "A" => 0.5,
                "c" | "B" => 0.75,
                "C" => 1.0,
                "D" => -0.0625,
                "h" | "W" => 0.125,
                "g" => 9.8125,
                _ => letters.sin(),
            }
        };
        let exact = evaluate(graph, exact, &|symbol| f256::from(value(symbol)));
        let found = evaluated(level, function::RHS, value).expect("rates");
        let found = &found[found.len() - exact.len()..];
        let difference = |(a, b): (&f256, &f64)| (*a - f256::from(*b)).abs();
        let error = exact.iter().zip(found).map(difference).fold(f256::ZERO, f256::max);
        let size = exact.iter().map(|a| a.abs()).fold(f256::ZERO, f256::max);
        let ratio = error / size / f256::from(f64::EPSILON);
        worst = worst.max(format!("{ratio:.6}").parse().expect("a number"));
    }
    worst
}

fn right_at_the_edge(text: &str, edge: f64) {
    let worst = derived(text, |derived| roundings(derived, edge));
    assert!(worst < ROUNDINGS, "{worst} roundings\n{text}");
}

const QUARTER: f64 = std::f64::consts::FRAC_PI_2;

#[test]
fn in_yaw_roll_and_pitch() {
    right_at_the_edge(&ellipsoid("rot_z(p)*rot_x(q)*rot_y(r)", "angular_velocity_body(R)"), QUARTER);
}

#[test]
fn in_the_angles_of_euler() {
    right_at_the_edge(&ellipsoid("rot_z(p)*rot_x(q)*rot_z(r)", "angular_velocity_body(R)"), 0.0);
}

#[test]
fn with_spins_in_the_axes_of_the_world() {
    right_at_the_edge(&ellipsoid("rot_z(p)*rot_x(q)*rot_y(r)", "angular_velocity(R)"), QUARTER);
}

#[test]
fn on_a_turning_table() {
    right_at_the_edge(&ball("rot_z(p)*rot_x(q)*rot_z(r)"), 0.0);
    right_at_the_edge(&ball("rot_y(p)*rot_z(q)*rot_x(r)"), QUARTER);
}

/// In whatever order the turns come. Where none is about the upright axis first, the normal in the body depends on the angles
/// on both sides of the pole, and its rate is the sum of theirs. Every run takes the spins in the axes of the body and in those of
/// the world in turn; with `GUEN_ROUNDS` each sequence has both.
#[test]
fn in_every_sequence_of_turns() {
    /// Of the largest, 41 are lost.
    const FEW: f64 = 100.0;
    let sequences = ["xyz", "xzy", "yzx", "yxz", "zxy", "zyx", "xyx", "xzx", "yxy", "yzy", "zxz", "zyz"];
    let spins = ["angular_velocity_body(R)", "angular_velocity(R)"];
    let all = rounds(0) > 0;
    for (number, sequence) in sequences.into_iter().enumerate() {
        let turns: Vec<String> = sequence
            .chars()
            .zip(["p", "q", "r"])
            .map(|(axis, angle)| format!("rot_{axis}({angle})"))
            .collect();
        let edge = if sequence.starts_with(&sequence[2..]) { 0.0 } else { QUARTER };
        for spin in if all { &spins[..] } else { &spins[number % 2..][..1] } {
            let text = ellipsoid(&turns.join("*"), spin);
            let worst = derived(&text, |derived| roundings(derived, edge));
            println!("{sequence}, {spin}: {worst:.1} roundings");
            assert!(worst < FEW, "{sequence}, {spin}: {worst} roundings");
        }
    }
}
