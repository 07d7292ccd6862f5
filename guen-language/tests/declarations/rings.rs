//! Mechanisms that close in space, each in several coordinates: Bricard's ring of six hinges at right angles, whose closing equations are one too
//! many, and a platform on six legs. Their rates do not depend on the coordinates.

use guen_language::derive::{DerivedSystem, function};

use crate::common::{derived, evaluated};

type Quaternion = [f64; 4];
type Vector = [f64; 3];

fn product(a: Quaternion, b: Quaternion) -> Quaternion {
    let ([w, x, y, z], [p, q, r, s]) = (a, b);
    [
        w * p - x * q - y * r - z * s,
        w * q + x * p + y * s - z * r,
        w * r - x * s + y * p + z * q,
        w * s + x * r - y * q + z * p,
    ]
}

/// A turn about a coordinate axis.
fn turn(axis: usize, angle: f64) -> Quaternion {
    let mut turn = [(angle / 2.0).cos(), 0.0, 0.0, 0.0];
    turn[axis + 1] = (angle / 2.0).sin();
    turn
}

/// A vector turned.
fn turned(q: Quaternion, [x, y, z]: Vector) -> Vector {
    let [w, a, b, c] = q;
    let [_, x, y, z] = product(product(q, [0.0, x, y, z]), [w, -a, -b, -c]);
    [x, y, z]
}

fn plus(a: Vector, b: Vector, factor: f64) -> Vector {
    [0, 1, 2].map(|k| a[k] + factor * b[k])
}

/// The values of a list of functions where symbols have the values named, and all others `1.3`.
fn at(derived: &DerivedSystem<'_>, name: &str, values: &[(String, f64)]) -> Vec<f64> {
    let value = |symbol| {
        let name = derived.model.bench.graph.symbol_info(symbol).name.as_str();
        values.iter().find(|(known, _)| known == name).map_or(1.3, |(_, value)| *value)
    };
    evaluated(&derived.system, name, value).expect("a function of that name")
}

/// Five rods and the ground. The angles of the hinges at a place of the curve that the mechanism follows.
struct Ring {
    angles: [f64; 5],
}

impl Ring {
    fn new() -> Self {
        let first: f64 = 1.2;
        // (1 + cos)(1 + cos) = 1
        let second = (1.0 / (1.0 + first.cos()) - 1.0).acos();
        Ring { angles: [first, second, first, second, first] }
    }

    /// The turns of the rods.
    fn turns(&self) -> [Quaternion; 5] {
        let right = core::f64::consts::FRAC_PI_2;
        let mut frame = turn(2, self.angles[0]);
        [0, 1, 2, 3, 4].map(|k| {
            if k > 0 {
                let twist = if k % 2 == 1 { right } else { -right };
                frame = product(frame, product(turn(0, twist), turn(2, self.angles[k])));
            }
            frame
        })
    }

    /// The ends of the rods.
    fn ends(&self) -> [Vector; 5] {
        let mut end = [0.0; 3];
        self.turns().map(|turn| {
            end = plus(end, turned(turn, [1.0, 0.0, 0.0]), 1.3);
            end
        })
    }
}

/// One line for each of the rods, with `#` for its number and `@` for that of the one before.
fn rods(first: usize, line: &str, gap: &str) -> String {
    let own = |i: usize| line.replace('#', &i.to_string()).replace('@', &(i - 1).to_string());
    (first..=5).map(own).collect::<Vec<_>>().join(gap)
}

const CONSTANTS: &str = "constants { m > 0, l > 0, g = 9.81 }";
const BODIES: &str =
    "B# { mass: m, inertia: diag(0, m*l^2/12, m*l^2/12), center: p# - l/2*R#.x, orientation: R# }";
const HINGES: &str = "across#: inner(R#.z, R@.z) = 0; along#: inner(R#.z, R@.x) = 0;";

/// In the angles of the hinges, with all closing equations.
fn in_angles() -> String {
    format!(
        "pub system Ring {{
            {CONSTANTS}
            coordinates {{ q1, q2, q3, q4, q5 }}
            let R1 = rot_z(q1);
            let R2 = R1*rot_x(pi/2)*rot_z(q2); let R3 = R2*rot_x(-pi/2)*rot_z(q3);
            let R4 = R3*rot_x(pi/2)*rot_z(q4); let R5 = R4*rot_x(-pi/2)*rot_z(q5);
            let p0 = vec(0, 0, 0); {}
            bodies {{ {} }}
            gravity = vec(0, -g, 0);
            parameters {{ turn = dot(q1); }}
            holonomic {{ end: p5 = vec(-l, 0, 0); across: R5.y.x = 0; side: R5.y.z = 0; }}
        }}",
        rods(1, "let p# = p@ + l*R#.x;", " "),
        rods(1, BODIES, " "),
    )
}

