//! States beside the motion of a system with contacts: they go on through impacts, and forces use them.

use core::ops::ControlFlow;

use guen::hybrid::{Hybrid, Transition, TransitionKind};
use guen::prelude::*;

use crate::declared::*;

/// The first impact of a ball whose weight a current lightens, by the closed form of its flight; the states at the impact do not jump, and
/// the filter sees both speeds.
#[test]
fn a_current_goes_on_through_an_impact() {
    let ball = MotorBall::default().prepare().unwrap().driven(motor_ball::Inputs { voltage: 1.0 });
    let start = motor_ball::State { z: 1.0, ..Default::default() };
    let mut seen: Option<([f64; 5], [f64; 5], f64)> = None;
    Hybrid::new(&ball, 0.0, &start.into())
        .transitions(&mut |transition: &Transition<motor_ball::Mode, 5, 1, 1>| {
            assert_eq!(transition.kind, TransitionKind::Impact);
            seen = Some((transition.state_before, transition.state_after, transition.t));
            ControlFlow::Break(())
        })
        .run(&Dop853::new(1e-12, 1e-12), 4.0)
        .unwrap();
    let (before, after, t) = seen.unwrap();
    // The current is 1 - exp(-4 t); z'' = -g + 3/2 current.
    let decay = (-4.0 * t).exp();
    let height = 1.0 - 9.81 / 2.0 * t * t + 1.5 * (t * t / 2.0 - t / 4.0 + (1.0 - decay) / 16.0);
    assert!(height.abs() < 1e-11, "{height}");
    assert!((before[2] - (1.0 - decay)).abs() < 1e-11);
    assert_eq!(before[2..], after[2..]);
    // It fell all the way, and the last state is its path.
    assert!((before[4] - 1.0).abs() < 1e-11, "{}", before[4]);
    assert!((after[1] + before[1] / 2.0).abs() < 1e-12 && before[1] < -1.0);
    // Behind the impact the filter rises toward the new speed.
    let free = ball.in_mode(motor_ball::Mode { floor: motor_ball::Floor::Open });
    let rate = guen::System::rhs(&free, t, &after);
    assert!((rate[3] - (after[1] - after[3]) / 0.5).abs() < 1e-14);
    assert!((rate[1] - (1.5 * after[2] - 9.81)).abs() < 1e-14);
}

/// At rest on the floor the current presses less and less, and lifts the ball where it carries the weight.
#[test]
fn a_current_lifts_the_ball_from_its_floor() {
    let ball = MotorBall { k: 30.0, ..Default::default() }.prepare().unwrap();
    let ball = ball.driven(motor_ball::Inputs { voltage: 1.0 });
    let mut lifted = None;
    Hybrid::new(&ball, 0.0, &motor_ball::State::default().into())
        .transitions(&mut |transition: &Transition<motor_ball::Mode, 5, 1, 1>| {
            lifted = Some((transition.kind, transition.t));
            ControlFlow::Break(())
        })
        .run(&Dop853::new(1e-12, 1e-12), 4.0)
        .unwrap();
    let (kind, t) = lifted.unwrap();
    assert_eq!(kind, TransitionKind::Lifted);
    // 30 (1 - exp(-4 t)) = 2 g.
    assert!((t + (1.0 - 2.0 * 9.81 / 30.0_f64).ln() / 4.0).abs() < 1e-10, "{t}");
    let closed = ball.in_mode(motor_ball::Mode { floor: motor_ball::Floor::Closed });
    assert_eq!(guen::System::rhs(&closed, 0.0, &[0.0; 5]), [0.0, 0.0, 4.0, 0.0, 0.0]);
}
