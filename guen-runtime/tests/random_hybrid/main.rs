//! Systems with contacts drawn at random: whatever happens keeps the laws, and every mode is that of another solver.
//!
//! `GUEN_ROUNDS` says how many systems of each family, of which the tests' run takes a few; `GUEN_SEED` and `GUEN_FIRST` say where to begin.

#![cfg(feature = "alloc")]

#[expect(dead_code, reason = "systems without links have masses by themselves")]
#[path = "../hybrid/bodies.rs"]
mod bodies;
mod held;
mod laws;
mod lcp;
mod once_failed;
mod sensitivity;
mod signals;
mod tree;
mod two_points;

use guen_runtime::hybrid::{ElementState, HybridCause, HybridSystem, InMode, Mode, TransitionKind};
use nalgebra::{DMatrix, DVector};

use crate::laws::Judged;
use crate::tree::{Drawn, Feet, Four, Mixed, Random, Row, Spatial, Stops};

/// The number of systems of each family that is asked for.
fn asked_rounds() -> Option<usize> {
    std::env::var("GUEN_ROUNDS").ok().and_then(|rounds| rounds.parse().ok())
}

/// The number of systems of each family.
fn rounds(usual: usize) -> usize {
    asked_rounds().unwrap_or(usual)
}

/// A tree of links on a base with so many translations.
fn tree<const D: usize, const W: usize, const C: usize>(
    random: &mut Random,
    base: usize,
    rows: [Row; W],
    normals: [Option<usize>; C],
) -> Drawn<D, W, C> {
    let parents = core::array::from_fn(|k| if k <= base { k } else { base + random.below(k - base) });
    let mut draw = |low, high| core::array::from_fn(|_| random.between(low, high));
    let lengths = draw(0.5, 1.2);
    let mut drawn = Drawn {
        base,
        parents,
        lengths,
        centers: draw(0.1, 0.6),
        masses: draw(0.5, 2.0),
        inertias: draw(0.05, 0.4),
        springs: draw(0.0, 5.0),
        dampers: draw(0.0, 0.3),
        constant: None,
        push: [0.0; D],
        rows,
        gaps: normals.map(|row| row.map(|row| (row, 0.0))),
        friction: core::array::from_fn(|_| random.between(0.05, 0.6)),
        limits: [0.0; C],
        restitutions: core::array::from_fn(|_| random.between(-0.6, 0.8).max(0.0)),
    };
    if base > 0 {
        // A link that flies is not held by a spring.
        (drawn.springs[base], drawn.dampers[base]) = (0.0, 0.0);
    }
    drawn
}

/// A point's distance from a floor with a slope, and its slip.
fn foot(link: usize, at: f64, slope: f64) -> [Row; 2] {
    let (sin, cos) = slope.sin_cos();
    [Row::Point { link, at, along: [sin, cos] }, Row::Point { link, at, along: [cos, -sin] }]
}

/// A start: coordinates, and velocities up to a size.
fn start<const D: usize, const N: usize>(
    random: &mut Random,
    base: usize,
    speed: f64,
) -> ([f64; D], [f64; N]) {
    let coordinates = core::array::from_fn(|k| if k < base { 0.0 } else { 3.0 * random.next() });
    let state = core::array::from_fn(|i| if i < D { coordinates[i] } else { speed * random.next() });
    (coordinates, state)
}

fn stops(random: &mut Random) -> (Stops, [f64; 6]) {
    let sign = |random: &mut Random| if random.next() > 0.0 { 1.0 } else { -1.0 };
    let rows = [1, 2].map(|link| Row::Angle { link, sign: sign(random) });
    let mut drawn = tree::<3, 2, 2>(random, 0, rows, [Some(0), Some(1)]);
    let (coordinates, state) = start(random, 0, 2.0);
    for c in 0..2 {
        drawn.set_gap(c, &coordinates, random.between(0.05, 0.8));
    }
    (Stops(drawn), state)
}

