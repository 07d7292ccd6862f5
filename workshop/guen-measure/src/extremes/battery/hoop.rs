//! The hoop that rolls: flat, spinning, with inertias of any ratio, without gravity.

use super::motion::Motion;
use super::systems::{Hoop, hoop};
use super::{Line, Task};
use crate::both;

/// The start at a tilt and with rates of turning, tilting and spinning; the centre is above the contact.
fn start(theta: f64, tilting: f64, turning: f64, spin: f64) -> [f64; 9] {
    let (sin, cos) = theta.sin_cos();
    hoop::State {
        theta,
        zeta: sin,
        eta1: tilting,
        eta2: turning * sin,
        eta3: spin + turning * cos,
        ..Default::default()
    }
    .into()
}

type Rolling = Motion<hoop::Prepared, hoop::Prepared<guen_study::Digits71>, 9>;

/// The hoop with these inertias and gravity.
fn motion(inertia: (f64, f64), g: f64, start: [f64; 9], span: f64) -> Rolling {
    let (double, long) = both!(Hoop { a: 1.0, A: inertia.0, C: inertia.1, g: g });
    Motion::new("hoop", double, long, start, (0.0, span))
}

fn usual(start: [f64; 9], span: f64) -> Rolling {
    motion((0.5, 1.0), 9.81, start, span)
}

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add = |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("hoop", quick, ask));
    for exponent in 1..=8 {
        let theta = 10.0_f64.powi(-exponent);
        let quick = [1, 6, 8].contains(&exponent);
        // As fast as keeps the tilt: g cot(theta) against psi'^2 sin(theta) cos(theta); and a fifth more.
        let turning = 1.2 * f64::sqrt(9.81 / f64::powi(theta, 2));
        let span = 20.0 / turning;
        add(
            quick,
            Box::new(move || {
                // The tilt is what all of it is about.
                Motion { absolute: theta.min(1e-3), ..usual(start(theta, 0.0, turning, -turning), span) }
                    .ask::<f64>(format!("tilt {theta:e}, turning at {turning:.1e} rad/s, for {span:.1e} s"))
            }),
        );
    }
    add(
        true,
        Box::new(|| {
            usual(start(0.1, -0.5, 0.0, 0.0), 1.0).refused().ask::<f64>("falling through tilt zero from 0.1")
        }),
    );
    add(
        true,
        Box::new(|| {
            usual(start(std::f64::consts::PI - 1e-9, 0.0, 1.0, 0.0), 0.1)
                .refused()
                .ask::<f64>("tilt next to pi, of which 1e-9 is left")
        }),
    );
    add(
        true,
        Box::new(|| {
            usual(start(1.5, 0.0, 0.0, 0.0), 2.0).refused().ask::<f64>("falling over from rest at tilt 1.5")
        }),
    );
    add(
        false,
        Box::new(|| {
            usual(start(std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0), 2.0)
                .ask::<f64>("upright at rest, to a rounding of pi/2, for 2 s")
        }),
    );
    add(
        true,
        Box::new(|| {
            let [.., eta1, _, eta3] = start(1.16, 0.0, 0.0, 0.0);
            let first = hoop::State {
                theta: 1.16,
                zeta: 1.16_f64.sin(),
                eta1,
                eta2: 0.00188,
                eta3,
                ..Default::default()
            };
            let mut motion = usual(first.into(), 1.0);
            motion.tolerance = 1e-13;
            motion.bounds = &[("Tsit5", 1e-10), ("DOP853", 1e-10), ("Taylor", 1e-12), ("Radau 5", 1e-10)];
            motion.ask::<f64>("falling to a tilt of 4e-4, where it turns at 15,000 rad/s")
        }),
    );
    for (quick, spin) in [(false, 1e-6), (false, 1e-3), (true, 1.0), (false, 1e3), (true, 1e5)] {
        let span = if spin > 1.0 { 20.0 / spin } else { 1.0 };
        add(
            quick,
            Box::new(move || {
                usual(start(1.2, 0.1, 0.2, spin), span)
                    .ask::<f64>(format!("spinning at {spin:e} rad/s, for {span:.0e} s"))
            }),
        );
    }
    for exponent in [-12, -6, 6, 12] {
        let ratio = 10.0_f64.powi(exponent);
        let quick = exponent.abs() == 12;
        add(
            quick,
            Box::new(move || {
                // Light about its diameter it nutates at sqrt(C/A) of its spin, or as fast as a few radians per second.
                let span = if ratio < 1.0 { 10.0 * ratio.sqrt() } else { 0.5 };
                motion((ratio.min(1.0), (1.0 / ratio).min(1.0)), 9.81, start(1.2, 0.1, 0.5, 2.0), span)
                    .ask::<f64>(format!("A/C = {ratio:e}, for {span:.0e} s"))
            }),
        );
    }
    add(
        true,
        Box::new(|| motion((0.5, 1.0), 0.0, start(1.2, 0.3, 0.5, 2.0), 2.0).ask::<f64>("without gravity")),
    );
    tasks
}
