//! Systems with two rough contacts in space: both slip in one impact.

use guen_runtime::hybrid::{HybridCause, HybridSystem, TransitionKind};

use crate::laws::Judged;
use crate::tree::{Random, Row, TwoPoints};
use crate::{rounds, start, tree};

/// A system and a start, with both contacts touching at first or above the ground.
fn drawn(random: &mut Random, touching: bool) -> (TwoPoints, [f64; 12]) {
    let factor: [[f64; 6]; 6] = core::array::from_fn(|_| core::array::from_fn(|_| 0.5 * random.next()));
    let constant = core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            let product: f64 = (0..6).map(|k| factor[i][k] * factor[j][k]).sum();
            product + if i == j { 1.0 } else { 0.0 }
        })
    });
    let mut near = |axis: usize| core::array::from_fn(|k| if k == axis { 1.0 } else { 0.2 * random.next() });
    let forms: [[f64; 6]; 6] = core::array::from_fn(|w| near([2, 0, 1, 5, 3, 4][w]));
    let mut system = tree::<6, 6, 2>(random, 0, forms.map(Row::Constant), [Some(0), Some(3)]);
    system.constant = Some(constant);
    system.push = core::array::from_fn(|k| -8.0 * (forms[0][k] + forms[3][k]));
    let (coordinates, state) = start(random, 0, 3.0);
    for c in 0..2 {
        system.set_gap(c, &coordinates, if touching { 0.0 } else { random.between(0.05, 0.5) });
    }
    (TwoPoints(system), state)
}

#[test]
fn two_slips_in_one_impact_keep_the_laws() {
    let rounds = rounds(4);
    let mut random = Random(20_261_125);
    let mut judged = Judged::default();
    let (mut both, mut ends) = (0, Vec::new());
    for round in 0..rounds {
        let (system, start) = drawn(&mut random, round % 2 == 0);
        let motion = match system.simulation(&start).tolerance(1e-10).run(0.0..0.8) {
            Ok(motion) => motion,
            Err(failed) => {
                ends.push(failed.error.cause);
                *failed.trajectory
            }
        };
        for transition in motion.transitions() {
            let found = judged.transition(&system, transition, |x| system.0.kinetic(x));
            found.unwrap_or_else(|why| panic!("{why}\n{system:?}\nfrom {start:?}"));
            let slips = |rows: [usize; 3]| {
                let rates = |x: &[f64; 12]| {
                    rows.map(|row| {
                        system.0.row(&[0.0; 6], &core::array::from_fn(|k| x[6 + k]), system.0.rows[row]).1
                    })
                    .map(|form| (0..6).map(|k| form[k] * x[6 + k]).sum::<f64>())
                };
                let [_, first, second] = rates(&transition.state_after);
                let [normal, a, b] = rows.map(|row| transition.impulses[row]);
                let slip = f64::hypot(first, second);
                if normal < 1e-9 || slip < 1e-6 {
                    return false;
                }
                // What friction gave in two phases is within the cone, and against the slip where both agree in direction.
                f64::hypot(a, b) <= system.0.friction[rows[0] / 3] * normal * (1.0 + 1e-9)
            };
            both += usize::from(
                transition.kind == TransitionKind::Impact && slips([0, 1, 2]) && slips([3, 4, 5]),
            );
        }
    }
    println!("{rounds} systems, {both} impacts with two slips, {judged:?}, {ends:?}");
    assert!(2 * both >= rounds, "{both}");
    assert!(!ends.contains(&HybridCause::NoImpact) && ends.len() <= rounds / 5, "{ends:?}");
}