fn feet(random: &mut Random) -> (Feet, [f64; 8]) {
    let slope = 0.2 * random.next();
    let [[a, b], [c, d]] = [2, 3].map(|link| foot(link, random.between(0.4, 1.0), slope));
    let mut drawn = tree::<4, 4, 2>(random, 2, [a, b, c, d], [Some(0), Some(2)]);
    let (coordinates, state) = start(random, 2, 2.0);
    land(&mut drawn, &coordinates, random.between(0.1, 0.5));
    (Feet(drawn), state)
}

/// Puts the floor below the lower of two feet.
fn land<const W: usize, const C: usize>(drawn: &mut Drawn<4, W, C>, coordinates: &[f64; 4], height: f64) {
    let positions = [0, 2].map(|row| drawn.row(coordinates, &[0.0; 4], drawn.rows[row]).0);
    let floor = positions[0].min(positions[1]) - height;
    for (c, position) in positions.into_iter().enumerate() {
        drawn.set_gap(c, coordinates, position - floor);
    }
}

fn mixed(random: &mut Random) -> (Mixed, [f64; 6]) {
    let [normal, slip] = foot(2, random.between(0.4, 1.0), 0.3 * random.next());
    let rows = [normal, slip, Row::Angle { link: 1, sign: 1.0 }, Row::Angle { link: 2, sign: 1.0 }];
    let mut drawn = tree::<3, 4, 3>(random, 0, rows, [Some(0), Some(2), None]);
    drawn.limits[2] = random.between(0.1, 3.0);
    let (coordinates, state) = start(random, 0, 2.0);
    for c in 0..2 {
        drawn.set_gap(c, &coordinates, random.between(0.05, 0.5));
    }
    (Mixed(drawn), state)
}

fn four(random: &mut Random) -> (Four, [f64; 8]) {
    let slope = 0.2 * random.next();
    let [[a, b], [c, d]] = [2, 3].map(|link| foot(link, random.between(0.4, 1.0), slope));
    let rows = [a, b, c, d, Row::Angle { link: 3, sign: 1.0 }, Row::Angle { link: 2, sign: 1.0 }];
    let mut drawn = tree::<4, 6, 4>(random, 2, rows, [Some(0), Some(2), Some(4), None]);
    drawn.limits[3] = random.between(0.1, 2.0);
    let (coordinates, state) = start(random, 2, 2.0);
    land(&mut drawn, &coordinates, random.between(0.1, 0.5));
    drawn.set_gap(2, &coordinates, random.between(0.1, 0.8));
    (Four(drawn), state)
}

fn spatial(random: &mut Random) -> (Spatial, [f64; 8]) {
    let factor: [[f64; 4]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| 0.5 * random.next()));
    let constant = core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            let product: f64 = (0..4).map(|k| factor[i][k] * factor[j][k]).sum();
            product + if i == j { 1.0 } else { 0.0 }
        })
    });
    let mut near = |axis: usize| core::array::from_fn(|k| if k == axis { 1.0 } else { 0.2 * random.next() });
    let normal: [f64; 4] = near(2);
    let rows = [normal, near(0), near(1)].map(|[a, b, c, d]: [f64; 4]| Row::Constant([a, b, c, d, 0.0, 0.0]));
    let mut drawn = tree::<4, 3, 1>(random, 0, rows, [Some(0)]);
    drawn.constant = Some(constant);
    drawn.push = normal.map(|entry| -8.0 * entry);
    let (coordinates, state) = start(random, 0, 3.0);
    drawn.set_gap(0, &coordinates, random.between(0.05, 0.5));
    (Spatial(drawn), state)
}

/// Whether a typed error is one that drawn systems may end with.
fn is_expected<const C: usize>(cause: &HybridCause<C>) -> bool {
    matches!(
        cause,
        HybridCause::EnergyGain { .. }
            | HybridCause::Painleve { .. }
            | HybridCause::SeveralImpacts
            | HybridCause::NoImpact
            | HybridCause::Ambiguous { .. }
            | HybridCause::Inconsistent
            | HybridCause::Undetermined { .. }
    )
}

