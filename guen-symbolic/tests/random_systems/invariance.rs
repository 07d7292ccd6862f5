//! Sign checks by other declarations of the same motion: time as a coordinate, other parameters, other rows.

use guen_symbolic::{Form, Mechanics, Role, Substitution};

use crate::declared::Declared;
use crate::derived::derive;
use crate::draw::Draw;
use crate::multipliers;
use crate::rows::times;
use crate::sweep::ROUNDING;
use crate::system;
use crate::words::Words;

/// Seeds of their own.
const SEEDS: std::ops::Range<u64> = 10_000..10_030;
/// Systems that must be left of them.
const COMPARED: usize = 25;

/// The system of a seed without positions, so that every state is one of both declarations.
fn drawn(seed: u64) -> (Words, Mechanics) {
    let (words, mut mechanics) = system::drawn(seed);
    mechanics.holonomic.clear();
    (words, mechanics)
}

/// Replaces in `T°` and in the forces, where declarations name quasi-velocities and time.
fn replace(words: &mut Words, mechanics: &mut Mechanics, mut by: Substitution) {
    mechanics.kinetic_energy = by.of(&mut words.graph, mechanics.kinetic_energy);
    for force in &mut mechanics.forces {
        force.magnitude = by.of(&mut words.graph, force.magnitude);
        force.along = by.of(&mut words.graph, force.along);
    }
}

/// Derives drawn systems in another declaration: at equal `t, x, x'`, `x''` and the reaction covector must be equal.
fn motion_stays(change: impl Fn(&mut Words, &mut Mechanics)) {
    let (mut compared, mut covectors) = (0, 0);
    for seed in SEEDS {
        let (words, mechanics) = drawn(seed);
        let declared = Declared::new(&words.graph, &mechanics);
        let mut point = declared.state(&mut Draw::new(!seed));
        let Some(reference) = multipliers::solve(&declared, &point) else { continue };
        let (mut words, mut mechanics) = drawn(seed);
        change(&mut words, &mut mechanics);
        mechanics.written = mechanics.forms.over(&mut words.graph, &mechanics.velocities);
        let changed = Declared::new(&words.graph, &mechanics);
        changed.set_etas(&mut point);
        let derived = derive(words.graph, mechanics, seed).expect("a regular system stays regular");
        let accelerations = derived.accelerate(&changed, &mut point);
        let unit = ROUNDING * reference.condition * reference.scale;
        let second = derived.second(&changed, &point, &accelerations);
        for (own, other) in second.iter().zip(&reference.second) {
            assert!((own - other).abs() <= unit, "seed {seed}: x'' is {own}, was {other}");
        }
        compared += 1;
        let Some(covector) = derived.covector(&changed, &point) else { continue };
        for (own, other) in covector.iter().zip(&reference.covector) {
            assert!((own - other).abs() <= unit, "seed {seed}: the reaction is {own}, was {other}");
        }
        covectors += 1;
    }
    println!("compared {compared} systems, reactions of {covectors}");
    assert!(compared >= COMPARED && covectors >= COMPARED / 2);
}

#[test]
fn parameters_moved_by_a_function_leave_the_motion() {
    motion_stays(|words, mechanics| {
        let all = words.everywhere();
        words.timed = true;
        let mut images = Vec::new();
        for s in 0..mechanics.forms.degrees {
            let shift = words.coefficient(&all);
            let form = &mut mechanics.forms.forms[s];
            form.offset = words.graph.add(form.offset, shift);
            images.push((mechanics.etas[s], words.graph.sub(mechanics.etas[s], shift)));
        }
        replace(words, mechanics, Substitution::new(images));
    });
}

#[test]
fn rows_recombined_leave_motion_and_reaction() {
    motion_stays(|words, mechanics| {
        let all = words.everywhere();
        words.timed = true;
        let l = mechanics.forms.degrees;
        // eta_v := g_v eta_v + b_v eta_(v-1), with the new eta_(v-1).
        let mut images = Vec::new();
        let mut before: Option<(Form, guen_symbolic::ExprId)> = None;
        for v in l..mechanics.forms.len() {
            let eta = mechanics.etas[v];
            let factor = words.positive(&all);
            let mut form = times(words, factor, &mechanics.forms.forms[v]);
            let mut old = eta;
            if let Some((known, known_eta)) = &before {
                let b = words.coefficient(&all);
                let part = times(words, b, known);
                let row = form.row.iter().zip(&part.row).map(|(a, b)| words.graph.add(*a, *b)).collect();
                form = Form { row, offset: words.graph.add(form.offset, part.offset) };
                let product = words.graph.mul(b, *known_eta);
                old = words.graph.sub(old, product);
            }
            images.push((eta, words.graph.div(old, factor)));
            mechanics.forms.forms[v] = form.clone();
            before = Some((form, eta));
        }
        replace(words, mechanics, Substitution::new(images));
    });
}

