//! Readings of accelerometers and gyroscopes on bodies: their operations beside those of the rates, and their values: each acceleration is the
//! difference quotient of its velocity along the motion.

use std::fmt::Write;

use guen_language::derive::DerivedSystem;
use guen_language::derive::function::{OUTPUTS, POSITIONS, RHS};
use guen_symbolic::{ExprId, SymbolId, evaluate_function, evaluate_prepare};

use crate::lines::{counts, derived, six};

/// A chain of so many links about all three axes in turn, with a line for each of its parts.
fn chain(links: usize, base: &str, items: &str) -> String {
    let mut text = format!("let R0 = {base}; let p0 = vec(0, 0, 0);");
    let mut bodies = String::new();
    for i in 0..links {
        let (next, axis) = (i + 1, ['z', 'y', 'x'][i % 3]);
        let _ = write!(
            text,
            "let R{next} = R{i}*rot_{axis}(q{next}); let p{next} = p{i} + R{next}*vec(l, 0, l/3);"
        );
        let _ = write!(
            bodies,
            "b{next} {{ mass: m, center: (p{i} + p{next})/2, inertia: diag(J, 2*J, 3*J), orientation: R{next} }}"
        );
    }
    let angles: Vec<String> = (1..=links).map(|i| format!("q{i}")).collect();
    format!(
        "pub system Chain {{ constants {{ l > 0 = 0.4, m > 0 = 1.1, J > 0 = 0.05, g = 9.81 }} coordinates {{ {} }} \
         {text} bodies {{ {bodies} }} gravity = vec(0, 0, -g); {items} }}",
        angles.join(", ")
    )
}

/// A body that floats and carries two links.
fn floating(angles: &str, orientation: &str, holonomic: &str) -> String {
    format!(
        "pub system Floating {{
            constants {{ l > 0 = 0.4, m > 0 = 1.1, M > 0 = 3, J > 0 = 0.05, A > 0 = 0.3, B > 0 = 0.4, C > 0 = 0.5, g = 9.81 }}
            coordinates {{ x, y, z, {angles}, a, b }}
            let R0 = {orientation}; let R1 = R0*rot_z(a); let R2 = R1*rot_y(b);
            let p0 = vec(x, y, z); let p1 = p0 + R1*vec(l, 0, l/3); let p2 = p1 + R2*vec(l, 0, l/3);
            {holonomic}
            bodies {{
                base {{ mass: M, center: p0, inertia: diag(A, B, C), orientation: R0 }}
                b1 {{ mass: m, center: (p0 + p1)/2, inertia: diag(J, 2*J, 3*J), orientation: R1 }}
                b2 {{ mass: m, center: (p1 + p2)/2, inertia: diag(J, 2*J, 3*J), orientation: R2 }}
            }}
            gravity = vec(0, 0, -g);
            parameters {{ v = transpose(R0)*dot(p0); w = angular_velocity_body(R0); wa = dot(a); wb = dot(b); }}
            outputs {{ tip1 = dot(p2); tip2 = dot(dot(p2)); turn1 = angular_velocity(R2); turn2 = dot(angular_velocity(R2)); }}
        }}"
    )
}

