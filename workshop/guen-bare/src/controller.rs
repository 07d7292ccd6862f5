//! One period of the controller: feedback from the state, torques inside of their limits, and where the robot will be.

use guen::steppers::rk4;
use guen::{Cost, Ordered};

use super::plant::robot::{Inputs, Prepared, State};

/// The states that are fed back: heading, tilt, speed, turn, fall.
pub const FED_BACK: usize = 5;

/// What the controller aims at.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[repr(C)]
pub struct Reference<R = f64> {
    /// The heading, in radians.
    pub heading: R,
    /// The speed, in metres per second.
    pub speed: R,
    /// The turning, in radians per second.
    pub turn: R,
    /// What each motor gives at that speed against friction, in newton metres.
    pub torque: R,
}

/// The feedback `u = u_ref - K (z - z_ref)`, a row for each motor.
pub type Gain<R = f64> = [[R; FED_BACK]; 2];

/// The operations of one period besides eight comparisons, the same in every state: four right-hand sides, what
/// Runge and Kutta's method does with them, and the feedback.
pub const OPERATIONS_PER_PERIOD: Cost = rk4::cost(super::plant::robot::COST, 9).plus(Cost {
    additions: 13,
    multiplications: 10,
    negations: 2,
    ..Cost::ZERO
});

/// One period: the torques at this state, and the state after `step` seconds under them.
pub fn period<R: Ordered>(
    robot: &Prepared<R>,
    gain: &Gain<R>,
    reference: &Reference<R>,
    state: &State<R>,
    step: R,
) -> (Inputs<R>, State<R>) {
    let deviation = [
        state.heading - reference.heading,
        state.tilt,
        state.speed - reference.speed,
        state.turn - reference.turn,
        state.fall,
    ];
    let torque = |row: &[R; FED_BACK]| {
        reference.torque
            - (row[0] * deviation[0]
                + row[1] * deviation[1]
                + row[2] * deviation[2]
                + row[3] * deviation[3]
                + row[4] * deviation[4])
    };
    let wanted = Inputs { left_torque: torque(&gain[0]), right_torque: torque(&gain[1]), push: R::zero() };
    let torques = robot.clamped(&wanted);
    let next = rk4::step(&robot.driven(torques), R::zero(), &(*state).into(), step);
    (torques, next.into())
}