/// Runs a system, and judges all of its motion. Typed errors that are expected are added to `ends`.
fn judged<H, const D: usize, const N: usize, const W: usize, const C: usize>(
    (system, start): (H, [f64; N]),
    drawn: &Drawn<D, W, C>,
    end: f64,
    judged: &mut Judged,
    ends: &mut Vec<String>,
) -> Result<(), String>
where
    H: HybridSystem<N, W, C, 0, Mode = Mode<C>> + Copy + core::fmt::Debug,
{
    let ended = ends.len();
    let motion = match system.simulation(&start).tolerance(1e-10).run(0.0..end) {
        Ok(motion) => motion,
        Err(failed) => {
            if !is_expected(&failed.error.cause) {
                let last = failed.trajectory.transitions().last();
                return Err(format!("{failed}\n{system:?}\nfrom {start:?}\n{last:#?}"));
            }
            ends.push(format!("{failed}"));
            *failed.trajectory
        }
    };
    let told = |found: Result<(), String>| found.map_err(|why| format!("{why}\n{system:?}\nfrom {start:?}"));
    for transition in motion.transitions() {
        told(judged.transition(&system, transition, |x| drawn.kinetic(x)))?;
    }
    // Where an error ends the run, what fired there has not yet led to another mode.
    let last = ends.len() > ended;
    for (t, x) in motion.sample(0.05).filter(|(t, _)| !(last && *t == motion.end_time())) {
        told(judged.mode(&system, (t, &x), &motion.mode_at(t)))?;
    }
    Ok(())
}

/// Draws a system of each family, and judges the motions of those that are asked for: stops, feet, mixed, four, spatial. Returns what was
/// wrong, by family.
fn judge_round(
    random: &mut Random,
    asked: [bool; 5],
    total: &mut Judged,
    ends: &mut Vec<String>,
) -> Vec<(usize, String)> {
    let mut wrong = Vec::new();
    let mut told = |family: usize, found: Result<(), String>| {
        if let Err(why) = found {
            wrong.push((family, why));
        }
    };
    let drawn = stops(random);
    if asked[0] {
        told(0, judged(drawn, &drawn.0.0, 4.0, total, ends));
    }
    let drawn = feet(random);
    if asked[1] {
        told(1, judged(drawn, &drawn.0.0, 2.0, total, ends));
    }
    let drawn = mixed(random);
    if asked[2] {
        told(2, judged(drawn, &drawn.0.0, 3.0, total, ends));
    }
    let drawn = four(random);
    if asked[3] {
        told(3, judged(drawn, &drawn.0.0, 2.0, total, ends));
    }
    let drawn = spatial(random);
    if asked[4] {
        told(4, judged(drawn, &drawn.0.0, 3.0, total, ends));
    }
    wrong
}

/// The seed of the rounds, where `GUEN_SEED` says no other.
const SEED: u64 = 20_261_124;

#[test]
fn drawn_systems_keep_the_laws() {
    let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse().ok());
    let (seed, first) = (number("GUEN_SEED").unwrap_or(SEED), number("GUEN_FIRST").unwrap_or(0) as usize);
    let rounds = rounds(5);
    let (mut total, mut ends) = (Judged::default(), Vec::new());
    let mut random = Random(seed);
    let mut wrong = 0;
    for round in 0..first + rounds {
        let asked = [round >= first; 5];
        for (family, why) in judge_round(&mut random, asked, &mut total, &mut ends) {
            wrong += 1;
            println!("round {round} of seed {seed}, family {family}: {why}");
        }
    }
    for end in &ends {
        println!("{end}");
    }
    println!("{} systems, {} typed errors: {total:?}", 5 * rounds, ends.len());
    assert_eq!(wrong, 0);
    assert!(total.transitions > 15 * rounds && total.impacts > 5 * rounds && ends.len() <= rounds / 2);
    assert!(total.rays <= total.modes / 100 && total.several <= total.modes / 1000);
}

