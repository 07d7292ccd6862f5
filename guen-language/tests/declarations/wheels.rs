//! A car with a trailer on five rolling wheels, in relative and in absolute angles: what is shown of it does not speak of
//! its heading, and its rates are those that a person finds by the energy.

use crate::common::{derived, evaluated};
use guen_language::derive::function;
use guen_symbolic::{SymbolId, evaluate_f64};

/// The trailer's angle is that at the hitch, or its heading.
fn rig(relative: bool) -> String {
    let trailer = if relative { "C*rot_z(trailing)" } else { "rot_z(trailing)" };
    format!(
        "system Rig {{
            constants {{ m > 0, I > 0, w > 0, J > 0, r > 0, l > 0, b > 0, d > 0 }}
            inputs {{ push, handle }}
            coordinates {{ x, y, yaw, steer, trailing, left, right, front, near, off }}
            let up = vec(0, 0, r);
            let C = rot_z(yaw);
            let F = C*rot_z(steer);
            let T = {trailer};
            let rear = vec(x, y, r);
            let nose = rear + l*C.x;
            let axle = rear - d*T.x;
            bodies {{
                car     {{ mass: m, inertia: diag(0, 0, I), center: rear + l/2*C.x, orientation: C }}
                trailer {{ mass: m/2, inertia: diag(0, 0, I/2), center: axle, orientation: T }}
                one     {{ mass: w, inertia: diag(J/2, J, J/2), center: rear + b*C.y, orientation: C*rot_y(left) }}
                two     {{ mass: w, inertia: diag(J/2, J, J/2), center: rear - b*C.y, orientation: C*rot_y(right) }}
                three   {{ mass: w, inertia: diag(J/2, J, J/2), center: nose, orientation: F*rot_y(front) }}
                four    {{ mass: w, inertia: diag(J/2, J, J/2), center: axle + b*T.y, orientation: T*rot_y(near) }}
                five    {{ mass: w, inertia: diag(J/2, J, J/2), center: axle - b*T.y, orientation: T*rot_y(off) }}
            }}
            parameters {{ speed = inner(C.x, dot(rear)); steering = dot(steer); }}
            constraints {{
                rear_axle:    inner(C.y, dot(rear)) = 0;
                front_axle:   inner(F.y, dot(nose)) = 0;
                trailer_axle: inner(T.y, dot(axle)) = 0;
                roll_one:     inner(C.x, one.velocity_at(rear + b*C.y - up)) = 0;
                roll_two:     inner(C.x, two.velocity_at(rear - b*C.y - up)) = 0;
                roll_three:   inner(F.x, three.velocity_at(nose - up)) = 0;
                roll_four:    inner(T.x, four.velocity_at(axle + b*T.y - up)) = 0;
                roll_five:    inner(T.x, five.velocity_at(axle - b*T.y - up)) = 0;
            }}
            forces {{ push along speed; handle along steering; }}
        }}"
    )
}

/// `steer`, the angle at the hitch, `speed`, `steering`, `push`, `handle`.
type State = [f64; 6];

const HEADING: f64 = 0.8;
const M: f64 = 9.0;
const I: f64 = 7.0;
const W: f64 = 0.5;
const J: f64 = 0.25;
const R: f64 = 0.3;
const L: f64 = 2.5;
const B: f64 = 0.8;
const D: f64 = 3.0;

fn value(name: &str, relative: bool, [steer, hitch, speed, steering, push, handle]: State) -> f64 {
    match name {
        "m" => M,
        "I" => I,
        "w" => W,
        "J" => J,
        "r" => R,
        "l" => L,
        "b" => B,
        "d" => D,
        "yaw" => HEADING,
        "steer" => steer,
        "trailing" => hitch + if relative { 0.0 } else { HEADING },
        "speed" => speed,
        "steering" => steering,
        "push" => push,
        "handle" => handle,
        _ => panic!("{name} is not asked for"),
    }
}