/// With a quaternion for each rod: twenty coordinates.
fn in_quaternions() -> String {
    format!(
        "pub system Ring {{
            {CONSTANTS}
            coordinates {{ {} }}
            let p0 = vec(0, 0, 0); {}
            bodies {{ {} }}
            gravity = vec(0, -g, 0);
            parameters {{ turn = angular_velocity_body(R1).z; }}
            holonomic {{
                {} across1: R1.z.x = 0; along1: R1.z.y = 0; {}
                end: p5 = vec(-l, 0, 0); across: R5.y.x = 0; side: R5.y.z = 0;
            }}
        }}",
        rods(1, "w#, x#, y#, z#", ", "),
        rods(1, "let R# = quaternion(w#, x#, y#, z#); let p# = p@ + l*R#.x;", " "),
        rods(1, BODIES, " "),
        rods(1, "unit#: w#^2 + x#^2 + y#^2 + z#^2 = 1;", " "),
        rods(2, HINGES, " "),
    )
}

/// With a quaternion and the centre of each rod: 35 coordinates, and 34 equations or one more.
fn in_centres(side: &str) -> String {
    format!(
        "pub system Ring {{
            {CONSTANTS}
            coordinates {{ {} }}
            {}
            bodies {{ {} }}
            gravity = vec(0, -g, 0);
            parameters {{ turn = angular_velocity_body(R1).z; }}
            holonomic {{
                {}
                pin1: c1 - l/2*R1.x = vec(0, 0, 0); across1: R1.z.x = 0; along1: R1.z.y = 0; {} {}
                end: c5 + l/2*R5.x = vec(-l, 0, 0); across: R5.y.x = 0; {side}
            }}
        }}",
        rods(1, "a#, b#, d#, w#, x#, y#, z#", ", "),
        rods(1, "let R# = quaternion(w#, x#, y#, z#); let c# = vec(a#, b#, d#);", " "),
        rods(1, &BODIES.replace("p# - l/2*R#.x", "c#"), " "),
        rods(1, "unit#: w#^2 + x#^2 + y#^2 + z#^2 = 1;", " "),
        rods(2, "pin#: c# - l/2*R#.x = c@ + l/2*R@.x;", " "),
        rods(2, HINGES, " "),
    )
}

/// In natural coordinates, the places of the joints and the axes of the hinges: 24 coordinates and as many equations.
fn in_places_and_axes() -> String {
    let rod = |i: usize| {
        let (a, b) = if i % 2 == 1 { (i, i + 1) } else { (i + 1, i) };
        let (before, next) = (i - 1, i + 1);
        format!("rod{i}: p{i} - p{before} = l*cross(h{a}, h{b}); twist{i}: inner(h{i}, h{next}) = 0;")
    };
    let list = |entry: &dyn Fn(usize) -> String, numbers: core::ops::RangeInclusive<usize>, gap: &str| {
        numbers.map(entry).collect::<Vec<_>>().join(gap)
    };
    format!(
        "pub system Ring {{
            {CONSTANTS}
            coordinates {{ {}, {} }}
            let p0 = vec(0, 0, 0); let p5 = vec(-l, 0, 0); let h1 = vec(0, 0, 1); let h6 = vec(0, -1, 0);
            {} {}
            kinetic_energy = m/6*({} + {});
            potential_energy = m*g*(y1 + y2 + y3 + y4);
            parameters {{ turn = (x1*dot(y1) - y1*dot(x1))/l^2; }}
            holonomic {{ {} {} }}
        }}",
        list(&|i| format!("x{i}, y{i}, z{i}"), 1..=4, ", "),
        list(&|i| format!("a{i}, b{i}, d{i}"), 2..=5, ", "),
        list(&|i| format!("let p{i} = vec(x{i}, y{i}, z{i});"), 1..=4, " "),
        list(&|i| format!("let h{i} = vec(a{i}, b{i}, d{i});"), 2..=5, " "),
        list(&|i| format!("2*inner(dot(p{i}), dot(p{i}))"), 1..=4, " + "),
        list(&|i| format!("inner(dot(p{i}), dot(p{}))", i + 1), 1..=3, " + "),
        list(&|i| format!("unit{i}: inner(h{i}, h{i}) = 1;"), 2..=5, " "),
        list(&rod, 1..=5, " "),
    )
}