/// Rounds with families in which something was once wrong.
const ONCE_FAILED: [(usize, usize); 20] = [
    // Two feet nearly in line with the hinge between them: the row that the others were to hold was not held, by half a millionth.
    (2130, 3),
    // Everything came to rest at once: rates that the last digit of the time makes of accelerations were taken for motion.
    (622, 3),
    (905, 2),
    (1170, 2),
    // Flights no higher than the rounding of a gap ended below it, which gave energy to each of some fifty thousand impacts.
    (415, 1),
    (1289, 2),
    (2302, 1),
    // Each impact tore a grip off, so that bounces that digits do not tell never ended.
    (431, 3),
    // Feet on their way up kept a stop from coming to rest.
    (1433, 3),
    // A gap dipped below zero from a place at which it was zero within rounding, and was not looked at again.
    (2206, 0),
    // One contact struck while another was below zero by little more than rounding, and fell.
    (2709, 0),
    (2253, 2),
    // Rows nearly depend on each other: a mode was taken, or refused, for values that are small and not zero.
    (3555, 3),
    (3845, 1),
    // A slip of a few billionths before a contact closed was taken for none.
    (3686, 3),
    (6534, 1),
    // A slip that left zero hardly accelerated came back within the roundings of the step's polynomial, again and again.
    (4662, 2),
    // A sequence was closed by an impact that gave energy to what it closed.
    (7413, 2),
    // Coulomb's law has two answers, and the other solver found the other one.
    (3572, 2),
    (4185, 2),
];

/// All of them where `GUEN_ROUNDS` is set; in a run of all tests, which are not optimised, every third one.
#[test]
fn rounds_that_once_failed_keep_the_laws() {
    let step = if asked_rounds().is_some() { 1 } else { 3 };
    let failed: Vec<(usize, usize)> = ONCE_FAILED.iter().copied().step_by(step).collect();
    let last = failed.iter().map(|(round, _)| *round).max().unwrap_or(0);
    let mut random = Random(SEED);
    let (mut total, mut ends, mut wrong) = (Judged::default(), Vec::new(), 0);
    for round in 0..=last {
        let asked = core::array::from_fn(|family| failed.contains(&(round, family)));
        for (family, why) in judge_round(&mut random, asked, &mut total, &mut ends) {
            wrong += 1;
            println!("round {round}, family {family}: {why}");
        }
    }
    assert!(wrong == 0 && ends.is_empty(), "{wrong} {ends:?}");
}

/// Slips in a plane end in sticking, or leave rest in the one direction along which they accelerate: none of these has a paradox.
#[test]
fn spatial_slips_end_in_a_mode() {
    let mut random = Random(20_261_124);
    let mut reversed = 0;
    for _ in 0..40 {
        stops(&mut random);
        feet(&mut random);
        mixed(&mut random);
        four(&mut random);
        let (system, start) = spatial(&mut random);
        let motion = system.simulation(&start).tolerance(1e-10).run(0.0..3.0);
        let motion = motion.unwrap_or_else(|failed| panic!("{failed}: {system:?} from {start:?}"));
        let kinds = motion.transitions().iter().map(|transition| transition.kind);
        reversed += kinds.filter(|kind| *kind == TransitionKind::Reversed).count();
    }
    assert!(reversed > 0);
}

