//! The times of the runs whose ends are published: the column `time` of the table in `docs/published.md`.
//!
//! ```text
//! cargo test --release -p guen-tests --test motion published::times -- --ignored --nocapture
//! ```

use std::time::Instant;

use guen::prelude::*;
use guen::projected;

use super::{bars, bicycle, bricard, governor, linkages, rattleback, tops, wheels};

/// A run is repeated so often, for the median.
const RUNS: usize = 11;

/// Prints the median of the milliseconds of a run from a state, and its evaluations.
macro_rules! timed {
    ($name:literal, $system:expr, $start:expr, $method:expr, $end:expr) => {{
        let mut times = [0.0; RUNS];
        let mut evaluations = 0;
        for time in &mut times {
            let begin = Instant::now();
            let end = Integration::new(&$system, 0.0, &$start.into()).run(&$method, $end).expect($name);
            *time = begin.elapsed().as_secs_f64() * 1e3;
            evaluations = end.statistics.evaluations;
        }
        times.sort_by(f64::total_cmp);
        println!("{:24} {:9.3} ms {evaluations:8} evaluations", $name, times[RUNS / 2]);
    }};
}

#[test]
#[ignore = "prints times, of an optimised build"]
fn times() {
    let dop = |tolerance| Dop853::new(tolerance, tolerance);
    let bicycle = bicycle::Whipple::default().prepare().unwrap();
    // 4.6 m/s, falling at half a radian a second.
    let start = bicycle::whipple::State { turning: -4.6 / 0.3, roll_rate: 0.5, ..Default::default() };
    timed!("bicycle, 20 s", bicycle, start, dop(1e-9), 20.0);

    let squeezer = linkages::Squeezer::default().prepare().unwrap();
    let start: [f64; 8] = linkages::squeezer_start(&squeezer);
    timed!("squeezer, 0.03 s", projected(&squeezer), start, dop(1e-13), 0.03);
    timed!("squeezer, 0.05 s", projected(&squeezer), start, dop(1e-9), 0.05);

    let axis = linkages::CarAxis::default().prepare().unwrap();
    let start = linkages::car_axis::State { yl: 0.5, xr: 1.0, yr: 0.5, ..Default::default() };
    timed!("car axis, 3 s", projected(&axis), start, dop(1e-13), 3.0);

    let top = tops::HeavyTop::default().prepare().unwrap();
    let start = tops::heavy_top::State { w: 1.0, spin_y: 150.0, spin_z: -4.61538, ..Default::default() };
    timed!("heavy top, 0.2 s", projected(&top), start, dop(1e-13), 0.2);

    let governor = governor::Governor::default().prepare().unwrap();
    let angle = core::f64::consts::FRAC_PI_3;
    let spin = core::f64::consts::TAU;
    let start = governor::governor::State { one: angle, two: angle, z: 0.5, spin, ..Default::default() };
    timed!("governor, 10 s", governor, start, Radau5::new(1e-9, 1e-9), 10.0);

    let bars = bars::Parallel::default().prepare().unwrap();
    let start = bars::parallel::State { a: core::f64::consts::FRAC_PI_2, turn: -1.0 };
    timed!("four-bars, 10 s", bars, start, dop(1e-9), 10.0);

    let ring = bricard::Bricard::default().prepare().unwrap();
    let start = bricard::cube();
    timed!("Bricard, 10 s", projected(&ring), start, dop(1e-9), 10.0);

    timed!("rattleback, 5 s", rattleback::stone(), rattleback::start(), dop(1e-12), 5.0);

    let wheel = wheels::RollingWheel::default().prepare().unwrap();
    let start =
        wheels::rolling_wheel::State { x: 0.2, z: 0.2, leaning: -1.0, rolling: -5.0, ..Default::default() };
    timed!("rolling wheel, 4 s", wheel, start, dop(1e-9), 4.0);

    let set = wheels::WheelSet::new().prepare().unwrap();
    let start = wheels::wheel_set::State { x: 0.1, z: 0.1, ..Default::default() };
    timed!("wheel set, 1 s", set, start, dop(1e-9), 1.0);
}
