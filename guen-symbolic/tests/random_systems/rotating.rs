//! Hand-written equations that the signs of rheonomic terms show in: a bead on a hoop, pendulums in turning frames.

use guen_symbolic::{ExprId, Flow, Form, Forms, Mechanics};

use crate::declared::Declared;
use crate::derived::{Derived, derive};
use crate::draw::Draw;
use crate::words::Words;

/// The hoop turns at `Omega = 1 + t/2`, by the angle `t + t^2/4`; its radius is `R = 2 + sin t`.
fn turn(t: f64) -> (f64, f64, f64) {
    (t + t * t / 4.0, 1.0 + t / 2.0, 0.5)
}

fn radius(t: f64) -> (f64, f64) {
    (2.0 + t.sin(), t.cos())
}

const STATES: usize = 20;
const TOLERANCE: f64 = 1e-12;

/// The symbols and shared expressions of a scene.
struct Scene {
    words: Words,
    angle: ExprId,
    omega: ExprId,
    radius: ExprId,
    radius_rate: ExprId,
}

impl Scene {
    fn new(n: usize) -> Self {
        let mut words = Words::new(Draw::new(0), n);
        let g = &mut words.graph;
        let t = words.time;
        let (half, quarter, one, two) = (g.ratio(1, 2), g.ratio(1, 4), g.one(), g.number(2));
        let bent = g.product(&[(quarter, 1), (t, 2)]);
        let angle = g.add(t, bent);
        let slope = g.mul(half, t);
        let omega = g.add(one, slope);
        let (sine, radius_rate) = g.sin_cos(t);
        let radius = g.add(two, sine);
        Scene { words, angle, omega, radius, radius_rate }
    }

    /// A form with the given coefficients.
    fn form(&mut self, row: &[(usize, ExprId)], offset: ExprId) -> Form {
        let mut full = vec![self.words.graph.zero(); self.words.x.len()];
        for (i, a) in row {
            full[*i] = *a;
        }
        Form { row: full, offset }
    }

    /// The rate of a function of `t` and `x`.
    fn rate(&mut self, f: ExprId) -> Form {
        let g = &mut self.words.graph;
        let row = self.words.x.iter().map(|x| Flow::partial(g, *x).of(g, f)).collect();
        Form { row, offset: Flow::partial(g, self.words.time).of(g, f) }
    }

    /// `1/2 sum w v^2`.
    fn squares(&mut self, terms: &[(ExprId, ExprId)]) -> ExprId {
        let g = &mut self.words.graph;
        let half = g.ratio(1, 2);
        let squares: Vec<_> = terms.iter().map(|(w, v)| g.product(&[(half, 1), (*w, 1), (*v, 2)])).collect();
        g.sum(squares)
    }

    fn derived(
        self,
        forms: Vec<Form>,
        degrees: usize,
        kinetic: ExprId,
        force: ExprId,
    ) -> (Declared, Derived) {
        let mut words = self.words;
        let stated = vec![true; words.etas.len()];
        let forms = Forms { time: words.time, coordinates: words.x, forms, degrees };
        let mechanics = Mechanics {
            stated,
            written: forms.over(&mut words.graph, &words.velocities),
            forms,
            velocities: words.velocities,
            etas: words.etas,
            accelerations: words.accelerations[..degrees].to_vec(),
            inputs: words.inputs,
            holonomic: Vec::new(),
            redundant: Vec::new(),
            kinetic_energy: kinetic,
            force_function: force,
            multibody: None,
            structure: Default::default(),
            forces: Vec::new(),
            outputs: Vec::new(),
            states: Vec::new(),
            motion_symbols: Vec::new(),
            measured: None,
        };
        let declared = Declared::new(&words.graph, &mechanics);
        (declared, derive(words.graph, mechanics, 0).expect("a regular system"))
    }
}

fn close(own: f64, other: f64, what: &str) {
    assert!((own - other).abs() <= TOLERANCE * other.abs().max(1.0), "{what}: {own} instead of {other}");
}

/// `x''` and `R` at a state given by `t` and the `eta`; the point gets its `eta'`.
fn motion(declared: &Declared, derived: &Derived, point: &mut [f64]) -> (Vec<f64>, Vec<f64>) {
    declared.set_velocities(point);
    let accelerations = derived.accelerate(declared, point);
    (
        derived.second(declared, point, &accelerations),
        derived.covector(declared, point).expect("T° has momenta"),
    )
}