#[test]
fn bricard_s_ring_moves_alike_in_all_coordinates() {
    let ring = Ring::new();
    let (turns, ends) = (ring.turns(), ring.ends());
    let mut values = vec![("g".to_owned(), 9.81), ("turn".to_owned(), 0.7)];
    let mut places = values.clone();
    let name = |values: &mut Vec<(String, f64)>, letters: [&str; 3], i: usize, vector: Vector| {
        values.extend(letters.iter().zip(vector).map(|(letter, value)| (format!("{letter}{i}"), value)));
    };
    for (i, (turn, end)) in (1..).zip(turns.into_iter().zip(ends)) {
        let [w, x, y, z] = turn;
        values.extend([(format!("w{i}"), w), (format!("q{i}"), ring.angles[i - 1])]);
        name(&mut values, ["x", "y", "z"], i, [x, y, z]);
        name(&mut values, ["a", "b", "d"], i, plus(end, turned(turn, [1.0, 0.0, 0.0]), -0.65));
        name(&mut places, ["x", "y", "z"], i, end);
        name(&mut places, ["a", "b", "d"], i, turned(turn, [0.0, 0.0, 1.0]));
    }
    let acceleration = |text: &str, redundant: usize, values: &[(String, f64)]| {
        derived(text, |derived| {
            assert_eq!(derived.model.redundant.len(), redundant);
            assert_eq!(derived.system.derivation.system.forms.degrees, 1);
            let residuals = at(derived, function::POSITIONS, values);
            assert!(residuals.iter().all(|left| left.abs() < 1e-14), "{residuals:?}");
            let rates = at(derived, function::RHS, values);
            // The rates of the coordinates lead along the equations.
            let mut moved = values.to_vec();
            let coordinates = derived.model.coordinates.iter().map(|own| own.name.to_string());
            for (name, rate) in coordinates.zip(&rates) {
                let own = moved.iter_mut().find(|(known, _)| *known == name);
                own.expect("every coordinate has a value").1 += 1e-6 * rate;
            }
            let left = at(derived, function::POSITIONS, &moved);
            assert!(left.iter().all(|left| left.abs() < 1e-10), "{left:?}");
            *rates.last().expect("the rate of the parameter")
        })
    };
    let expected = acceleration(&in_angles(), 1, &values);
    let found = [
        acceleration(&in_quaternions(), 1, &values),
        acceleration(&in_centres(""), 0, &values),
        acceleration(&in_centres("side: R5.y.z = 0;"), 1, &values),
        acceleration(&in_places_and_axes(), 1, &places),
    ];
    for found in found {
        assert!((found - expected).abs() < 1e-11 * expected.abs(), "{found} instead of {expected}");
    }
}

/// A platform on six legs of two bodies each, which a force makes longer; its place by angles or by a quaternion.
fn platform(coordinates: &str, orientation: &str, unit: &str) -> String {
    let legs = |line: &str| {
        let own = |i: usize| {
            let side = if i.is_multiple_of(2) { "-" } else { "" };
            line.replace('#', &i.to_string())
                .replace('~', side)
                .replace('@', &(2 * ((i - 1) / 2)).to_string())
        };
        (1..=6).map(own).collect::<Vec<_>>().join(" ")
    };
    let names = (1..=6).map(|i| format!("p{i}, r{i}, s{i}")).collect::<Vec<_>>().join(", ");
    format!(
        "pub system Platform {{
            constants {{ m > 0, A > 0, B > 0, C > 0, a > 0, b > 0, ml > 0, mu > 0, J > 0, K > 0, h > 0, g = 9.81 }}
            inputs {{ u1, u2, u3, u4, u5, u6 }}
            coordinates {{ x, y, z, {coordinates}, {names} }}
            let c = vec(x, y, z);
            let P = {orientation};
            {}
            bodies {{
                top {{ mass: m, inertia: diag(A, B, C), center: c, orientation: P }}
                {}
            }}
            gravity = vec(0, 0, -g);
            parameters {{ v = dot(c); w = angular_velocity_body(P); }}
            holonomic {{ {unit} {} }}
            forces {{ {} }}
        }}",
        legs(
            "let f# = rot_z(@*pi/3)*vec(24/25*a, ~(7/25*a), 0); let t# = c + P*rot_z(@*pi/3)*vec(3/5*b, ~(4/5*b), 0); \
             let L# = rot_x(p#)*rot_y(r#);"
        ),
        legs(
            "lower# { mass: ml, inertia: diag(J, J, K), center: f# + h*L#.z, orientation: L# } \
             upper# { mass: mu, inertia: diag(J, J, K), center: f# + (s# - h)*L#.z, orientation: L# }"
        ),
        legs("leg#: f# + s#*L#.z = t#;"),
        legs("u# along dot(s#);"),
    )
}

