//! One random mechanical system from its seed: forms, energies, forces.

use guen_symbolic::{ExprId, Force, Holonomic, Mechanics, Rational};

use crate::draw::Draw;
use crate::rows::{FAMILIES, Family, draw_rows};
use crate::words::Words;

/// The system of a seed, with the words it was made of.
pub fn drawn(seed: u64) -> (Words, Mechanics) {
    let mut draw = Draw::new(seed);
    let family = draw.pick(&FAMILIES);
    let least = match family {
        Family::Free => 2,
        Family::Exact | Family::Scaled | Family::Affine => draw.between(2, 3),
        Family::Catastatic => 3,
        Family::Mixed | Family::Combined => 4,
    };
    // Small systems show as much as large ones and cost less.
    let n = draw.between(least, 6).min(draw.between(least, 6));
    let degrees = match family {
        Family::Free => n,
        Family::Mixed | Family::Combined => draw.between(2, n - 2),
        Family::Catastatic => draw.between(2, n - 1),
        _ => draw.between(n.saturating_sub(4).max(1), n - 1),
    };
    let order = draw.permutation(n);
    let still = family == Family::Catastatic || (family != Family::Affine && draw.once_in(4));
    let mut words = Words::new(draw, n);
    words.timed = !still;
    let rows = draw_rows(&mut words, family, degrees, &order);
    let kinetic_energy = kinetic_energy(&mut words, n);
    let all = words.everywhere();
    let potentials: Vec<ExprId> = (0..words.draw.between(1, 2)).map(|_| words.coefficient(&all)).collect();
    let force_function = words.graph.sum(potentials);
    let count = if still { words.draw.below(2) } else { words.draw.between(0, 2) };
    let forces = (0..count).map(|_| force(&mut words)).collect();
    // Declaring the positions moves every rank onto the manifold: do it for some of the systems.
    let declared = family == Family::Exact && words.draw.once_in(2);
    let holonomic = rows
        .positions
        .iter()
        .filter(|_| declared)
        .map(|(form, equation)| Holonomic { form: *form, equation: *equation })
        .collect();
    let mechanics = Mechanics {
        stated: vec![false; words.etas.len()],
        written: rows.forms.over(&mut words.graph, &words.velocities),
        forms: rows.forms,
        velocities: words.velocities.clone(),
        etas: words.etas.clone(),
        accelerations: words.accelerations[..degrees].to_vec(),
        inputs: words.inputs.clone(),
        holonomic,
        redundant: Vec::new(),
        kinetic_energy,
        force_function,
        multibody: None,
        structure: Default::default(),
        forces,
        outputs: Vec::new(),
        states: Vec::new(),
        motion_symbols: Vec::new(),
        measured: None,
    };
    (words, mechanics)
}

/// Squares of velocities and of quasi-velocities in frames that may move, products of both, and lower parts.
fn kinetic_energy(words: &mut Words, n: usize) -> ExprId {
    let all = words.everywhere();
    let half = words.graph.ratio(1, 2);
    let mut terms = Vec::new();
    for i in 0..n {
        if words.draw.once_in(10) {
            continue;
        }
        let mut form = words.velocities[i];
        if words.draw.once_in(4) {
            let c = words.coefficient(&all);
            let other = words.draw.pick(&words.velocities);
            let part = words.graph.mul(c, other);
            form = words.graph.add(form, part);
        }
        if words.timed && words.draw.once_in(3) {
            let drift = words.coefficient(&all);
            form = words.graph.add(form, drift);
        }
        let weight = match words.draw.below(4) {
            0 => words.positive(&all),
            1 => words.constants[0],
            _ => words.graph.one(),
        };
        terms.push(words.graph.product(&[(half, 1), (weight, 1), (form, 2)]));
    }
    for _ in 0..words.draw.below(3) {
        let (eta, other) = (words.draw.pick(&words.etas), words.draw.pick(&words.velocities));
        let second = words.draw.pick(&words.etas);
        let factors = match words.draw.below(5) {
            0 => vec![(words.positive(&all), 1), (half, 1), (eta, 2)],
            1 => vec![(half, 2), (eta, 1), (other, 1)],
            2 => vec![(half, 1), (words.graph.add(eta, other), 2)],
            3 => vec![(words.coefficient(&all), 1), (half, 2), (eta, 1), (second, 1)],
            // Written out: (eta + c v)^2 / 2.
            _ => {
                let c = words.coefficient(&all);
                let (squared, mixed) = (
                    words.graph.product(&[(half, 1), (c, 2), (other, 2)]),
                    words.graph.product(&[(c, 1), (eta, 1), (other, 1)]),
                );
                terms.extend([squared, mixed]);
                vec![(half, 1), (eta, 2)]
            }
        };
        terms.push(words.graph.product(&factors));
    }
    if words.timed {
        if words.draw.once_in(3) {
            let (c, slow) = (words.coefficient(&all), words.draw.pick(&words.velocities));
            terms.push(words.graph.mul(c, slow));
        }
        if words.draw.once_in(3) {
            let (c, eta) = (words.coefficient(&all), words.draw.pick(&words.etas));
            terms.push(words.graph.mul(c, eta));
        }
        if words.draw.once_in(3) {
            terms.push(words.coefficient(&all));
        }
    }
    words.graph.sum(terms)
}

/// Friction or drive along a velocity form.
fn force(words: &mut Words) -> Force {
    let all = words.everywhere();
    let (velocity, eta) = (words.draw.pick(&words.velocities), words.draw.pick(&words.etas));
    let magnitude = match words.draw.below(4) {
        0 => words.graph.scale(velocity, &Rational::new(-1, 2)),
        1 => {
            let c = words.coefficient(&all);
            let product = words.graph.mul(c, eta);
            words.graph.add(product, words.inputs[0])
        }
        2 => words.graph.mul(words.inputs[0], velocity),
        _ => words.coefficient(&all),
    };
    let along = match words.draw.below(3) {
        0 => words.draw.pick(&words.velocities),
        1 => words.draw.pick(&words.etas),
        _ => {
            let (c, drift) = (words.coefficient(&all), words.coefficient(&all));
            let (velocity, eta) = (words.draw.pick(&words.velocities), words.draw.pick(&words.etas));
            let part = words.graph.mul(c, eta);
            words.graph.sum([velocity, part, drift])
        }
    };
    Force { magnitude, along }
}