/// `theta'' = Omega^2 sin cos + g/R sin - 2 R' theta'/R` with `theta` from the upward vertical.
fn bead(t: f64, theta: f64, rate: f64, g: f64) -> f64 {
    let ((_, omega, _), (r, r_rate)) = (turn(t), radius(t));
    omega * omega * theta.sin() * theta.cos() + g / r * theta.sin() - 2.0 * r_rate * rate / r
}

#[test]
fn bead_on_a_turning_hoop_by_an_affine_constraint() {
    // theta, phi: phi' = Omega(t), eta_1 = R theta'; k1 is the mass, k2 the gravity.
    let mut scene = Scene::new(2);
    let (m, gravity) = (scene.words.constants[0], scene.words.constants[1]);
    let (zero, one) = (scene.words.graph.zero(), scene.words.graph.one());
    let drive = scene.words.graph.neg(scene.omega);
    let (radius_of_t, radius_rate) = (scene.radius, scene.radius_rate);
    let forms = vec![scene.form(&[(0, radius_of_t)], zero), scene.form(&[(1, one)], drive)];
    let (sine, cosine) = scene.words.graph.sin_cos(scene.words.x[0]);
    let g = &mut scene.words.graph;
    let around = g.product(&[(radius_of_t, 1), (sine, 1), (scene.words.velocities[1], 1)]);
    let force = g.product(&[(m, 1), (gravity, 1), (radius_of_t, 1), (cosine, 1)]);
    let force = g.neg(force);
    let along = scene.words.etas[0];
    let kinetic = scene.squares(&[(m, along), (m, around), (m, radius_rate)]);
    let k = [m, gravity].map(|symbol| scene.words.graph.as_symbol(symbol).expect("a symbol").index());
    let (declared, derived) = scene.derived(forms, 1, kinetic, force);
    let mut draw = Draw::new(1);
    for _ in 0..STATES {
        let mut point = declared.state(&mut draw);
        let (second, reaction) = motion(&declared, &derived, &mut point);
        let (t, theta, rate) = (point[declared.time], point[declared.x[0]], point[declared.velocities[0]]);
        close(second[0], bead(t, theta, rate, point[k[1]]), "theta''");
        // The motor's torque is the rate of m R^2 sin^2 Omega.
        let ((_, omega, omega_rate), (r, r_rate)) = (turn(t), radius(t));
        let (s, c) = theta.sin_cos();
        let torque = 2.0 * r * r_rate * s * s * omega
            + 2.0 * r * r * s * c * rate * omega
            + r * r * s * s * omega_rate;
        close(reaction[1], point[k[0]] * torque, "the motor's torque");
    }
}

#[test]
fn bead_on_a_turning_hoop_in_space() {
    // theta, x, y, z with the bead's place by three rheonomic holonomic constraints.
    let mut scene = Scene::new(4);
    let (m, gravity) = (scene.words.constants[0], scene.words.constants[1]);
    let (zero, one) = (scene.words.graph.zero(), scene.words.graph.one());
    let g = &mut scene.words.graph;
    let ((st, ct), (sp, cp)) = (g.sin_cos(scene.words.x[0]), g.sin_cos(scene.angle));
    let r = scene.radius;
    let places =
        [g.product(&[(r, 1), (st, 1), (cp, 1)]), g.product(&[(r, 1), (st, 1), (sp, 1)]), g.mul(r, ct)];
    let mut forms = vec![scene.form(&[(0, one)], zero)];
    for (k, place) in places.into_iter().enumerate() {
        let position = scene.words.graph.sub(scene.words.x[k + 1], place);
        forms.push(scene.rate(position));
    }
    let v = scene.words.velocities.clone();
    let kinetic = scene.squares(&[(m, v[1]), (m, v[2]), (m, v[3])]);
    let force = scene.words.graph.product(&[(m, 1), (gravity, 1), (scene.words.x[3], 1)]);
    let force = scene.words.graph.neg(force);
    let k = scene.words.graph.as_symbol(gravity).expect("a symbol").index();
    let (declared, derived) = scene.derived(forms, 1, kinetic, force);
    assert!(derived.derivation.closure.is_holonomic());
    let mut draw = Draw::new(2);
    for _ in 0..STATES {
        let mut point = declared.state(&mut draw);
        let (second, _) = motion(&declared, &derived, &mut point);
        let (t, theta, rate) = (point[declared.time], point[declared.x[0]], point[declared.velocities[0]]);
        close(second[0], bead(t, theta, rate, point[k]), "theta''");
    }
}

