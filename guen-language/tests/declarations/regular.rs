//! Rates at regular states where a rewritten quotient would be zero divided by zero: zeros of angles, of entries of quaternions, rods along
//! the axes. The expected rates are closed forms.

use crate::common::{derived, evaluated};
use guen_language::derive::function;

/// The rates of a declaration where its symbols have these values by name.
fn rates(text: &str, value: impl Fn(&str) -> f64) -> Vec<f64> {
    derived(text, |derived| {
        let graph = &derived.model.bench.graph;
        let value = |symbol| value(&graph.symbol_info(symbol).name);
        evaluated(&derived.system, function::RHS, value).expect("rates")
    })
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-14 * (1.0 + b.abs()), "{found:?}, and not {expected:?}");
    }
}

/// `x = f(y)` with `T = (x'^2 + y'^2)/2`: `(1 + f'^2) y'' = -f' f'' y'^2`.
#[test]
fn divisors_that_do_not_vanish_are_not_replaced_by_some_that_do() {
    // The function, and its first and second derivatives at zero.
    for (f, first, second) in [
        ("1/(1 + cos(y))", 0.0, 0.25),
        ("y/(1 + cos(y))", 0.5, 0.0),
        ("tan(y/4)", 0.25, 0.0),
        ("tan(tanh(3*y)/4 + y)", 1.75, 0.0),
        ("1/(2 - cos(y)) + y", 1.0, -1.0),
        ("(1 + y)/(1 + cos(y/2))", 0.5, 0.125 * 0.5),
    ] {
        let text = format!(
            "system Curve {{
                coordinates {{ x, y }}
                parameters {{ v = dot(y); }}
                constraints {{ on_curve: dot(x) = dot({f}); }}
                kinetic_energy = (dot(x)^2 + dot(y)^2)/2;
            }}"
        );
        let speed = 0.7;
        let found = rates(&text, |name| if name == "v" { speed } else { 0.0 });
        let acceleration = -first * second * speed * speed / (1.0 + first * first);
        assert_near(&found, &[first * speed, speed, acceleration]);
    }
}

/// A body without forces, and the energy of the entries of its quaternion, whose square is a quarter of that of the spin:
/// `A w_1' = (B - C) w_2 w_3` with moments that are larger by a fortieth.
#[test]
fn no_entry_of_a_quaternion_is_divided_by() {
    let text = "system Body {
        constants { A > 0, B > 0, C > 0 }
        coordinates { q0, q1, q2, q3 }
        let R = quaternion(q0, q1, q2, q3);
        bodies { body { mass: 1, inertia: diag(A, B, C), center: vec(0, 0, 0), orientation: R } }
        holonomic { length: q0^2 + q1^2 + q2^2 + q3^2 = 1; }
        parameters { spin = angular_velocity(R); }
        kinetic_energy = (dot(q0)^2 + dot(q1)^2 + dot(q2)^2 + dot(q3)^2)/20;
    }";
    let (moments, spin) = ([0.8, 1.1, 1.3], [0.3, -0.4, 0.5]);
    for place in 0..4 {
        // One entry is one and the others zero, or it is zero and the others are equal.
        for [own, other] in [[1.0, 0.0], [0.0, 1.0 / 3.0_f64.sqrt()]] {
            let q: [f64; 4] = core::array::from_fn(|i| if i == place { own } else { other });
            let found = rates(text, |name| match name {
                "A" => moments[0],
                "B" => moments[1],
                "C" => moments[2],
                "spin_x" => spin[0],
                "spin_y" => spin[1],
                "spin_z" => spin[2],
                name => q[name[1..].parse::<usize>().expect("an entry")],
            });
            let ([x, y, z], [a, b, c, d]) = (spin, q);
            // `2 q' = (0, spin) q`.
            let twice =
                [-x * b - y * c - z * d, x * a + y * d - z * c, y * a + z * b - x * d, z * a + x * c - y * b];
            let axes = [
                [a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)],
                [2.0 * (b * c - a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d + a * b)],
                [2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a - b * b - c * c + d * d],
            ];
            let own: [f64; 3] = core::array::from_fn(|k| (0..3).map(|i| axes[k][i] * spin[i]).sum());
            let m = moments.map(|moment| moment + 1.0 / 40.0);
            let turned: [f64; 3] = core::array::from_fn(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (m[i] - m[j]) * own[i] * own[j] / m[k]
            });
            let acceleration = (0..3).map(|i| (0..3).map(|k| axes[k][i] * turned[k]).sum());
            let expected: Vec<f64> = twice.iter().map(|e| e / 2.0).chain(acceleration).collect();
            assert_near(&found, &expected);
        }
    }
}

/// A parallelogram by its angles: the rods may stand along either axis.
#[test]
fn rods_of_a_loop_may_stand_in_any_direction() {
    let text = "system Parallelogram {
        constants { l = 1, g = 10 }
        coordinates { a, b, c }
        let tip = l*vec(cos(a), sin(a)) + 2*vec(cos(b), sin(b));
        holonomic { closed: tip = 2*vec(1, 0) + l*vec(cos(c), sin(c)); }
        parameters { w = dot(a); }
        particles { 1 at l*vec(cos(a), sin(a)); 1 at tip; }
        gravity = vec(0, -g);
    }";
    for angle in [0.5, std::f64::consts::FRAC_PI_2, -std::f64::consts::FRAC_PI_2, 1.5, 2.0] {
        let found = rates(text, |name| match name {
            "l" => 1.0,
            "g" => 10.0,
            "a" | "c" => angle,
            "w" => 0.6,
            _ => 0.0,
        });
        // Both particles move on unit circles: `2 a'' = -2 g cos(a)`.
        assert_near(&found, &[0.6, 0.0, 0.6, -10.0 * angle.cos()]);
    }
}
