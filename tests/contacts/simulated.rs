//! `simulate` of a declared system with contacts: its motion meets them.

use guen::steppers::{Dop853, Radau5, Tsit5};

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

/// A gap that swings many times within a step of the motion is followed: the first impact is that of the closed form, and the ball is never
/// inside of the table.
#[test]
fn a_table_that_shakes_fast_is_met_where_it_is() {
    for (om, a) in [(200.0, 1e-3), (500.0, 1e-3), (500.0, 1e-2), (2000.0, 1e-3)] {
        let ball = Shaken { om, A: a, ..Shaken::default() }.prepare().unwrap();
        let gap = |t: f64| 0.05 - 9.81 / 2.0 * t * t - a * (om * t).sin();
        let before = (0..).map(|k| f64::from(k) * 1e-6).find(|t| gap(*t) <= 0.0).unwrap() - 1e-6;
        macro_rules! check {
            ($($method:expr;)*) => {$(
                let run = ball.simulation(&shaken::State { z: 0.05, v: 0.0 }).method($method);
                let motion = run.run(0.0..0.4).unwrap_or_else(|error| panic!("{om} {a} {}: {error}", stringify!($method)));
                let first = motion.transitions()[0].t;
                assert!((first - before - 5e-7).abs() < 1e-6, "{om} {a} {}: {first}", stringify!($method));
                let least = (0..40_000).map(|k| f64::from(k) * 1e-5).map(|t| motion.at(t).z - a * (om * t).sin());
                let least = least.fold(0.0, f64::min);
                assert!(least > -1e-8, "{om} {a} {}: {least:e}", stringify!($method));
            )*};
        }
        check! { Dop853::new(1e-6, 1e-6); Dop853::new(1e-10, 1e-10); Tsit5::new(1e-9, 1e-9); Radau5::new(1e-9, 1e-9); }
    }
}

/// A slip that turns round many times within a step is followed, in any unit of time.
#[test]
fn a_floor_that_shakes_fast_drags_both_ways() {
    let end = |time: f64| {
        let block = Sliding { T: time, ..Sliding::default() }.prepare().unwrap();
        let run = block.simulation(&sliding::State { x: 0.0, u: 0.0 }).method(Dop853::new(1e-10, 1e-10));
        let motion = run.run(0.0..2.0 * time).unwrap_or_else(|error| panic!("{time}: {error}"));
        let end = motion.end();
        (motion.transitions().len(), end.x, end.u * time)
    };
    let (count, x, u) = end(1.0);
    assert!(count > 8, "{count}");
    for time in [1e-3, 1e-6, 1e3] {
        let (other, own_x, own_u) = end(time);
        assert_eq!(other, count, "{time}");
        assert!((own_x - x).abs() < 1e-8 && (own_u - u).abs() < 1e-8, "{time}: {own_x} {x}, {own_u} {u}");
    }
}

/// Resets of a function that swings many times within a step happen every time.
#[test]
fn a_clock_ticks_every_time() {
    for om in [1.0, 20.0, 100.0] {
        let clock = Ticking { om }.prepare().unwrap();
        let end = clock.simulate(&ticking::State { v: 1.0, ..Default::default() }, 0.0..10.0).unwrap().end();
        assert_eq!(end.n, (10.0 * om / core::f64::consts::TAU).floor(), "{om}");
    }
}

/// Ratios of nearly one come to rest, too.
#[test]
fn a_ball_that_hardly_loses_speed_comes_to_rest() {
    for e in [0.99, 0.995, 0.998] {
        let ball = Shaken { A: 0.0, e, ..Shaken::default() }.prepare().unwrap();
        let motion = ball.simulation(&shaken::State { z: 1e-4, v: 0.0 }).tolerance(1e-9).run(0.0..10.0);
        let motion = motion.unwrap_or_else(|error| panic!("{e}: {error}"));
        assert!(motion.end().z.abs() < 1e-12 && motion.end().v == 0.0, "{e}: {:?}", motion.end());
    }
}
