//! Rates of coordinates as parameters, next to an edge that they have, or their mass matrix, and the body has not: a quaternion
//! by the rates of three entries, angles by their own rates at a pole.
//!
//! There the mass matrix grows like the inverse square of the distance, and so would the errors of what is solved with it. The
//! accelerations are to be as right as their own condition says, `8 u cond` in every entry, as if the mass matrix had none;
//! velocities and reactions within the bound of `docs/design/rounding.md`. Programs run in doubles and in 71 digits.

use f256::f256;
use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_symbolic::{Arithmetic, ExprId, Rational, SymbolId, evaluate, evaluate_function, evaluate_prepare};

use crate::common::derived;

/// Roundings of the condition that may be lost.
const FACTOR: f64 = 8.0;
/// Reactions are computed from accelerations that are rounded themselves.
const REACTIONS: f64 = 16.0;
/// How far from the edge the first state is, and the factor from one to the next.
const BEGIN: f64 = 0.1;
const NEARER: f64 = 0.35;
const STATES: usize = 12;

fn double(x: f256) -> f64 {
    format!("{x:.30e}").parse().expect("a number")
}

/// Numbers between -2 and 2.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 51) as f64 - 2.0
    }
}

/// A derived system whose programs are evaluated at states. A state is a list of coordinates, parameters and constants.
struct Asked<'a> {
    derived: &'a DerivedSystem<'a>,
    level: &'a DerivedLevel,
    /// The symbols of coordinates, parameters and constants.
    symbols: Vec<SymbolId>,
    accelerations: Vec<SymbolId>,
}

impl<'a> Asked<'a> {
    fn new(derived: &'a DerivedSystem<'a>) -> Self {
        let graph = &derived.model.bench.graph;
        let system = &derived.system.derivation.system;
        let degrees = system.forms.degrees;
        let symbol = |e: &ExprId| graph.as_symbol(*e).expect("a symbol");
        let constants = derived.model.constants.iter().map(|constant| symbol(&constant.symbol));
        let state = system.forms.coordinates.iter().chain(&system.etas[..degrees]).map(symbol);
        Asked {
            derived,
            level: &derived.system,
            symbols: state.chain(constants).collect(),
            accelerations: system.accelerations.iter().map(symbol).collect(),
        }
    }

    /// The rates of the state, then the reactions.
    fn outputs<R: Arithmetic>(&self, z: &[R]) -> Vec<R> {
        let programs = &self.level.programs;
        let time = R::from_rational(&Rational::new(3, 4));
        let mut found: Vec<R> = Vec::new();
        for name in [function::RHS, function::REACTIONS] {
            let Some(place) = programs.functions.iter().position(|own| own.name == name) else { continue };
            let value = |symbol: SymbolId| {
                let own = self.symbols.iter().position(|other| *other == symbol).map(|k| z[k].clone());
                let first = found.len().saturating_sub(self.accelerations.len());
                let rate = self.accelerations.iter().position(|other| *other == symbol);
                own.or(rate.map(|k| found[first + k].clone())).unwrap_or(time.clone())
            };
            let more = evaluate_function(programs, place, &evaluate_prepare(programs, value), value);
            found.extend(more);
        }
        found
    }

    /// The condition of the mass matrix in the largest row sum.
    fn kappa(&self, z: &[f256]) -> f64 {
        let value = |symbol: SymbolId| {
            self.symbols.iter().position(|other| *other == symbol).map_or(f256::ZERO, |k| z[k])
        };
        let mass = self.level.derivation.equations.mass.concat();
        let l = self.accelerations.len();
        let mut m: Vec<Vec<f256>> = evaluate(&self.derived.model.bench.graph, &mass, &value)
            .chunks(l)
            .enumerate()
            .map(|(i, row)| {
                let unit = (0..l).map(|j| if i == j { f256::ONE } else { f256::ZERO });
                row.iter().copied().chain(unit).collect()
            })
            .collect();
        let norm = |m: &[Vec<f256>], columns: std::ops::Range<usize>| {
            let sums =
                m.iter().map(|row| row[columns.clone()].iter().fold(f256::ZERO, |sum, e| sum + e.abs()));
            sums.fold(f256::ZERO, f256::max)
        };
        let size = norm(&m, 0..l);
        // Positive definite: no exchanges.
        for k in 0..l {
            let pivot = m[k][k];
            m[k].iter_mut().for_each(|e| *e /= pivot);
            let own = m[k].clone();
            for (_, row) in m.iter_mut().enumerate().filter(|(i, _)| *i != k) {
                let factor = row[k];
                row.iter_mut().zip(&own).for_each(|(e, above)| *e -= factor * *above);
            }
        }
        double(size * norm(&m, l..2 * l))
    }

