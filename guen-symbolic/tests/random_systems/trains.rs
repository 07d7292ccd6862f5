//! Random trains on wheels: velocities that are solved for one from another, against multipliers.
//!
//! Each trailer hangs on the one before it, at the axle or beside it, drawn or pushed, and may have no wheels; headings are
//! absolute, or angles at the hitches; the ground may be a belt that moves as prescribed. Trailers have masses, at the axle or
//! beside it, some of them an inertia. Constraints are written by points, or by the angles between the links.

use std::collections::BTreeMap;

use guen_symbolic::{ExprId, Flow, Force, Form, Forms, Mechanics, Rational, Substitution};

use crate::draw::Draw;
use crate::sweep::compared;
use crate::words::Words;

/// Trains drawn in every run.
const DRAWN: u64 = 40;

/// A point of the plane.
type Point = [ExprId; 2];

fn drawn(seed: u64) -> (Words, Mechanics, Vec<&'static str>) {
    let mut draw = Draw::new(seed);
    let trailers = draw.between(2, 5);
    let (relative, belt, damped) = (draw.once_in(2), draw.once_in(3), draw.once_in(2));
    let n = 3 + trailers;
    let mut words = Words::new(draw, n);
    let mut features = Vec::new();
    for (present, name) in [(relative, "relative angles"), (belt, "belt"), (damped, "friction")] {
        if present {
            features.push(name);
        }
    }
    let (zero, one, mass) = (words.graph.zero(), words.graph.one(), words.constants[0]);
    let motion = words.velocities.iter().copied().chain([one]);
    let mut rate =
        Flow::new(&words.graph, words.x.iter().copied().chain([words.time]).zip(motion).collect::<Vec<_>>());
    let ground: Point = if belt {
        let s = words.graph.sin(words.time);
        let half = words.graph.ratio(1, 2);
        let wave = words.graph.scale(s, &Rational::new(1, 3));
        [words.graph.add(wave, half), words.time]
    } else {
        [zero; 2]
    };
    let (mut parameters, mut constraints): (Vec<ExprId>, Vec<ExprId>) = Default::default();
    // The links before: lengths, and the angles at which they lie.
    let mut links: Vec<(Rational, ExprId)> = Vec::new();
    let mut kinetic: Vec<(ExprId, ExprId)> = Vec::new();
    let mut potential = Vec::new();
    let (mut place, mut heading): (Point, ExprId) = ([words.x[0], words.x[1]], words.x[2]);
    for k in 0..=trailers {
        if k > 0 {
            if words.draw.once_in(3) {
                features.push("hitch off the axle");
                let behind = words.number();
                place = moved(&mut words, place, heading, &behind);
                links.push((behind, heading));
            }
            let own = words.x[2 + k];
            heading = if relative { words.graph.add(heading, own) } else { own };
            let length = words.number();
            place = moved(&mut words, place, heading, &length);
            links.push((length, heading));
        }
        let moving = place.map(|x| rate.of(&mut words.graph, x));
        let sliding = [0, 1].map(|i| words.graph.sub(moving[i], ground[i]));
        let (s, c) = words.graph.sin_cos(heading);
        let [along, across] =
            [[c, s], [s, c]].map(|factors| [0, 1].map(|i| words.graph.mul(factors[i], sliding[i])));
        if k == 0 {
            parameters.push(words.graph.add(along[0], along[1]));
            parameters.push(words.velocities[2]);
        }
        if k > 0 && words.draw.once_in(5) {
            features.push("link without wheels");
            parameters.push(words.velocities[2 + k]);
        } else {
            let plain = words.graph.sub(across[1], across[0]);
            let across = if words.draw.once_in(4) {
                features.push("multiplied out");
                multiplied_out(&mut words, &mut rate, &ground, &links, heading)
            } else {
                plain
            };
            let factor = if words.draw.once_in(3) { words.number() } else { Rational::ONE };
            constraints.push(words.graph.scale(across, &factor));
        }
        let mut load = place;
        if words.draw.once_in(3) {
            features.push("load off the axle");
            let (behind, beside) = (words.number(), words.number());
            load = moved(&mut words, place, heading, &behind);
            load[0] = words.graph.linear(&[(load[0], Rational::ONE), (s, -beside.clone())]);
            load[1] = words.graph.linear(&[(load[1], Rational::ONE), (c, beside)]);
        }
        kinetic.extend(load.map(|x| (mass, rate.of(&mut words.graph, x))));
        if words.draw.once_in(2) {
            features.push("inertia");
            let turning = rate.of(&mut words.graph, heading);
            kinetic.push((words.graph.ratio(1, 5), turning));
        }
        if words.draw.once_in(3) {
            features.push("slope");
            potential.push(words.graph.scale(place[1], &Rational::new(-3, 2)));
        }
    }
    features.sort_unstable();
    features.dedup();
    let half = words.graph.ratio(1, 2);
    let squares: Vec<ExprId> =
        kinetic.iter().map(|(w, v)| words.graph.product(&[(half, 1), (*w, 1), (*v, 2)])).collect();
    let forces = damped.then(|| {
        let along = words.draw.pick(&words.velocities);
        Force { magnitude: words.graph.scale(words.etas[0], &Rational::new(-1, 2)), along }
    });
    let l = parameters.len();
    if words.draw.once_in(2) {
        constraints.reverse();
    }
    let written = [parameters, constraints].concat();
    let forms = written.iter().map(|e| form(&mut words, *e)).collect();
    let mechanics = Mechanics {
        forms: Forms { time: words.time, coordinates: words.x.clone(), forms, degrees: l },
        written,
        velocities: words.velocities.clone(),
        etas: words.etas.clone(),
        accelerations: words.accelerations[..l].to_vec(),
        inputs: words.inputs.clone(),
        holonomic: Vec::new(),
        redundant: Vec::new(),
        kinetic_energy: words.graph.sum(squares),
        stated: vec![true; n],
        force_function: words.graph.sum(potential),
        multibody: None,
        structure: Default::default(),
        forces: forces.into_iter().collect(),
        outputs: Vec::new(),
        states: Vec::new(),
        motion_symbols: Vec::new(),
        measured: None,
    };
    (words, mechanics, features)
}

