//! Random trees of bodies in space: what is derived link by link, in the axes of each, against multipliers.
//!
//! Bodies turn about axes of their parents, oblique ones too, slide along them or do both, hang on earlier bodies, on a cart, or on axes that
//! move as prescribed; some have a second body or a particle fixed to them. Energies of other things stand beside theirs. Parameters are rates of coordinates or sums of
//! such, and some trees are held by a nonholonomic constraint.

use std::collections::BTreeMap;

use guen_symbolic::{
    BodyNode, ExprId, Flow, Form, Forms, FrameId, Graph, Mechanics, Multibody, Place, Rational, RigidBody,
    SystemGraph, Turn,
};

use crate::draw::Draw;
use crate::sweep::compared;
use crate::words::Words;

/// Trees drawn in every run.
const DRAWN: u64 = 30;

type Vector = [ExprId; 3];
type Matrix = [Vector; 3];

fn dot(g: &mut Graph, a: Vector, b: Vector) -> ExprId {
    let products = [0, 1, 2].map(|i| g.mul(a[i], b[i]));
    g.sum(products)
}

fn applied(g: &mut Graph, m: Matrix, v: Vector) -> Vector {
    m.map(|row| dot(g, row, v))
}

fn transposed(m: Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| m[k][i]))
}

fn product(g: &mut Graph, a: Matrix, b: Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(g, row, column)))
}

fn plus(g: &mut Graph, a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| g.add(a[i], b[i]))
}

/// A frame that is turned about one of the three axes.
fn hung(g: &mut Graph, structure: &mut SystemGraph, frame: FrameId, axis: usize, angle: ExprId) -> FrameId {
    structure.turned(frame, Turn::About { axis: unit_of(g, axis), angle })
}

fn unit_of(g: &Graph, axis: usize) -> Vector {
    let mut unit = [g.zero(); 3];
    unit[axis] = g.one();
    unit
}

/// A turn about one of the three axes.
fn turn(g: &mut Graph, axis: usize, angle: ExprId) -> Matrix {
    let (s, c) = g.sin_cos(angle);
    let (zero, one) = (g.zero(), g.one());
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut m = [[zero; 3]; 3];
    m[axis][axis] = one;
    (m[j][j], m[k][k]) = (c, c);
    (m[k][j], m[j][k]) = (s, g.neg(s));
    m
}

/// Unit vectors that are no coordinate axes, numerators and denominator; none is parallel to the one before.
const OBLIQUE: [([i64; 3], i64); 4] = [([2, 1, -2], 3), ([1, 2, 2], 3), ([0, 3, -4], 5), ([6, -2, 3], 7)];

/// One of the oblique unit vectors.
fn oblique(g: &mut Graph, place: usize) -> Vector {
    let (numerators, denominator) = OBLIQUE[place % OBLIQUE.len()];
    numerators.map(|n| g.ratio(n, denominator))
}

/// The turn about a unit vector, `c 1 + (1 - c) a a^T + s [a]x`.
fn turn_about(g: &mut Graph, a: Vector, angle: ExprId) -> Matrix {
    let (s, c) = g.sin_cos(angle);
    let one = g.one();
    let rest = g.sub(one, c);
    [0, 1, 2].map(|i| {
        [0, 1, 2].map(|k| {
            let outer = g.product(&[(rest, 1), (a[i], 1), (a[k], 1)]);
            let other = match (k + 3 - i) % 3 {
                0 => c,
                1 => {
                    let e = g.mul(s, a[(i + 2) % 3]);
                    g.neg(e)
                }
                _ => g.mul(s, a[(i + 1) % 3]),
            };
            g.add(outer, other)
        })
    })
}

fn numbers(words: &mut Words) -> Vector {
    [0; 3].map(|_| {
        let n = words.number();
        if words.draw.once_in(3) { words.graph.zero() } else { words.graph.number(n) }
    })
}

