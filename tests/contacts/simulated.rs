//! `simulate` of a declared system with contacts: its motion meets them.

use crate::declared::*;

#[test]
fn a_declared_ball_is_simulated_through_its_modes() {
    let ball = BouncingBall::default().prepare().unwrap();
    let start = bouncing_ball::State { z: 1.0, v: 0.0 };
    let motion = ball.simulate(&start, 0.0..6.0).unwrap();
    let landing = motion.transitions()[0].t;
    assert!((landing - f64::sqrt(2.0 / 9.81)).abs() < 1e-9);
    assert!(motion.before(landing).v < -4.0 && motion.at(landing).v > 3.0);
    assert!(motion.end().z.abs() < 1e-12 && motion.end().v.abs() < 1e-12);
    assert!((motion.reactions_at(6.0)[0] - 9.81).abs() < 1e-9);
    let loose = ball.simulation(&start).tolerance(1e-6).run(0.0..1.0).unwrap();
    assert_eq!(loose.transitions().len(), 1);
}