/// The rates by hand. With `T = A v^2/2 + J/4 (yaw' + steering)^2` the wheel in front turns by the handle alone, and the energy
/// tells the rest: `A v' = push - handle tan(steer)/l - (A_steer steering + A_hitch hitch') v/2`.
fn by_hand([steer, hitch, speed, steering, push, handle]: State) -> [f64; 12] {
    let (tan, secant) = (steer.tan(), steer.cos().recip());
    let (sin, cos) = hitch.sin_cos();
    let yaw = speed * tan / L;
    let bending = -speed * sin / D - yaw;
    let spin = J / (R * R);
    let of_tan = ((M * L * L / 4.0 + I + J) + 2.0 * (W + spin) * B * B) / (L * L) + W + spin;
    let of_sin = (I / 2.0 + J + 2.0 * (W + spin) * B * B) / (D * D) - (M / 2.0 + 2.0 * W + 2.0 * spin);
    let rest = 1.5 * M + 5.0 * W + 5.0 * spin + of_sin * sin * sin;
    let inertia = rest + of_tan * tan * tan;
    // The rate of `yaw'` is `(v' tan + v steering/cos^2)/l`; what grows without bound in both is left out.
    let turned = speed * secant * secant * steering;
    let others = push - handle * tan / L - speed * of_sin * sin * cos * bending;
    let faster = (others - of_tan * tan * turned) / inertia;
    let turning = (others * tan + rest * turned) / inertia / L;
    [
        speed * HEADING.cos(),
        speed * HEADING.sin(),
        yaw,
        steering,
        bending,
        (speed - B * yaw) / R,
        (speed + B * yaw) / R,
        speed * secant / R,
        speed * (cos + B / D * sin) / R,
        speed * (cos - B / D * sin) / R,
        faster,
        2.0 * handle / J - turning,
    ]
}

#[test]
fn rates_are_those_by_hand() {
    for relative in [true, false] {
        derived(&rig(relative), |derived| {
            let graph = &derived.model.bench.graph;
            for state in [
                [0.3, -0.4, 1.5, 0.7, 2.0, -0.6],
                [-0.9, 1.2, -2.0, 1.1, 0.5, 0.25],
                [1.5, 0.1, 0.5, -0.2, 0.0, 1.0],
                [1e-7, 3.0, 4.0, 0.0, -1.0, 0.0],
                [1.5703, -2.0, 0.1, 0.02, 1.0, 0.5],
            ] {
                let value = |symbol: SymbolId| value(&graph.symbol_info(symbol).name, relative, state);
                let found = evaluated(&derived.system, function::RHS, value).expect("rates");
                // The equations that are shown are those of this motion.
                let accelerations = [("speed'", found[10]), ("steering'", found[11])];
                let moving = |symbol: SymbolId| {
                    let name = &graph.symbol_info(symbol).name;
                    let known = accelerations.iter().find(|(own, _)| own == name);
                    known.map_or_else(|| value(symbol), |(_, acceleration)| *acceleration)
                };
                // About the largest of their terms.
                let scale = (M + I) / state[0].cos().powi(2) * found[10].abs().max(found[11].abs()).max(1.0);
                for (equation, left) in
                    evaluate_f64(graph, &derived.system.equations, &moving).iter().enumerate()
                {
                    assert!(left.abs() <= 1e-13 * scale, "{relative} {state:?} {equation}: {left}");
                }
                let mut expected = by_hand(state);
                if !relative {
                    expected[4] = -state[2] * state[1].sin() / D;
                }
                for (place, (found, expected)) in found.iter().zip(expected).enumerate() {
                    let error = (found - expected).abs();
                    assert!(
                        error <= 1e-13 * expected.abs(),
                        "{relative} {state:?} {place}: {found} {expected}"
                    );
                }
            }
        });
    }
}

#[test]
fn what_is_shown_does_not_speak_of_the_heading() {
    for relative in [true, false] {
        derived(&rig(relative), |derived| {
            let (graph, level) = (&derived.model.bench.graph, &derived.system);
            let energies = &level.derivation.energies;
            let reactions = level.derivation.reactions.iter().flatten();
            let shown = energies.momenta.iter().chain(&level.equations).chain(reactions);
            let shown: Vec<_> = shown.copied().chain([energies.kinetic, energies.integral]).collect();
            let names: Vec<&str> =
                graph.symbols_in(&shown).into_iter().map(|symbol| &*graph.symbol_info(symbol).name).collect();
            assert!(names.contains(&"steer"), "{names:?}");
            assert!(!relative || !names.contains(&"yaw"), "{names:?}");
            assert!(!names.contains(&"x"), "{names:?}");
            // 99 before, in relative angles; in absolute ones the angle at the hitch is a difference of headings.
            let (cost, most) = (level.programs.functions[0].cost, if relative { 56 } else { 58 });
            assert!(cost.operations() <= most && cost.sines <= 3, "{relative} {cost:?}");
        });
    }
}