/// The kinetic energy of a body, from the rates of its centre and of its matrix.
fn energy(g: &mut Graph, rate: &mut Flow, body: &RigidBody) -> ExprId {
    let mut terms = Vec::new();
    if let Some(center) = body.center {
        let velocity = center.map(|e| rate.of(g, e));
        let square = dot(g, velocity, velocity);
        terms.push(g.mul(body.mass, square));
    }
    if let Some(turned) = body.orientation {
        let rates = turned.map(|row| row.map(|e| rate.of(g, e)));
        let spin = product(g, transposed(turned), rates);
        let spin = [spin[2][1], spin[0][2], spin[1][0]];
        let [xx, yy, zz, xy, yz, zx] = body.inertia;
        let momentum = applied(g, [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]], spin);
        terms.push(dot(g, spin, momentum));
    }
    let sum = g.sum(terms);
    g.scale(sum, &Rational::new(1, 2))
}

/// The tree of a seed, and what it has.
fn drawn(seed: u64) -> (Words, Mechanics, Vec<&'static str>) {
    let mut draw = Draw::new(seed);
    let (root, held, mixed) = (draw.below(4), draw.once_in(4), draw.once_in(3));
    let cart = if root == 3 { 2 } else { 0 };
    // With so many that equations are not multiplied out.
    let (large, rotors) = (draw.once_in(10), draw.once_in(4));
    // Axes of numbers in frames that are tilted by `1/3` have components that are no numbers.
    let tilts = draw.once_in(2);
    let n = cart + if large { 8 } else { draw.between(4, 5) };
    let mut words = Words::new(draw, n);
    let mut features = Vec::new();
    if large {
        features.push("many links");
    }
    let (zero, one) = (words.graph.zero(), words.graph.one());
    let unit = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    let (mut turned, mut place) = (unit, [zero; 3]);
    let (mut structure, mut frame) = (SystemGraph::new(&words.graph), FrameId::WORLD);
    match root {
        2 => {
            features.push("prescribed");
            let angle = words.graph.scale(words.time, &Rational::new(1, 2));
            turned = turn(&mut words.graph, 0, angle);
            frame = hung(&mut words.graph, &mut structure, frame, 0, angle);
            place[1] = words.graph.sin(words.time);
        }
        3 => {
            features.push("cart");
            place = [words.x[0], words.x[1], zero];
        }
        _ => {}
    }
    let mut bodies: Vec<RigidBody> = Vec::new();
    let seat = Place::in_axes(&words.graph, FrameId::WORLD, place);
    let mut tips: Vec<(Matrix, Vector, usize, FrameId, Place)> = vec![(turned, place, 3, frame, seat)];
    let mut next = cart;
    while next < n {
        let branches = tips.len() > 2 && words.draw.once_in(4);
        let parent = if branches { words.draw.between(1, tips.len() - 2) } else { tips.len() - 1 };
        let (mut axes, mut place, last, mut frame, mut seat) = tips[parent].clone();
        let joint = words.draw.below(8);
        // Turns about parallel axes would be one.
        let axis = (last + words.draw.between(1, 2)) % 3;
        let own = if joint == 0 && next + 1 < n { 2 } else { 1 };
        match joint {
            0 if own == 2 => {
                features.push("turns and slides");
                let slide = words.graph.mul(words.constants[0], words.x[next + 1]);
                let along = axes.map(|row| row[(axis + 1) % 3]);
                let mut own = [zero; 3];
                own[(axis + 1) % 3] = slide;
                let own = Place::in_axes(&words.graph, frame, own);
                seat = seat.plus(&mut words.graph, &own);
                frame = hung(&mut words.graph, &mut structure, frame, axis, words.x[next]);
                place = [0, 1, 2].map(|i| {
                    let part = words.graph.mul(along[i], slide);
                    words.graph.add(place[i], part)
                });
                let own = turn(&mut words.graph, axis, words.x[next]);
                axes = product(&mut words.graph, axes, own);
            }
            2..=4 if !tilts => {
                features.push("oblique axis");
                let about = oblique(&mut words.graph, next);
                frame = structure.turned(frame, Turn::About { axis: about, angle: words.x[next] });
                let own = turn_about(&mut words.graph, about, words.x[next]);
                axes = product(&mut words.graph, axes, own);
            }
            1 if next > cart => {
                features.push("slides");
                let direction = if words.draw.once_in(2) {
                    oblique(&mut words.graph, next)
                } else {
                    unit_of(&words.graph, axis)
                };
                let along = applied(&mut words.graph, axes, direction);
                let own = direction.map(|e| words.graph.mul(e, words.x[next]));
                let own = Place::in_axes(&words.graph, frame, own);
                seat = seat.plus(&mut words.graph, &own);
                place = [0, 1, 2].map(|i| {
                    let part = words.graph.mul(along[i], words.x[next]);
                    words.graph.add(place[i], part)
                });
            }
            2 | 3 if tilts => {
                features.push("tilted axis");
                let tilt = words.graph.number(Rational::new(1, 3));
                frame = hung(&mut words.graph, &mut structure, frame, last % 3, tilt);
                frame = hung(&mut words.graph, &mut structure, frame, axis, words.x[next]);
                let (tilted, own) =
                    (turn(&mut words.graph, last % 3, tilt), turn(&mut words.graph, axis, words.x[next]));
                axes = product(&mut words.graph, axes, tilted);
                axes = product(&mut words.graph, axes, own);
            }
            _ => {
                frame = hung(&mut words.graph, &mut structure, frame, axis, words.x[next]);
                let own = turn(&mut words.graph, axis, words.x[next]);
                axes = product(&mut words.graph, axes, own);
            }
        }
        next += own;
        if branches {
            features.push("branches");
        }
        let local = numbers(&mut words);
        let away = applied(&mut words.graph, axes, local);
        let center = plus(&mut words.graph, place, away);
        let mass = words.constants[0];
        let [xx, yy, zz] = [2, 3, 4].map(|k| words.graph.ratio(k, 5));
        let (xy, yz) = (words.graph.ratio(1, 9), words.graph.ratio(-1, 8));
        let skew = words.draw.once_in(2);
        let inertia = if skew { [xx, yy, zz, xy, yz, zero] } else { [xx, yy, zz, zero, zero, zero] };
        if skew {
            features.push("products of inertia");
        }
        bodies.push(RigidBody { mass, center: Some(center), orientation: Some(axes), spin: None, inertia });
        let away = Place::in_axes(&words.graph, frame, local);
        let node = BodyNode {
            name: String::new(),
            frame: Some(frame),
            center: Some(seat.plus(&mut words.graph, &away)),
            mass,
            inertia,
        };
        structure.bodies.push(node);
        if words.draw.once_in(3) {
            features.push("a particle fixed to a body");
            let local = numbers(&mut words);
            let away = applied(&mut words.graph, axes, local);
            let center = plus(&mut words.graph, place, away);
            let mass = words.graph.ratio(3, 4);
            let inertia = [zero; 6];
            bodies.push(RigidBody { mass, center: Some(center), orientation: None, spin: None, inertia });
            let away = Place::in_axes(&words.graph, frame, local);
            let center = Some(seat.plus(&mut words.graph, &away));
            structure.bodies.push(BodyNode { name: String::new(), frame: None, center, mass, inertia });
        }
        let local = numbers(&mut words);
        let away = applied(&mut words.graph, axes, local);
        let tip = plus(&mut words.graph, place, away);
        let away = Place::in_axes(&words.graph, frame, local);
        let seat = seat.plus(&mut words.graph, &away);
        tips.push((axes, tip, axis, frame, seat));
    }
    let motion = words.velocities.iter().copied().chain([one]);
    let mut rate =
        Flow::new(&words.graph, words.x.iter().copied().chain([words.time]).zip(motion).collect::<Vec<_>>());
    let mut energies: Vec<ExprId> =
        bodies.iter().map(|body| energy(&mut words.graph, &mut rate, body)).collect();
    let gravity = [zero, words.graph.ratio(-1, 3), words.graph.ratio(-7, 2)];
    let mut potential = Vec::new();
    for RigidBody { mass, center, .. } in &bodies {
        let height = dot(&mut words.graph, center.unwrap_or([zero; 3]), gravity);
        potential.push(words.graph.mul(*mass, height));
    }
    let spring = {
        features.push("a spring beside");
        let square = words.graph.powi(words.x[n - 1], 2);
        words.graph.neg(square)
    };
    potential.push(spring);
    let mut other_energy = zero;
    if rotors {
        features.push("rotors beside");
        let speed = words
            .graph
            .linear(&[(words.velocities[n - 1], Rational::integer(3)), (words.velocities[0], Rational::ONE)]);
        let square = words.graph.powi(speed, 2);
        let cosine = words.graph.cos(words.x[n - 1]);
        let weight = words.graph.linear(&[(cosine, Rational::new(1, 4)), (one, Rational::new(1, 2))]);
        other_energy = words.graph.mul(weight, square);
        energies.push(other_energy);
    }
    let mut forms: Vec<Form> = (0..n)
        .map(|i| Form { row: (0..n).map(|k| if i == k { one } else { zero }).collect(), offset: zero })
        .collect();
    if mixed {
        features.push("sums of rates");
        for (i, form) in forms.iter_mut().enumerate().skip(1) {
            form.row[i - 1] = words.graph.ratio(1, 2);
        }
    }
    let degrees = if held { n - 1 } else { n };
    if held {
        features.push("a constraint");
        let cosine = words.graph.cos(words.x[1]);
        forms[n - 1].row[0] = words.graph.scale(cosine, &Rational::new(2, 3));
    }
    structure.gravity = Some(gravity);
    structure.forms = vec![None; n];
    let forms = Forms { time: words.time, coordinates: words.x.clone(), forms, degrees };
    let multibody = Multibody { bodies, gravity, other_energy, other_force_function: spring };
    let mechanics = Mechanics {
        written: forms.over(&mut words.graph, &words.velocities),
        forms,
        velocities: words.velocities.clone(),
        etas: words.etas.clone(),
        accelerations: words.accelerations.clone(),
        inputs: words.inputs.clone(),
        holonomic: Vec::new(),
        redundant: Vec::new(),
        kinetic_energy: words.graph.sum(energies),
        stated: vec![true; n],
        force_function: words.graph.sum(potential),
        multibody: Some(multibody),
        structure,
        forces: Vec::new(),
        outputs: Vec::new(),
        states: Vec::new(),
        motion_symbols: Vec::new(),
        measured: None,
    };
    features.sort_unstable();
    features.dedup();
    (words, mechanics, features)
}