    /// Asserts that everything is right at a state.
    fn is_right(&self, name: &str, z: &[f64]) {
        let exact_z: Vec<f256> = z.iter().map(|x| f256::from(*x)).collect();
        let (found, exact) = (self.outputs(z), self.outputs(&exact_z));
        // Differences in 71 digits are derivatives to 25.
        let step = f256::from(1e-25);
        let mut sensitivity = vec![f256::ZERO; exact.len()];
        for k in 0..z.len() {
            let mut moved = exact_z.clone();
            moved[k] *= f256::ONE + step;
            for (sum, (a, b)) in sensitivity.iter_mut().zip(self.outputs(&moved).iter().zip(&exact)) {
                *sum += (*a - *b).abs() / step;
            }
        }
        let kappa = self.kappa(&exact_z);
        let l = self.accelerations.len();
        let velocities = self.level.derivation.system.forms.len();
        for (i, (found, exact)) in found.iter().zip(&exact).enumerate() {
            let error = double((f256::from(*found) - *exact).abs());
            let (condition, size) = (double(sensitivity[i]), double(exact.abs()));
            let allowed = if i < velocities {
                FACTOR * (condition + kappa * size)
            } else if i < velocities + l {
                FACTOR * condition
            } else {
                REACTIONS * (condition + kappa * size)
            };
            assert!(
                error <= allowed * f64::EPSILON / 2.0,
                "{name}: output {i} is off by {error:e} of {size:e}, condition {condition:e}, kappa {kappa:e}, at {z:?}"
            );
        }
    }
}

/// Asserts that a system is right on a way to its edge; `place` puts a random state at a distance from it.
fn right_at_the_edge(name: &str, text: &str, place: impl Fn(&mut [f64], f64)) {
    derived(text, |derived| {
        let asked = Asked::new(derived);
        assert!(derived.system.derivation.is_by("spins"), "{name}");
        let size = asked.symbols.len() - derived.model.constants.len();
        let mut draw = Draw(7);
        let mut distance = BEGIN;
        for _ in 0..STATES {
            let mut z: Vec<f64> = (0..size).map(|_| draw.next()).collect();
            place(&mut z, distance);
            z.extend(derived.model.constants.iter().map(|constant| match constant.name.text.as_str() {
                "m" | "B" => 1.5,
                "a" => 2.0,
                "b" => 0.5,
                "c" => 0.375,
                "A" => 0.25,
                "C" => 1.625,
                "D" => -0.0625,
                "h" => 0.125,
                _ => 9.8125,
            }));
            asked.is_right(name, &z);
            distance *= NEARER;
        }
    });
}

/// A body whose attitude is a quaternion, by the rates of all entries but one.
fn by_three_rates(rest: [&str; 4], left: usize) {
    let [constants, coordinates, body, more] = rest;
    let entries = ["w", "i", "j", "k"];
    let mut names = ["u", "v", "r"].iter();
    let rates = entries.iter().enumerate().filter(|(k, _)| *k != left);
    let rates: String =
        rates.map(|(_, q)| format!("{} = dot({q}); ", names.next().expect("three"))).collect();
    let more = more.replace("parameters {", &format!("parameters {{ {rates}"));
    let text = format!(
        "pub system Body {{
            constants {{ m > 0, A > 0, B > 0, C > 0, {constants} g = 9.81 }}
            coordinates {{ w, i, j, k, {coordinates} }}
            let R = quaternion(w, i, j, k);
            let up = vec(0, 0, 1);
            {body}
            gravity = -g*up;
            {more}
            holonomic {{ length: w^2 + i^2 + j^2 + k^2 = 1; }}
        }}"
    );
    right_at_the_edge(&format!("without {} of {body}", entries[left]), &text, |x, distance| {
        x[left] *= distance;
        let length = x[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
        x[..4].iter_mut().for_each(|q| *q /= length);
    });
}