/// Names with declarations. The digit at the end of an output's name counts derivatives: `p2` is the rate of `p1`.
fn systems() -> Vec<(&'static str, String)> {
    let tip = "outputs { tip0 = p5; tip1 = dot(p5); tip2 = dot(dot(p5)); }";
    let imu = "inputs { u } forces { u*sin(t) along dot(q2); }
        outputs { felt1 = inner(dot(p6), R6.x); felt2 = dot(inner(dot(p6), R6.x)); turn1 = angular_velocity(R6); turn2 = dot(angular_velocity(R6));
            gyro1 = angular_velocity_body(R6); gyro2 = dot(angular_velocity_body(R6)); far0 = norm(p4); far1 = dot(norm(p4)); far2 = dot(dot(norm(p4))); }";
    let euler = "rot_z(yaw)*rot_y(pitch)*rot_x(roll)";
    let unit = "holonomic { length: qw^2 + qx^2 + qy^2 + qz^2 = 1; }";
    let texts = [
        ("rocking", chain(5, "rot_x(sin(t))*rot_y(cos(t))", tip)),
        ("imu", chain(6, "rot_z(0)", imu)),
        ("floating", floating("yaw, pitch, roll", euler, "")),
        ("floating-q", floating("qw, qx, qy, qz", "quaternion(qw, qx, qy, qz)", unit)),
        (
            "tree",
            "pub system Tree {
                constants { l > 0 = 0.4, m > 0 = 1.1, J > 0 = 0.05, k > 0 = 100, g = 9.81 }
                coordinates { a, b, c, d, e, s }
                let R0 = rot_z(a); let R1 = R0*rot_x(b); let R2 = R1*rot_y(c); let R3 = R0*rot_y(d); let R4 = R3*rot_x(e);
                let p1 = R0*vec(l, 0, 0); let p2 = p1 + R1*vec(0, l, l/2); let p3 = p1 + R0*vec(0, l, 0);
                let p4 = p3 + R3*vec(l + s, 0, l/2); let p5 = p2 + R2*vec(l, l/3, l/2); let p6 = p4 + R4*vec(0, l, 0);
                bodies {
                    b0 { mass: m, center: p1/2, inertia: diag(J, 2*J, 3*J), orientation: R0 }
                    b1 { mass: m, center: (p1 + p2)/2, inertia: diag(2*J, J, 3*J), orientation: R1 }
                    b2 { mass: m, center: (p2 + p5)/2, inertia: diag(2*J, J, 2*J), orientation: R2 }
                    b3 { mass: m, center: p4, inertia: diag(2*J, J, 2*J), orientation: R3 }
                    b4 { mass: m, center: (p4 + p6)/2, inertia: diag(2*J, J, 2*J), orientation: R4 }
                }
                gravity = vec(0, 0, -g);
                forces { -k*(norm(p5 - p6) - l) along dot(norm(p5 - p6)); }
                outputs { gap1 = dot(p5 - p6); gap2 = dot(dot(p5 - p6)); far1 = dot(norm(p5 - p6)); far2 = dot(dot(norm(p5 - p6))); }
            }"
            .to_owned(),
        ),
        (
            "disc",
            "pub system Disc {
                constants { r > 0 = 0.3, m > 0 = 1.1, J > 0 = 0.05, K > 0 = 0.04, g = 9.81 }
                coordinates { x, y, yaw, lean, spin }
                let A = rot_z(yaw)*rot_x(lean); let R = A*rot_y(spin); let c = vec(x, y, 0) + r*A.z;
                bodies { disc { mass: m, center: c, inertia: diag(J, K, J), orientation: R } }
                constraints { rolls: disc.velocity_at(c - r*A.z) = vec(0, 0, 0); }
                gravity = vec(0, 0, -g);
                parameters { w1 = dot(yaw); w2 = dot(lean); w3 = dot(spin); }
                outputs { hub1 = dot(c); hub2 = dot(dot(c)); rim1 = disc.velocity_at(c + r*R.x); rim2 = dot(disc.velocity_at(c + r*R.x)); }
            }"
            .to_owned(),
        ),
        (
            "crank",
            "pub system Crank {
                constants { a > 0 = 0.3, b > 0 = 0.8, c > 0 = 0.7, d > 0 = 0.9, m > 0 = 1.1, J > 0 = 0.05, g = 9.81 }
                coordinates { q1, q2, q3 }
                let R1 = rot_z(q1); let R2 = rot_z(q2); let R3 = rot_z(q3);
                let A = a*R1.x; let B = A + b*R2.x; let C = vec(d, 0, 0) + c*R3.x; let P = B + R2*vec(0.1, 0.2, 0);
                bodies {
                    b1 { mass: m, center: A/2, inertia: diag(J, J, J), orientation: R1 }
                    b2 { mass: m, center: (A + B)/2, inertia: diag(J, J, J), orientation: R2 }
                    b3 { mass: m, center: vec(d, 0, 0) + c/2*R3.x, inertia: diag(J, J, J), orientation: R3 }
                }
                holonomic { level: (B - C).x = 0; upright: (B - C).y = 0; }
                gravity = vec(0, -g, 0);
                parameters { w = dot(q1); }
                outputs { at1 = dot(P); at2 = dot(dot(P)); rocker1 = dot(q3); rocker2 = dot(dot(q3)); }
            }"
            .to_owned(),
        ),
        (
            "spinner",
            "pub system Spinner {
                constants { k > 0 = 50, l > 0 = 0.4, m > 0 = 1.1, W = 2, J > 0 = 0.02, g = 9.81 }
                coordinates { s, a, b, e }
                let R = rot_z(W*t + e); let S = R*rot_y(a); let T = S*rot(unit(vec(1, 2, -2)), b);
                let o = vec(sin(3*t)/5, 0, t^2/10); let p = o + S*vec(l + s, 0, 0); let c = p + T*vec(0, l, 0.1);
                bodies {
                    table { mass: m, center: o, inertia: diag(J, J, 5*J), orientation: R }
                    slide { mass: 2*m, center: p, inertia: diag(J, J, J), orientation: S }
                    load { mass: m, center: c, inertia: diag(J, 2*J, 3*J), orientation: T }
                }
                forces { -k*s along dot(s); }
                gravity = vec(0, 0, -g);
                outputs { pay0 = c; pay1 = dot(c); pay2 = dot(dot(c)); gyro1 = angular_velocity_body(T); gyro2 = dot(angular_velocity_body(T));
                    fast1 = exp(-norm(dot(p))/9); fast2 = dot(exp(-norm(dot(p))/9)); }
            }"
            .to_owned(),
        ),
        (
            "segway",
            "pub system Segway {
                constants { r > 0 = 0.1, m > 0 = 5, M > 0 = 1, h > 0 = 0.4, b > 0 = 0.3, A > 0 = 0.2, B > 0 = 0.3, C > 0 = 0.1,
                    W > 0 = 0.01, V > 0 = 0.02, g = 9.81 }
                coordinates { x, y, yaw, pitch, left, right }
                let H = rot_z(yaw); let P = H*rot_y(pitch); let L = H*rot_y(left); let Q = H*rot_y(right);
                let o = vec(x, y, r); let c = o + h*P.z; let top = c + P*vec(0.05, 0.02, 0.3);
                bodies {
                    body { mass: m, center: c, inertia: diag(A, B, C), orientation: P }
                    wl { mass: M, center: o + b*H.y, inertia: diag(W, V, W), orientation: L }
                    wr { mass: M, center: o - b*H.y, inertia: diag(W, V, W), orientation: Q }
                }
                constraints {
                    rolls_left: inner(wl.velocity_at(wl.center - vec(0, 0, r)), H.x) = 0;
                    rolls_right: inner(wr.velocity_at(wr.center - vec(0, 0, r)), H.x) = 0;
                    side: inner(dot(o), H.y) = 0;
                }
                parameters { v = inner(dot(o), H.x); w = dot(yaw); th = dot(pitch); }
                gravity = vec(0, 0, -g);
                outputs { top1 = dot(top); top2 = dot(dot(top)); speed1 = v; speed2 = dot(v); }
            }"
            .to_owned(),
        ),
    ];
    texts.into_iter().chain([("rods2-tip", rods())]).collect()
}