#[test]
fn bodies_on_bodies_move_as_with_multipliers() {
    let mut shown: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut understood, mut worst) = (0, 0.0_f64);
    let rounds = crate::rounds(DRAWN);
    for seed in 0..rounds {
        let (words, mechanics, features) = drawn(seed);
        let Some((derived, difference)) = compared(words, mechanics, seed) else { continue };
        worst = worst.max(difference);
        let dearer = ("bodies", "the equations as stated promise less");
        if derived.derivation.is_by("bodies") || derived.derivation.declined.contains(&dearer) {
            understood += 1;
            features.into_iter().for_each(|name| *shown.entry(name).or_default() += 1);
        }
    }
    println!("by bodies {understood} of {rounds}, largest difference {worst:e}, with {shown:?}");
    assert!(10 * understood >= 9 * rounds);
    for name in [
        "many links",
        "prescribed",
        "cart",
        "turns and slides",
        "slides",
        "tilted axis",
        "oblique axis",
        "branches",
        "products of inertia",
        "a particle fixed to a body",
        "a spring beside",
        "rotors beside",
        "sums of rates",
        "a constraint",
    ] {
        assert!(
            shown.get(name).is_some_and(|count| *count as u64 >= rounds / 20),
            "{name}: too few link by link"
        );
    }
}