#[test]
fn plane_pendulum_from_a_turning_line() {
    // theta from a line that turns: (theta + phi)'' = -g/R sin(theta + phi) - 2 R'/R (theta + phi)'.
    let mut scene = Scene::new(1);
    let (gravity, one, zero) = (scene.words.constants[1], scene.words.graph.one(), scene.words.graph.zero());
    let forms = vec![scene.form(&[(0, one)], zero)];
    let g = &mut scene.words.graph;
    let rate = g.add(scene.words.velocities[0], scene.omega);
    let angle = g.add(scene.words.x[0], scene.angle);
    let cosine = g.cos(angle);
    let force = g.product(&[(gravity, 1), (scene.radius, 1), (cosine, 1)]);
    let weight = g.powi(scene.radius, 2);
    let kinetic = scene.squares(&[(weight, rate)]);
    let k = scene.words.graph.as_symbol(gravity).expect("a symbol").index();
    let (declared, derived) = scene.derived(forms, 1, kinetic, force);
    let mut draw = Draw::new(3);
    for _ in 0..STATES {
        let mut point = declared.state(&mut draw);
        let (second, _) = motion(&declared, &derived, &mut point);
        let ((phi, omega, omega_rate), (r, r_rate)) =
            (turn(point[declared.time]), radius(point[declared.time]));
        let (theta, rate) = (point[declared.x[0]], point[declared.velocities[0]]);
        let expected = -point[k] / r * (theta + phi).sin() - 2.0 * r_rate / r * (rate + omega) - omega_rate;
        close(second[0], expected, "theta''");
    }
}

/// A pendulum on a sphere, `x x' + y y' + z z' = 0`, with velocities as seen from a frame that turns or rests.
fn spherical_pendulum(turning: bool) -> (Declared, Derived) {
    let mut scene = Scene::new(3);
    let (m, gravity) = (scene.words.constants[0], scene.words.constants[1]);
    let (one, zero) = (scene.words.graph.one(), scene.words.graph.zero());
    let (x, v) = (scene.words.x.clone(), scene.words.velocities.clone());
    let forms = vec![
        scene.form(&[(0, one)], zero),
        scene.form(&[(1, one)], zero),
        scene.form(&[(0, x[0]), (1, x[1]), (2, x[2])], zero),
    ];
    let omega = if turning { scene.omega } else { zero };
    let g = &mut scene.words.graph;
    let (oy, ox) = (g.mul(omega, x[1]), g.mul(omega, x[0]));
    let (vx, vy) = (g.sub(v[0], oy), g.add(v[1], ox));
    let force = g.product(&[(m, 1), (gravity, 1), (x[2], 1)]);
    let kinetic = scene.squares(&[(m, vx), (m, vy), (m, v[2])]);
    scene.derived(forms, 2, kinetic, force)
}

#[test]
fn spherical_pendulum_in_a_turning_frame() {
    let ((declared, turning), (_, resting)) = (spherical_pendulum(true), spherical_pendulum(false));
    let rotated = |phi: f64, [x, y]: [f64; 2]| [x * phi.cos() - y * phi.sin(), x * phi.sin() + y * phi.cos()];
    let mut draw = Draw::new(4);
    for _ in 0..STATES {
        let mut point = declared.state(&mut draw);
        // Away from the equator, where x' and y' are no parameters.
        point[declared.x[2]] = draw.real(0.5, 1.0);
        let (second, reaction) = motion(&declared, &turning, &mut point);
        let (phi, omega, omega_rate) = turn(point[declared.time]);
        let [x, y] = [0, 1].map(|k| point[declared.x[k]]);
        let [vx, vy] = [0, 1].map(|k| point[declared.velocities[k]]);
        // The same state seen from rest: v + Omega x r, turned by phi.
        let mut inertial = point.clone();
        let (place, velocity) = (rotated(phi, [x, y]), rotated(phi, [vx - omega * y, vy + omega * x]));
        for k in 0..2 {
            inertial[declared.x[k]] = place[k];
            inertial[declared.etas[k]] = velocity[k];
        }
        let (absolute, force) = motion(&declared, &resting, &mut inertial);
        // a = a' + 2 Omega x v' + Omega' x r + Omega x (Omega x r)
        let [ax, ay] = rotated(-phi, [absolute[0], absolute[1]]);
        close(second[0], ax + 2.0 * omega * vy + omega_rate * y + omega * omega * x, "x''");
        close(second[1], ay - 2.0 * omega * vx - omega_rate * x + omega * omega * y, "y''");
        close(second[2], absolute[2], "z''");
        let [fx, fy] = rotated(-phi, [force[0], force[1]]);
        for (own, other) in reaction.iter().zip([fx, fy, force[2]]) {
            close(*own, other, "the reaction");
        }
    }
}