/// Two rods on ball joints, each with a quaternion, and what their end does.
fn rods() -> String {
    let text = guen_benchmarks::robots::rods(2, false);
    let end = text.rfind('}').unwrap();
    format!("{} outputs {{ tip1 = dot(e2); tip2 = dot(dot(e2)); }} }}", &text[..end])
}

/// The lines of rates and outputs.
pub fn rows() -> String {
    let row = |(name, text): &(&str, String)| {
        derived(name, text, |derived| {
            let count = |function: &str| counts(six(derived.system.program(function).unwrap().cost));
            let mut lines = format!("{name:11} {}  |\n", count(RHS));
            let _ = writeln!(lines, "{:21} {}  |", format!("{name}/{OUTPUTS}"), count(OUTPUTS));
            lines
        })
    };
    systems().iter().map(row).collect()
}

/// A system as functions of numbers: time, then coordinates and parameters.
struct Numbers<'a, 'b> {
    derived: &'a DerivedSystem<'b>,
    symbols: Vec<(SymbolId, f64)>,
}

impl<'a, 'b> Numbers<'a, 'b> {
    fn new(derived: &'a DerivedSystem<'b>) -> Self {
        let graph = &derived.model.bench.graph;
        let number = |e: ExprId| graph.as_number(e).map(|number| number.to_f64());
        let constants = derived.model.constants.iter().map(|constant| {
            let default = constant.default.and_then(number).unwrap_or(0.9);
            (graph.as_symbol(constant.symbol).unwrap(), default)
        });
        Numbers { derived, symbols: constants.collect() }
    }

    fn values(&self, function: &str, t: f64, state: &[f64]) -> Vec<f64> {
        let derived = self.derived;
        let (graph, mechanics) = (&derived.model.bench.graph, &derived.model.mechanics);
        let (forms, programs) = (&mechanics.forms, &derived.system.programs);
        let etas = &mechanics.etas[..forms.degrees];
        let mut symbols = self.symbols.clone();
        let of = |e: &ExprId| graph.as_symbol(*e).unwrap();
        symbols.extend(forms.coordinates.iter().chain(etas).map(of).zip(state.iter().copied()));
        symbols.push((of(&forms.time), t));
        symbols.extend(mechanics.inputs.iter().map(|input| (of(input), 0.7)));
        let value = |symbol: SymbolId| symbols.iter().find(|(known, _)| *known == symbol).unwrap().1;
        match programs.functions.iter().position(|own| own.name == function) {
            Some(place) => evaluate_function(programs, place, &evaluate_prepare(programs, value), value),
            None => Vec::new(),
        }
    }