#[test]
fn a_platform_on_six_legs_moves_alike_by_angles_and_by_a_quaternion() {
    let (yaw, pitch, roll) = (0.3, -0.2, 0.25);
    let orientation = product(product(turn(2, yaw), turn(1, pitch)), turn(0, roll));
    let [qw, qx, qy, qz] = orientation;
    let place = [0.2, -0.1, 2.1];
    let number = |name: &str, value: f64| (name.to_owned(), value);
    let mut values = vec![
        number("g", 9.81),
        number("a", 1.3),
        number("b", 0.8),
        number("h", 0.4),
        number("yaw", yaw),
        number("pitch", pitch),
        number("roll", roll),
        number("qw", qw),
        number("qx", qx),
        number("qy", qy),
        number("qz", qz),
    ];
    values.extend(["x", "y", "z"].iter().zip(place).map(|(name, value)| number(name, value)));
    for (k, name) in ["v_x", "v_y", "v_z", "w_x", "w_y", "w_z"].iter().enumerate() {
        values.push(number(name, 0.4 - 0.15 * k as f64));
        values.push((format!("u{}", k + 1), 3.0 + k as f64));
    }
    for i in 1..=6 {
        let side = if i % 2 == 0 { -1.0 } else { 1.0 };
        let sector = turn(2, ((i - 1) / 2) as f64 * 2.0 * core::f64::consts::FRAC_PI_3);
        let foot = turned(sector, [24.0 / 25.0 * 1.3, side * 7.0 / 25.0 * 1.3, 0.0]);
        let tip = turned(product(orientation, sector), [0.6 * 0.8, side * 0.8 * 0.8, 0.0]);
        let [x, y, z] = plus(plus(place, tip, 1.0), foot, -1.0);
        let length = (x * x + y * y + z * z).sqrt();
        values.push((format!("p{i}"), (-y).atan2(z)));
        values.push((format!("r{i}"), (x / length).asin()));
        values.push((format!("s{i}"), length));
    }
    let rates = |text: &str| {
        derived(text, |derived| {
            assert!(derived.model.redundant.is_empty());
            let residuals = at(derived, function::POSITIONS, &values);
            assert!(residuals.iter().all(|left| left.abs() < 1e-14), "{residuals:?}");
            let rates = at(derived, function::RHS, &values);
            rates[rates.len() - 6..].to_vec()
        })
    };
    let by_angles = rates(&platform("yaw, pitch, roll", "rot_z(yaw)*rot_y(pitch)*rot_x(roll)", ""));
    let unit = "length: qw^2 + qx^2 + qy^2 + qz^2 = 1;";
    let by_quaternion = rates(&platform("qw, qx, qy, qz", "quaternion(qw, qx, qy, qz)", unit));
    for (a, b) in by_angles.iter().zip(&by_quaternion) {
        assert!((a - b).abs() < 1e-11 * a.abs().max(1.0), "{by_angles:?} {by_quaternion:?}");
    }
}

/// Along the edges of a cube, where the cosines of all angles vanish, nothing is divided by one of them. The parameter goes all ways round
/// the curve of the positions; it grows by `2/5 g/l`.
#[test]
fn a_ring_along_the_edges_of_a_cube_divides_by_no_cosine() {
    let round = "turn = sin(q1)*(1 + cos(q2))*dot(q2) - sin(q2)*(1 + cos(q1))*dot(q1);";
    derived(&in_angles().replace("turn = dot(q1);", round), |derived| {
        assert!(derived.system.derivation.is_by("bodies"));
        let right = core::f64::consts::FRAC_PI_2;
        let angles: Vec<_> = (1..=5).map(|i| (format!("q{i}"), right)).collect();
        let rates =
            |turn: f64| at(derived, function::RHS, &[&angles[..], &[("turn".to_owned(), turn)]].concat());
        let moving = rates(1.0);
        for (rate, expected) in moving.iter().zip([-0.5, 0.5, -0.5, 0.5, -0.5]) {
            assert!((rate - expected).abs() < 1e-12, "{moving:?}");
        }
        // With g = l.
        assert!((rates(0.0)[5] - 0.4).abs() < 1e-12, "{:?}", rates(0.0));
    });
}
