//! Cars keep their digits: the rate of the heading where they are nearly steered straight, the acceleration of the steering
//! where they nearly turn on the spot, and the rates of trailers that are nearly in line, however far behind.

use crate::common::{derived, evaluated};
use guen_language::derive::function;
use guen_symbolic::SymbolId;

/// A car, its mass above the middle of the rear axle, and so many trailers.
fn car(trailers: usize) -> String {
    let mut parts: [String; 4] = Default::default();
    for i in 1..=trailers {
        let before = if i == 1 { "rear".to_owned() } else { format!("axle{}", i - 1) };
        parts[0] += &format!(", q{i}");
        parts[1] += &format!("let axle{i} = {before} - d*vec(cos(q{i}), sin(q{i}));\n");
        parts[2] += &format!("hitch{i}: inner(vec(-sin(q{i}), cos(q{i})), dot(axle{i})) = 0;\n");
        parts[3] += &format!(" + M/2*inner(dot(axle{i}), dot(axle{i}))");
    }
    let [angles, axles, hitches, energy] = parts;
    format!(
        "system Car {{
            constants {{ m > 0, J > 0, I > 0, l > 0, M > 0, d > 0 }}
            coordinates {{ x, y, heading, steering{angles} }}
            parameters {{ speed = dot(x)*cos(heading) + dot(y)*sin(heading); turning = dot(steering); }}
            let rear = vec(x, y);
            let front = rear + l*vec(cos(heading), sin(heading));
            {axles}
            constraints {{
                rear_axle: dot(x)*sin(heading) - dot(y)*cos(heading) = 0;
                front_axle: inner(vec(-sin(heading + steering), cos(heading + steering)), dot(front)) = 0;
                {hitches}
            }}
            kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + J/2*dot(heading)^2
                           + I/2*(dot(heading) + dot(steering))^2{energy};
        }}"
    )
}

const M: f64 = 3.0;
const J: f64 = 2.0;
const L: f64 = 2.0;
const HEADING: f64 = 1.75;
const SPEED: f64 = 0.7;
const TURNING: f64 = -0.3;

/// The rates of a car where it is steered like each of these.
fn rates(trailers: usize, steering: &[f64]) -> Vec<Vec<f64>> {
    rates_of(&car(trailers), steering, |steering, name| match name {
        "heading" => HEADING,
        "steering" => *steering,
        "speed" => SPEED,
        "turning" => TURNING,
        "m" => M,
        "J" => J,
        "l" => L,
        "I" => 0.125,
        "M" => 1.25,
        "d" => 1.5,
        "q1" => -0.4,
        "q2" => 0.9,
        _ => 2.1,
    })
}

/// The rates of a declared system at each of some places, where its symbols have these values. Derived once: that takes longest.
fn rates_of<P>(text: &str, places: &[P], value: impl Fn(&P, &str) -> f64) -> Vec<Vec<f64>> {
    derived(text, |derived| {
        let graph = &derived.model.bench.graph;
        let rates = |place: &P| {
            let value = |symbol: SymbolId| value(place, &graph.symbol_info(symbol).name);
            evaluated(&derived.system, function::RHS, value).expect("rates")
        };
        places.iter().map(rates).collect()
    })
}

#[test]
fn the_heading_turns_by_the_steering_angle_alone() {
    for trailers in [0, 1, 3] {
        let angles = [1e-9_f64, -1e-5, 0.4, 1.55];
        for (steering, found) in angles.into_iter().zip(rates(trailers, &angles)) {
            let error = (found[2] / (SPEED * steering.tan() / L) - 1.0).abs();
            assert!(error < 1e-15, "{trailers} trailers at {steering}: {error:e}");
        }
    }
}

#[test]
fn the_steering_of_a_car_that_turns_on_the_spot_keeps_its_digits() {
    let distances = [1e-1_f64, 1e-4, 1e-8];
    let angles = distances.map(|distance| std::f64::consts::FRAC_PI_2 - distance);
    for ((distance, steering), found) in distances.into_iter().zip(angles).zip(rates(0, &angles)) {
        let (sine, cosine) = steering.sin_cos();
        // m v' + J k (k v)' = 0 and (k v + turning)' = 0 with k = tan(steering)/l, multiplied by cos^2.
        let inertia = M * cosine * cosine + J * (sine / L).powi(2);
        let expected = -SPEED * TURNING / L * M / inertia;
        let error = (found.last().unwrap() / expected - 1.0).abs();
        assert!(error < 1e-14, "{distance:e} from the edge: {error:e}");
    }
}

