//! Every method runs through modes; the trajectory that a simulation leaves.

use core::ops::ControlFlow;

use guen_runtime::hybrid::{Hybrid, InMode, Mode, Transition, TransitionKind};
use guen_runtime::steppers::{Dop853, Gauss4, Gauss6, Method, Radau5, Rk4, Rk8, Taylor, Tsit5};

use crate::systems::PendulumStop;

/// The first impact and the transitions of a pendulum against a stop until `t = 4`.
fn stops<M>(method: &M) -> (f64, usize)
where
    M: Method<f64, InMode<PendulumStop, 2, 1, 1, 0>, 2>,
{
    let (mut first, mut count) = (0.0, 0);
    Hybrid::new(&PendulumStop, 0.0, &[1.0, 0.0])
        .transitions(&mut |tr: &Transition<Mode<1>, 2, 1, 1>| {
            assert_eq!(tr.kind, TransitionKind::Impact);
            count += 1;
            if count == 1 {
                first = tr.t;
            }
            ControlFlow::Continue(())
        })
        .run(method, 4.0)
        .unwrap();
    (first, count)
}

#[test]
fn every_method_finds_the_stop() {
    let expected = 0.601_871_402_924_920_9;
    let runs = [
        ("Rk4", stops(&Rk4::new(1e-3)), 1e-9),
        ("Rk8", stops(&Rk8::new(1e-2)), 1e-12),
        ("compensated Rk8", stops(&Rk8::new(1e-2).compensated()), 1e-12),
        ("Gauss4", stops(&Gauss4::new(1e-2)), 1e-8),
        ("Gauss6", stops(&Gauss6::new(1e-2)), 1e-11),
        ("Tsit5", stops(&Tsit5::new(1e-10, 1e-10)), 1e-8),
        ("Dop853", stops(&Dop853::new(1e-12, 1e-12)), 1e-11),
        ("Radau5", stops(&Radau5::new(1e-10, 1e-10)), 1e-8),
        ("Taylor", stops(&Taylor::new(1e-15, 1e-15)), 1e-14),
    ];
    for (name, (first, count), accuracy) in runs {
        assert_eq!(count, 3, "{name}");
        assert!((first - expected).abs() < accuracy, "{name}: {:e}", first - expected);
    }
}

#[cfg(feature = "alloc")]
#[test]
fn a_trajectory_knows_both_sides_of_a_transition() {
    use crate::systems::ThrownBall;
    use guen_runtime::hybrid::HybridSystem;

    let start = [0.0, 1.1, 0.0, 3.0, 0.0, -40.0];
    let motion = ThrownBall.simulation(&start).tolerance(1e-11).run(0.0..2.0).unwrap();
    assert_eq!((motion.start_time(), motion.end_time()), (0.0, 2.0));
    assert!(motion.transitions_of("floor").count() == motion.transitions().len());
    assert_eq!(motion.transitions_of("ceiling").count(), 0);
    for tr in motion.transitions() {
        assert_eq!((motion.before(tr.t), motion.at(tr.t)), (tr.state_before, tr.state_after));
        assert_eq!(motion.mode_at(tr.t), tr.after);
        // Next to it the motion is near.
        let (earlier, later) = (motion.at(tr.t - 1e-9), motion.at(tr.t + 1e-9));
        for i in 0..6 {
            assert!((earlier[i] - tr.state_before[i]).abs() < 1e-7, "{tr:?}");
            assert!((later[i] - tr.state_after[i]).abs() < 1e-7, "{tr:?}");
        }
    }
    // It rolls in the end, on a floor that carries its weight.
    let [normal, along] = motion.reactions_at(1.9);
    assert!((normal - 9.81).abs() < 1e-12 && along.abs() < 1e-12);
    assert_eq!(motion.at(5.0), motion.end());
    assert_eq!(motion.at(-1.0), start);
    assert_eq!(motion.sample(0.5).map(|(t, _)| t).collect::<Vec<_>>(), [0.0, 0.5, 1.0, 1.5, 2.0]);
    let times: Vec<f64> = motion.times().collect();
    assert!(times.windows(2).all(|pair| pair[0] <= pair[1]) && times.last() == Some(&2.0));
    // What does not fit is refused, and what fits is kept.
    let failed = ThrownBall.simulation(&start).memory(2000).run(0.0..2.0).unwrap_err();
    let end = failed.error.t;
    assert!(end < 2.0 && failed.trajectory.end_time() == end, "{failed}");
    assert!(failed.trajectory.transitions().iter().all(|tr| tr.t <= end));
    let (here, there) = (failed.trajectory.at(0.99 * end), motion.at(0.99 * end));
    for i in 0..6 {
        assert!((here[i] - there[i]).abs() < 1e-6, "{here:?} {there:?}");
    }
    assert_eq!(ThrownBall.restitutions(), [0.5]);
}
