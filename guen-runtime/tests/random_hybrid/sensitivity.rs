//! Derivatives through the transitions of drawn systems, beside differences of runs from a little before to a little after.

use std::collections::BTreeMap;

use guen_runtime::System;
use guen_runtime::hybrid::{HybridSystem, Mode, NoSaltation, SensitivityError, TransitionKind};
use guen_runtime::steppers::Dop853;

use crate::tree::Random;
use crate::{feet, four, mixed, rounds, spatial, stops};

/// What was compared, and what not.
#[derive(Debug, Default)]
struct Compared {
    by_kind: BTreeMap<String, usize>,
    refused: BTreeMap<String, usize>,
    /// Runs with deviations that went through other transitions.
    others: usize,
    worst: f64,
}

/// Compares at most so many transitions of a motion.
fn compare<H, const N: usize, const W: usize, const C: usize>(
    (system, start): (H, [f64; N]),
    end: f64,
    compared: &mut Compared,
) where
    H: HybridSystem<N, W, C, 0, Mode = Mode<C>> + Copy + core::fmt::Debug,
{
    const TRANSITIONS: usize = 6;
    const AROUND: f64 = 0.02;
    const TOLERANCE: f64 = 1e-12;

    let Ok(motion) = system.simulation(&start).tolerance(TOLERANCE).run(0.0..end) else { return };
    let times: Vec<f64> = motion.transitions().iter().map(|tr| tr.t).collect();
    for (k, told) in motion.transitions().iter().enumerate().take(TRANSITIONS) {
        let earlier = if k > 0 { times[k - 1] } else { 0.0 };
        let later = times.get(k + 1).copied().unwrap_or(end);
        let from = told.t - f64::min(0.5 * (told.t - earlier), AROUND);
        let to = told.t + f64::min(0.5 * (later - told.t), AROUND);
        let kind = format!("{:?}", told.kind);
        let kind = kind.split(' ').next().unwrap().to_string();
        // Impacts that follow each other are not told apart by differences.
        if to - from < 4e-3 || from == told.t || to == told.t {
            continue;
        }
        let place = motion.at(from);
        let Some(in_mode) = motion.in_mode_at(from) else { continue };
        let run = |start: &[f64; N]| {
            let motion = system.simulation(start).tolerance(TOLERANCE).run(from..to).ok()?;
            let kinds: Vec<_> = motion.transitions().iter().map(|tr| (tr.kind, tr.after)).collect();
            Some((kinds, motion))
        };
        let Some((kinds, part)) = run(&place) else { continue };
        if kinds != [(told.kind, told.after)] {
            compared.others += 1;
            continue;
        }
        let matrix = match part.sensitivity(&Dop853::new(TOLERANCE, TOLERANCE)) {
            Ok(matrix) => matrix,
            Err(SensitivityError::Transition { why, .. }) => {
                *compared.refused.entry(format!("{kind}: {why:?}")).or_default() += 1;
                // What is refused has a reason.
                let spatial = H::ELEMENTS.iter().any(|element| element.tangential.len() == 2);
                let reason = match why {
                    NoSaltation::SpatialSlip => spatial,
                    NoSaltation::Grazing => told.kind != TransitionKind::Impact,
                    _ => true,
                };
                assert!(reason, "{why:?} {told:?}");
                continue;
            }
            Err(why) => panic!("{why}: {system:?} from {start:?}"),
        };
        let size = matrix.iter().flatten().fold(1.0, |most: f64, entry| most.max(entry.abs()));
        // The slower a function crosses zero, the smaller the deviations for which its time changes in proportion.
        let slowness = part.saltation(0).unwrap().time.iter().map(|shift| shift * shift).sum::<f64>();
        if slowness > 1e4 {
            compared.others += 1;
            continue;
        }
        let step = 1e-5 / (1.0 + slowness / 50.0);
        for j in 0..N {
            let along = |part: f64| {
                let mut moved = place;
                moved[j] += part * step;
                for _ in 0..3 {
                    in_mode.restore(from, &mut moved).ok()?;
                }
                run(&moved).filter(|(other, _)| *other == kinds).map(|(_, motion)| motion.end())
            };
            let [Some(a), Some(b), Some(c), Some(d)] = [2.0, 1.0, -1.0, -2.0].map(along) else {
                compared.others += 1;
                continue;
            };
            for i in 0..N {
                let difference = (8.0 * (b[i] - c[i]) - (a[i] - d[i])) / (12.0 * step);
                let off = (matrix[i][j] - difference).abs() / size;
                compared.worst = compared.worst.max(off);
                assert!(
                    off < 1e-6,
                    "entry {i}, {j}: {} {difference}, off by {off:e} of {size:e}\n{told:?}\n{system:?} from {place:?} at {from} to {to}",
                    matrix[i][j]
                );
            }
            *compared.by_kind.entry(kind.clone()).or_default() += 1;
        }
    }
}

#[test]
fn derivatives_through_drawn_transitions() {
    let rounds = rounds(1);
    let mut compared = Compared::default();
    let mut random = Random(1_969);
    for _ in 0..rounds {
        compare(stops(&mut random), 3.0, &mut compared);
        compare(feet(&mut random), 1.5, &mut compared);
        compare(mixed(&mut random), 2.0, &mut compared);
        compare(four(&mut random), 1.5, &mut compared);
        compare(spatial(&mut random), 2.0, &mut compared);
    }
    println!("{compared:?}");
    let of = |kind: &str| compared.by_kind.get(kind).copied().unwrap_or(0);
    assert!(of("Impact") > 20 * rounds && of("Sticks") > 2 * rounds, "{compared:?}");
}