/// Accelerations in a mode without slip against those of a system with these rows as constraints.
fn constrained<H, const D: usize, const N: usize, const W: usize, const C: usize>(
    system: H,
    drawn: &Drawn<D, W, C>,
    state: &[f64; N],
    random: &mut Random,
) where
    H: HybridSystem<N, W, C, 0, Mode = Mode<C>> + Copy,
{
    let mode = Mode(core::array::from_fn(|c| {
        let states = ElementState::of(&H::ELEMENTS[c]);
        states[random.below(states.len().min(2))]
    }));
    let held: Vec<usize> = (0..C)
        .filter(|c| mode.0[*c].is_closed())
        .flat_map(|c| H::ELEMENTS[c].normal.into_iter().chain(H::ELEMENTS[c].tangential.iter().copied()))
        .collect();
    // With less freedom than rows reactions are not determined.
    if held.len() > D || mode.0.iter().any(|state| state.slips()) {
        return;
    }
    let (q, v) = (core::array::from_fn(|i| state[i]), core::array::from_fn(|i| state[D + i]));
    let (masses, pushes) = drawn.dynamics::<f64>(&q, &v);
    let size = D + held.len();
    let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for i in 0..D {
        right[i] = pushes[i];
        for j in 0..D {
            matrix[(i, j)] = masses[i][j];
        }
    }
    for (k, &row) in held.iter().enumerate() {
        let (_, form, rest) = drawn.row::<f64>(&q, &v, drawn.rows[row]);
        right[D + k] = -rest;
        for i in 0..D {
            matrix[(i, D + k)] = -form[i];
            matrix[(D + k, i)] = form[i];
        }
    }
    let solved = matrix.lu().solve(&right).unwrap();
    let in_mode = InMode::new(system, mode, 0.0, state);
    if in_mode.is_redundant() {
        return;
    }
    let rates: [f64; N] = in_mode.rates(0.0, state);
    let scale = solved.iter().fold(1.0, |most: f64, value| most.max(value.abs()));
    for i in 0..D {
        assert!((rates[D + i] - solved[i]).abs() < 1e-9 * scale, "{mode}: {rates:?} {solved:?}");
    }
}

#[test]
fn held_modes_are_systems_with_constraints() {
    let mut random = Random(31);
    for _ in 0..rounds(100) {
        let (system, state) = stops(&mut random);
        constrained(system, &system.0, &state, &mut random);
        let (system, state) = feet(&mut random);
        constrained(system, &system.0, &state, &mut random);
        let (system, state) = mixed(&mut random);
        constrained(system, &system.0, &state, &mut random);
        let (system, state) = four(&mut random);
        constrained(system, &system.0, &state, &mut random);
        let (system, state) = spatial(&mut random);
        constrained(system, &system.0, &state, &mut random);
    }
}

#[test]
fn elastic_motions_without_friction_go_back() {
    let mut random = Random(77);
    for _ in 0..rounds(8) {
        let (mut system, start) = stops(&mut random);
        system.0.restitutions = [1.0; 2];
        system.0.dampers = [0.0; 3];
        let back = |x: [f64; 6]| core::array::from_fn(|i| if i < 3 { x[i] } else { -x[i] });
        let there = system.simulation(&start).tolerance(1e-12).run(0.0..1.5).unwrap();
        let again = system.simulation(&back(there.end())).tolerance(1e-12).run(0.0..1.5).unwrap();
        let end: [f64; 6] = back(again.end());
        let off = end.iter().zip(&start).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(off < 1e-6, "{off:e} after {} impacts: {system:?}", there.transitions().len());
        assert_eq!(there.transitions().len(), again.transitions().len());
    }
}

#[test]
fn feet_in_another_order_move_as_before() {
    let mut random = Random(5);
    for _ in 0..rounds(8) {
        let (system, start) = feet(&mut random);
        let mut other = system;
        let [a, b, c, d] = system.0.rows;
        other.0.rows = [c, d, a, b];
        let [Some((_, one)), Some((_, two))] = system.0.gaps else { panic!("both feet have gaps") };
        other.0.gaps = [Some((0, two)), Some((2, one))];
        other.0.friction.reverse();
        other.0.restitutions.reverse();
        let run = |system: &Feet| system.simulation(&start).tolerance(1e-11).run(0.0..1.0).ok();
        let (Some(one), Some(other)) = (run(&system), run(&other)) else { continue };
        // Motions with impacts are chaotic: the first transitions only.
        for (one, other) in one.transitions().iter().zip(other.transitions()).take(6) {
            let [left, right] = one.after.0;
            assert!((one.t - other.t).abs() < 1e-8, "{system:?} {one:?} {other:?}");
            assert_eq!(other.after.0, [right, left], "{system:?}");
        }
    }
}