    /// The state with coordinates on the constraints: the nearest ones, by steps along the gradients.
    fn settled(&self, t: f64, mut state: Vec<f64>) -> Vec<f64> {
        const SWEEPS: usize = 400;
        let n = self.derived.model.mechanics.forms.coordinates.len();
        for _ in 0..SWEEPS {
            for equation in 0..self.values(POSITIONS, t, &state).len() {
                let residue = |state: &[f64]| self.values(POSITIONS, t, state)[equation];
                let value = residue(&state);
                let slopes: Vec<f64> = (0..n)
                    .map(|i| {
                        let mut other = state.clone();
                        other[i] += 1e-6;
                        (residue(&other) - value) / 1e-6
                    })
                    .collect();
                let square: f64 = slopes.iter().map(|slope| slope * slope).sum();
                state.iter_mut().zip(&slopes).for_each(|(x, slope)| *x -= value * slope / square);
            }
        }
        state
    }

    /// The outputs a while later, or before.
    fn after(&self, t: f64, state: &[f64], h: f64) -> Vec<f64> {
        const STEPS: u32 = 8;
        let (mut t, mut x, h) = (t, state.to_vec(), h / f64::from(STEPS));
        for _ in 0..STEPS {
            let moved = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> {
                x.iter().zip(k).map(|(x, k)| x + h * k).collect()
            };
            let k1 = self.values(RHS, t, &x);
            let k2 = self.values(RHS, t + h / 2.0, &moved(&x, &k1, h / 2.0));
            let k3 = self.values(RHS, t + h / 2.0, &moved(&x, &k2, h / 2.0));
            let k4 = self.values(RHS, t + h, &moved(&x, &k3, h));
            for i in 0..x.len() {
                x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
            t += h;
        }
        self.values(OUTPUTS, t, &x)
    }
}

/// The name of an output without the count of derivatives.
fn stem(name: &str) -> &str {
    name.trim_end_matches(|c: char| c.is_ascii_digit())
}

/// Differences along the motion, of which nothing is known but its rates.
#[test]
fn outputs_are_the_rates_of_those_before_them() {
    const H: f64 = 2e-4;
    for (name, text) in systems() {
        derived(name, &text, |derived| {
            let numbers = Numbers::new(derived);
            let forms = &derived.model.mechanics.forms;
            for sample in 0..3 {
                let place = |i: usize| ((7 * i + 11 * sample + 3) % 17) as f64;
                let state: Vec<f64> =
                    (0..forms.coordinates.len() + forms.degrees).map(|i| place(i) / 11.0 - 0.6).collect();
                let t = 0.3 + sample as f64 / 7.0;
                let state = numbers.settled(t, state);
                let here = numbers.values(OUTPUTS, t, &state);
                let [back, far_back, ahead, far_ahead] =
                    [-H, -2.0 * H, H, 2.0 * H].map(|h| numbers.after(t, &state, h));
                let mut compared = 0;
                for pair in derived.model.outputs.windows(2) {
                    let [before, after] = pair else { unreachable!() };
                    if stem(&before.name.text) != stem(&after.name.text) {
                        continue;
                    }
                    for (i, j) in before.components.iter().zip(&after.components) {
                        let rate =
                            (8.0 * (ahead[*i] - back[*i]) - (far_ahead[*i] - far_back[*i])) / (12.0 * H);
                        let error = (rate - here[*j]).abs() / here[*j].abs().max(1.0);
                        assert!(
                            error < 1e-7,
                            "{name}, {} at {sample}: {rate} and {}",
                            after.name.text,
                            here[*j]
                        );
                        compared += 1;
                    }
                }
                assert!(compared > 0, "{name}");
            }
        });
    }
}

/// An acceleration costs what the rates cost, and a recursion along the bodies.
#[test]
fn an_acceleration_costs_little_more_than_the_rates() {
    for (links, base) in [(3, "rot_z(0)"), (5, "rot_x(sin(t))*rot_y(cos(t))"), (7, "rot_z(0)")] {
        let text = chain(links, base, &format!("outputs {{ tip = dot(dot(p{links})); }}"));
        derived("chain", &text, |derived| {
            let operations = |function: &str| derived.system.program(function).unwrap().cost.operations();
            let (rates, outputs) = (operations(RHS), operations(OUTPUTS));
            let allowed = 13 * rates / 10 + 40 * links as u32;
            assert!(outputs <= allowed, "{links} links: {outputs} beside {rates}");
        });
    }
}