/// A heavy top, its tip at rest.
const TOP: [&str; 4] = [
    "h,",
    "",
    "bodies { top { mass: m, inertia: diag(A, B, C), center: h*R.z, orientation: R } }",
    "parameters { }",
];

/// A body that flies, described by a point that is not its mass centre.
const FLYING: [&str; 4] = [
    "h,",
    "x, y, z",
    "bodies { stone { mass: m, inertia: diag(A, B, C), center: vec(x, y, z) + h*R.z, orientation: R } }",
    "parameters { vx = dot(x); vy = dot(y); vz = dot(z); }",
];

/// A ball on a belt that goes to and fro, with a torque that is said in a parameter.
const BALL: [&str; 4] = [
    "a > 0, D,",
    "x, y",
    "bodies { ball { mass: m, inertia: diag(A, B, C), center: vec(x, y, a), orientation: R } }",
    "parameters { }
     constraints { rolling: ball.velocity_at(vec(x, y, 0)) = vec(B*cos(C*t), 0, 0); }
     forces { D*u*R.x along ball.angular_velocity; }",
];

/// A disc that rolls on its rim.
const HOOP: [&str; 4] = [
    "a > 0,",
    "x, y, z",
    "bodies { disc { mass: m, inertia: diag(A, A, C), center: vec(x, y, z), orientation: R } }",
    "parameters { }
     constraints { rolling: disc.velocity_at(disc.center - a*unit(up - inner(up, R.z)*R.z)) = 0; }",
];

/// A rattleback.
const STONE: [&str; 4] = [
    "a > 0, b > 0, c > 0, h, D,",
    "x, y, z",
    "let n = transpose(R)*up;
     let size = sqrt((a*n.x)^2 + (b*n.y)^2 + (c*n.z)^2);
     let lowest = vec(a^2*n.x, b^2*n.y, c^2*n.z)/-size;
     bodies { stone { mass: m, inertia: sym(A, B, C, D, 0, 0), center: vec(x, y, z), orientation: R } }",
    "parameters { }
     constraints { rolling: stone.velocity_at(stone.center + R*(lowest + vec(0, 0, h))) = 0; }",
];

#[test]
fn by_three_rates_of_a_quaternion() {
    for (body, left) in [(TOP, 0), (TOP, 2), (FLYING, 1), (BALL, 2), (HOOP, 0), (HOOP, 3), (STONE, 0)] {
        by_three_rates(body, left);
    }
}

#[test]
#[ignore = "ten seconds without optimisation; `.ci/run` runs it in a release build"]
fn by_any_three_rates_of_a_quaternion() {
    for body in [TOP, FLYING, BALL, HOOP, STONE] {
        (0..4).for_each(|left| by_three_rates(body, left));
    }
}

/// A top and an ellipsoid that rolls, by the rates of their angles.
fn by_rates_of_angles(turns: &str, edge: f64) {
    let ellipsoid = STONE.map(|text| text.replace("let n =", &format!("let R = {turns}; let n =")));
    let top = TOP.map(|text| text.replace("bodies {", &format!("let R = {turns}; bodies {{")));
    for [constants, coordinates, body, more] in [top, ellipsoid] {
        let more = more.replace("parameters {", "parameters { u = dot(p); v = dot(q); s = dot(r);");
        let text = format!(
            "pub system Body {{
                constants {{ m > 0, A > 0, B > 0, C > 0, {constants} g = 9.81 }}
                coordinates {{ p, q, r, {coordinates} }}
                let up = vec(0, 0, 1);
                {body}
                gravity = -g*up;
                {more}
            }}"
        );
        right_at_the_edge(&body, &text, |x, distance| x[1] = edge + x[1] * distance);
    }
}

#[test]
fn by_the_rates_of_angles() {
    by_rates_of_angles("rot_z(p)*rot_x(q)*rot_z(r)", 0.0);
    by_rates_of_angles("rot_z(p)*rot_x(q)*rot_y(r)", std::f64::consts::FRAC_PI_2);
}
