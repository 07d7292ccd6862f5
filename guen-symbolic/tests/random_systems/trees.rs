//! Random trees of links, solved for the constraint forces, against multipliers.
//!
//! Links hang from the tips of earlier ones, from a point at rest, from one that moves as prescribed, or from a cart; in
//! a plane with absolute or relative angles, measured either way round, or in space with two angles each. They carry
//! one or two particles, and some of them turn with an inertia of their own.

use std::collections::BTreeMap;

use guen_symbolic::{ExprId, Flow, Force, Form, Forms, Mechanics, Rational};

use crate::draw::Draw;
use crate::sweep::compared;
use crate::words::Words;

/// Trees drawn in every run.
const DRAWN: u64 = 40;

/// A point of a plane or of space.
type Point = [ExprId; 3];

/// What a drawn tree has.
#[derive(Default)]
struct Features {
    present: Vec<&'static str>,
}

impl Features {
    fn note(&mut self, name: &'static str) {
        if !self.present.contains(&name) {
            self.present.push(name);
        }
    }
}

/// The tree of a seed.
fn drawn(seed: u64) -> (Words, Mechanics, Features) {
    let mut draw = Draw::new(seed);
    let links = draw.between(4, 7);
    let spatial = draw.once_in(4);
    let root = draw.below(4);
    let (relative, damped) = (!spatial && draw.once_in(3), draw.once_in(2));
    let own = if spatial { 2 } else { 1 };
    let cart = usize::from(root == 3);
    let n = cart + own * if spatial { links.min(4) } else { links };
    let links = (n - cart) / own;
    let mut words = Words::new(draw, n);
    let mut features = Features::default();
    let mut kinetic = Vec::new();
    let mut potential = Vec::new();

    let (zero, mass) = (words.graph.zero(), words.constants[0]);
    let motion = words.velocities.iter().copied().chain([words.graph.one()]);
    let mut rate =
        Flow::new(&words.graph, words.x.iter().copied().chain([words.time]).zip(motion).collect::<Vec<_>>());
    // Half a mass times the square of each rate.
    let mut moves = |words: &mut Words, mass: ExprId, coordinates: &[ExprId]| {
        for x in coordinates {
            let speed = rate.of(&mut words.graph, *x);
            let half = words.graph.ratio(1, 2);
            kinetic.push(words.graph.product(&[(half, 1), (mass, 1), (speed, 2)]));
        }
    };
    let anchor: Point = match root {
        2 => {
            features.note("prescribed");
            let s = words.graph.sin(words.time);
            [words.graph.scale(s, &Rational::new(1, 3)), words.graph.powi(words.time, 2), zero]
        }
        3 => {
            features.note("cart");
            let twice = words.graph.scale(mass, &Rational::integer(2));
            let x = words.x[0];
            moves(&mut words, twice, &[x]);
            [words.x[0], zero, zero]
        }
        _ => [zero; 3],
    };
    let mut tips: Vec<(Point, ExprId)> = vec![(anchor, zero)];
    let mut children = vec![0; links + 1];
    for link in 0..links {
        let parent = if link > 0 && words.draw.once_in(4) { words.draw.between(1, link) } else { link };
        children[parent] += 1;
        if children[parent] > 1 && parent > 0 {
            features.note("branches");
        }
        let (place, turn) = tips[parent];
        let q = words.x[cart + own * link];
        let q = if relative && link > 0 { words.graph.add(turn, q) } else { q };
        if relative {
            features.note("relative angles");
        }
        let mut direction = {
            let (s, c) = words.graph.sin_cos(q);
            // Some angles are measured the other way round.
            let s = if words.draw.once_in(4) { words.graph.neg(s) } else { s };
            [s, words.graph.neg(c), zero]
        };
        if spatial {
            features.note("in space");
            let (s, c) = words.graph.sin_cos(words.x[cart + own * link + 1]);
            direction = [words.graph.mul(direction[0], c), direction[1], words.graph.mul(direction[0], s)];
        }
        let length = words.draw.pick(&[(1, 1), (1, 2), (2, 3)]);
        let length = words.graph.ratio(length.0, length.1);
        let at = |words: &mut Words, distance: ExprId| -> Point {
            let mut found = place;
            for (x, e) in found.iter_mut().zip(direction) {
                let part = words.graph.mul(distance, e);
                *x = words.graph.add(*x, part);
            }
            found
        };
        let tip = at(&mut words, length);
        let mut bodies = vec![(tip, mass)];
        if words.draw.once_in(12) {
            features.note("two particles on a link");
            let middle = words.graph.scale(length, &Rational::new(1, 3));
            bodies.push((at(&mut words, middle), words.graph.ratio(3, 4)));
        }
        for (place, mass) in bodies {
            let moving: Vec<ExprId> = place.into_iter().filter(|x| *x != zero).collect();
            moves(&mut words, mass, &moving);
            let weight = words.graph.mul(mass, place[1]);
            potential.push(words.graph.scale(weight, &Rational::new(-7, 2)));
        }
        if !spatial && words.draw.once_in(8) {
            features.note("links with inertia");
            let inertia = words.graph.ratio(1, 5);
            moves(&mut words, inertia, &[q]);
        }
        tips.push((tip, q));
    }
    let forces = damped.then(|| {
        features.note("friction");
        let (eta, along) = (words.draw.pick(&words.etas), words.draw.pick(&words.velocities));
        Force { magnitude: words.graph.scale(eta, &Rational::new(-1, 2)), along }
    });
    let forms = (0..n)
        .map(|i| Form {
            row: (0..n).map(|k| if i == k { words.graph.one() } else { zero }).collect(),
            offset: zero,
        })
        .collect();
    let forms = Forms { time: words.time, coordinates: words.x.clone(), forms, degrees: n };
    let mechanics = Mechanics {
        written: forms.over(&mut words.graph, &words.velocities),
        forms,
        velocities: words.velocities.clone(),
        etas: words.etas.clone(),
        accelerations: words.accelerations.clone(),
        inputs: words.inputs.clone(),
        holonomic: Vec::new(),
        redundant: Vec::new(),
        kinetic_energy: words.graph.sum(kinetic),
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

#[test]
fn trees_of_links_move_as_with_multipliers() {
    let mut shown: BTreeMap<&str, usize> = BTreeMap::new();
    let (mut solved, mut worst) = (0_u64, 0.0_f64);
    let rounds = crate::rounds(DRAWN);
    for seed in 0..rounds {
        let (words, mechanics, features) = drawn(seed);
        let Some((derived, difference)) = compared(words, mechanics, seed) else { continue };
        worst = worst.max(difference);
        if derived.derivation.is_by("constraint forces") {
            solved += 1;
            features.present.into_iter().for_each(|name| *shown.entry(name).or_default() += 1);
        }
    }
    println!("by constraint forces {solved} of {rounds}, largest difference {worst:e}, with {shown:?}");
    assert!(3 * solved >= 2 * rounds);
    for name in [
        "prescribed",
        "cart",
        "branches",
        "relative angles",
        "in space",
        "two particles on a link",
        "links with inertia",
        "friction",
    ] {
        assert!(
            shown.get(name).is_some_and(|count| 8 * *count as u64 >= rounds),
            "{name}: too few by constraint forces"
        );
    }
}