/// Makes time a coordinate `tau`, last in order, with `tau'` as a further parameter of its own inertia.
fn time_as_coordinate(words: &mut Words, mechanics: &mut Mechanics) {
    let l = mechanics.forms.degrees;
    let tau = words.graph.symbol("tau", Role::Coordinate);
    let rate = words.graph.symbol("tau'", Role::Velocity);
    let eta = words.graph.symbol("eta_tau", Role::QuasiVelocity);
    let acceleration = words.graph.symbol("deta_tau", Role::QuasiAcceleration);
    let (zero, one) = (words.graph.zero(), words.graph.one());
    let mut by_tau = Substitution::new([(words.time, tau)]);
    for form in &mut mechanics.forms.forms {
        form.row.push(form.offset);
        form.offset = zero;
        for a in &mut form.row {
            *a = by_tau.of(&mut words.graph, *a);
        }
    }
    let mut row = vec![zero; mechanics.forms.coordinates.len()];
    row.push(one);
    mechanics.forms.forms.insert(l, Form { row, offset: zero });
    mechanics.forms.degrees += 1;
    mechanics.forms.coordinates.push(tau);
    mechanics.velocities.push(rate);
    mechanics.etas.insert(l, eta);
    mechanics.stated.insert(l, false);
    mechanics.accelerations.push(acceleration);
    mechanics.force_function = by_tau.of(&mut words.graph, mechanics.force_function);
    replace(words, mechanics, by_tau);
    let half = words.graph.ratio(1, 2);
    let inertia = words.graph.product(&[(half, 1), (eta, 2)]);
    mechanics.kinetic_energy = words.graph.add(mechanics.kinetic_energy, inertia);
}

#[test]
fn time_as_a_coordinate_leaves_the_equations() {
    let mut compared = 0;
    for seed in SEEDS {
        let (words, mechanics) = drawn(seed);
        let declared = Declared::new(&words.graph, &mechanics);
        let mut point = declared.state(&mut Draw::new(!seed));
        let Some(reference) = multipliers::solve(&declared, &point) else { continue };
        let plain = derive(words.graph, mechanics, seed).expect("a regular system is derived");
        plain.accelerate(&declared, &mut point);
        let (mut words, mut mechanics) = drawn(seed);
        time_as_coordinate(&mut words, &mut mechanics);
        mechanics.written = mechanics.forms.over(&mut words.graph, &mechanics.velocities);
        let extended = derive(words.graph, mechanics, seed).expect("a regular system stays regular");
        // The new symbols stand last: tau = t, tau' = 1, eta_tau = 1, eta_tau' = 0; t itself occurs no more.
        let mut longer = point.clone();
        longer.extend([point[declared.time], 1.0, 1.0, 0.0]);
        longer[declared.time] = f64::NAN;
        let l = declared.degrees;
        let numbers = |derived: &crate::derived::Derived, point: &[f64]| -> Vec<f64> {
            let equations = &derived.derivation.equations;
            let mass = equations.mass[..l].iter().flat_map(|row| &row[..l]);
            let reactions = derived.derivation.reactions.iter().flatten();
            let roots: Vec<_> = mass.chain(&equations.forces[..l]).chain(reactions).copied().collect();
            derived.tape(&roots).at(point)
        };
        let (own, other) = (numbers(&plain, &point), numbers(&extended, &longer));
        assert_eq!(own.len(), other.len(), "seed {seed}");
        let size = own.iter().map(|a| a.abs()).fold(reference.scale, f64::max);
        for (own, other) in own.iter().zip(&other) {
            let difference = (own - other).abs();
            assert!(difference <= ROUNDING * reference.condition * size, "seed {seed}: {own} became {other}");
        }
        compared += 1;
    }
    println!("compared {compared} systems");
    assert!(compared >= COMPARED);
}