/// How constraints of a train are written.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Written {
    /// By headings.
    Headings,
    /// By the angles at the hitches.
    Bends,
    /// By the rates of all headings and the angles between them, the last constraint first.
    MultipliedOut,
}

/// A car that is turned by hand, and trailers hitched so far behind the axle before, each with a load ahead of its axle.
fn train(trailers: usize, written: Written) -> String {
    let (mut angles, mut lets, mut energy) = (String::new(), String::new(), String::new());
    let mut constraints: Vec<String> = Vec::new();
    let mut heading = "heading".to_owned();
    // The links so far: lengths and headings.
    let mut links: Vec<(char, String)> = Vec::new();
    for i in 1..=trailers {
        let before = if i == 1 { "vec(x, y)".to_owned() } else { format!("axle{}", i - 1) };
        let own = if written == Written::Bends { format!("{heading} + q{i}") } else { format!("q{i}") };
        let [fore, aft] = [&heading, &own].map(|angle| format!("vec(cos({angle}), sin({angle}))"));
        angles += &format!(", q{i}");
        lets += &format!("let axle{i} = {before} - b*{fore} - d*{aft};\n");
        links.extend([('b', heading), ('d', own.clone())]);
        let across = if written == Written::MultipliedOut {
            let turn =
                |(length, angle): &(char, String)| format!(" - {length}*cos({angle} - {own})*dot({angle})");
            let turns: String = links.iter().map(turn).collect();
            format!("dot(y)*cos({own}) - dot(x)*sin({own}){turns}")
        } else {
            format!("inner(vec(-sin({own}), cos({own})), dot(axle{i}))")
        };
        constraints.insert(0, format!("hitch{i}: {across} = 0;\n"));
        energy +=
            &format!(" + M/2*inner(dot(axle{i} + d/3*{aft}), dot(axle{i} + d/3*{aft})) + J/2*dot({own})^2");
        heading = own;
    }
    if written != Written::MultipliedOut {
        constraints.reverse();
    }
    format!(
        "system Train {{
            constants {{ M > 0, J > 0, d > 0, b >= 0 }}
            coordinates {{ x, y, heading{angles} }}
            parameters {{ speed = dot(x)*cos(heading) + dot(y)*sin(heading); turning = dot(heading); }}
            {lets}
            constraints {{
                rear_axle: dot(x)*sin(heading) - dot(y)*cos(heading) = 0;
                {}
            }}
            kinetic_energy = M/2*(dot(x)^2 + dot(y)^2) + J/2*dot(heading)^2{energy};
        }}",
        constraints.concat()
    )
}

#[test]
fn trailers_nearly_in_line_turn_by_the_angles_between_them() {
    const ANGLES: [f64; 6] = [HEADING, 1.8, 1.79, 0.0964, 0.0956, 0.0952];
    const LENGTH: f64 = 1.5;
    const HITCHES: [f64; 2] = [0.0, 0.25];
    for written in [Written::Headings, Written::Bends, Written::MultipliedOut] {
        let bend = |i: usize| match written {
            Written::Bends => [0.05, -0.01, -1.7, -8e-4, -4e-4][i - 1],
            _ => ANGLES[i] - ANGLES[i - 1],
        };
        let rates = rates_of(&train(5, written), &HITCHES, |hitch, name| match name {
            "heading" => HEADING,
            "speed" => SPEED,
            "turning" => TURNING,
            "M" => M,
            "J" => J,
            "d" => LENGTH,
            "b" => *hitch,
            _ => {
                let Some(Ok(i)) = name.strip_prefix('q').map(str::parse::<usize>) else { return 0.0 };
                if written == Written::Bends { bend(i) } else { ANGLES[i] }
            }
        });
        for (hitch, found) in HITCHES.into_iter().zip(rates) {
            // The speed of an axle, and how its link turns.
            let (mut speed, mut turning) = (SPEED, TURNING);
            for i in 1..=5 {
                let (sine, cosine) = (-bend(i)).sin_cos();
                let across = speed * sine - hitch * turning * cosine;
                let own = across / LENGTH;
                speed = speed * cosine + hitch * turning * sine;
                let expected = if written == Written::Bends { own - turning } else { own };
                turning = own;
                let error = (found[2 + i] / expected - 1.0).abs();
                assert!(error < 5e-15, "{written:?}, hitch at {hitch}, trailer {i}: {error:e}");
            }
        }
    }
}