/// A point at a distance behind another.
fn moved(words: &mut Words, from: Point, heading: ExprId, distance: &Rational) -> Point {
    let (s, c) = words.graph.sin_cos(heading);
    let mut found = from;
    for (x, direction) in found.iter_mut().zip([c, s]) {
        let part = words.graph.scale(direction, distance);
        *x = words.graph.sub(*x, part);
    }
    found
}

/// What the axle behind some links slides sideways on the ground, by the angles between it and them.
fn multiplied_out(
    words: &mut Words,
    rate: &mut Flow,
    ground: &Point,
    links: &[(Rational, ExprId)],
    heading: ExprId,
) -> ExprId {
    let graph = &mut words.graph;
    let (s, c) = graph.sin_cos(heading);
    let [x, y] = [0, 1].map(|i| graph.sub(words.velocities[i], ground[i]));
    let mut terms = vec![(graph.mul(x, s), Rational::MINUS_ONE), (graph.mul(y, c), Rational::ONE)];
    for (length, angle) in links {
        let (turning, between) = (rate.of(graph, *angle), graph.sub(*angle, heading));
        let cosine = graph.cos(between);
        terms.push((graph.mul(cosine, turning), -length.clone()));
    }
    graph.linear(&terms)
}

/// The coefficients of what is affine in the velocities.
fn form(words: &mut Words, e: ExprId) -> Form {
    let graph = &mut words.graph;
    let row = words.velocities.iter().map(|v| Flow::partial(graph, *v).of(graph, e)).collect();
    let zero = graph.zero();
    let offset = Substitution::new(words.velocities.iter().map(|v| (*v, zero))).of(graph, e);
    Form { row, offset }
}

#[test]
fn trains_move_as_with_multipliers() {
    let mut shown: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut nested, mut worst) = (0_u64, 0.0_f64);
    let rounds = crate::rounds(DRAWN);
    for seed in 0..rounds {
        let (words, mechanics, features) = drawn(seed);
        let Some((derived, difference)) = compared(words, mechanics, seed) else { continue };
        worst = worst.max(difference);
        if derived.derivation.is_by("recursive") {
            nested += 1;
            features.into_iter().for_each(|name| *shown.entry(name).or_default() += 1);
        }
    }
    println!("nested {nested} of {rounds}, largest difference {worst:e}, with {shown:?}");
    assert!(10 * nested >= 4 * rounds);
    for name in
        ["relative angles", "belt", "friction", "hitch off the axle", "load off the axle", "inertia", "slope"]
    {
        assert!(
            shown.get(name).is_some_and(|count| 10 * *count as u64 >= rounds),
            "{name}: too few are nested"
        );
    }
}
