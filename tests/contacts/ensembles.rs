//! Ensembles of systems with contacts: on any number of threads the motions of single members, to the bit.

use guen::hybrid::{HybridCause, Transition};
use guen_study::Ensemble;

use crate::declared::{ThrownBall, thrown_ball};

/// Thrown balls of several restitutions, of which every ninth begins below the floor.
fn members() -> Vec<(thrown_ball::Prepared, [f64; 6])> {
    (0..40)
        .map(|k| {
            let part = f64::from(k) / 40.0;
            let ball = ThrownBall { e: 0.9 * part, mu: 0.1 + 0.4 * part, ..ThrownBall::default() };
            let height = if k % 9 == 4 { 0.05 } else { 0.5 + part };
            (ball.prepare().unwrap(), [0.0, height, 0.0, 3.0 - 5.0 * part, 0.0, 40.0 * part - 20.0])
        })
        .collect()
}

type Told = Vec<(f64, [f64; 6], [f64; 2], thrown_ball::Mode)>;

fn told(transitions: &[Transition<thrown_ball::Mode, 6, 2, 1>]) -> Told {
    transitions.iter().map(|at| (at.t, at.state_after, at.impulses, at.after)).collect()
}

#[test]
fn transitions_have_the_same_bits_on_any_number_of_threads() {
    let run = |threads: usize| {
        Ensemble::of_systems(members()).with_threads(threads).mode_simulations(|simulation| match simulation
            .tolerance(1e-10)
            .run(0.0..2.0)
        {
            Ok(motion) => Ok((motion.end(), told(motion.transitions()))),
            Err(stopped) => Err((stopped.error.cause, told(stopped.trajectory.transitions()))),
        })
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(5));
    // Those of single members.
    for ((ball, start), found) in members().iter().zip(&one) {
        let alone = guen::hybrid::HybridSystem::simulation(ball, start).tolerance(1e-10).run(0.0..2.0);
        match (alone, found) {
            (Ok(motion), Ok((end, transitions))) => {
                assert_eq!((motion.end(), told(motion.transitions())), (*end, transitions.clone()));
            }
            (Err(stopped), Err((cause, _))) => assert_eq!(stopped.error.cause, *cause),
            (alone, found) => panic!("{alone:?} {found:?}"),
        }
    }
    let failed: Vec<usize> = (0..40).filter(|k| one[*k].is_err()).collect();
    assert_eq!(failed, [4, 13, 22, 31]);
    assert!(matches!(one[4], Err((HybridCause::Penetrating { contact: "floor", .. }, _))));
    assert!(one.iter().flatten().all(|(_, transitions)| transitions.len() > 1));
}
