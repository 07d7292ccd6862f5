//! Chaplygin's sled on an incline: a mass matrix that is nearly singular, headings at quarter turns, stiff runs.

use guen_study::Digits71;

use super::motion::Motion;
use super::systems::{Sled, sled};
use super::{Line, Task};
use crate::both;

type Sliding = Motion<sled::Prepared, sled::Prepared<Digits71>, 5>;

fn motion((alpha, beta, k): (f64, f64, f64), incline: f64, start: [f64; 5], span: f64) -> Sliding {
    let (double, long) = both!(Sled { m: 1.0, alpha: alpha, beta: beta, k: k, incline: incline, g: 9.81 });
    Motion::new("sled", double, long, start, (0.0, span))
}

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add = |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("sled", quick, ask));
    for exponent in [0, -2, -4, -6, -8, -10, -12, -13, -14] {
        // gamma^2 - beta^2 = alpha^2 + k^2, with alpha = k / 2.
        let part = 10.0_f64.powi(exponent);
        let k = f64::sqrt(part / 1.25);
        let beta = f64::sqrt(1.0 - part);
        let quick = [0, -8, -12, -14].contains(&exponent);
        // The nearer to singular, the faster it turns: rates of about g alpha / (alpha^2 + k^2).
        let span = 0.5 * f64::powf(part, 0.25);
        add(
            quick,
            Box::new(move || {
                let motion = motion((0.5 * k, beta, k), 0.3, [0.3, 0.0, 0.0, 0.2, 0.5], span);
                let asked = format!("gamma^2 - beta^2 = {part:e} of gamma^2, for {span:.1e} s");
                // At 1e12 the condition of the mass matrix is at its limit.
                let motion = if exponent > -12 { motion } else { motion.or_refused() };
                motion.ask::<f64>(asked)
            }),
        );
    }
    add(
        true,
        Box::new(|| motion((0.0, 0.3, 0.4), 0.3, [0.3, 0.0, 0.0, 0.7, 0.5], 2.0).ask::<f64>("alpha = 0")),
    );
    for quarters in 0..4 {
        for ulp in [-1_i64, 0, 1] {
            let turn = f64::from(quarters) * std::f64::consts::FRAC_PI_2;
            let phi = if quarters == 0 {
                ulp as f64 * f64::from_bits(1)
            } else {
                f64::from_bits((turn.to_bits() as i64 + ulp) as u64)
            };
            add(
                quarters == 1,
                Box::new(move || {
                    motion((0.2, 0.3, 0.4), 0.3, [phi, 0.0, 0.0, 0.7, 0.5], 0.5)
                        .ask::<f64>(format!("heading of {quarters} quarter turns, {ulp:+} ulp"))
                }),
            );
        }
    }
    // The rate at which turning dies: alpha eta2 / (alpha^2 + k^2).
    add(
        true,
        Box::new(|| {
            let mut motion = motion((1e-3, 0.0, 1e-3), 0.0, [0.0, 0.0, 0.0, 0.1, 6.0], 0.1);
            motion.due = &["DOP853", "Radau 5"];
            motion.steps = 100;
            motion.ask::<f64>("turning that dies at 3000/s, in steps of 1 ms")
        }),
    );
    add(
        false,
        Box::new(|| {
            let mut motion = motion((1e-3, 0.0, 1e-3), 0.3, [0.0, 0.0, 0.0, 0.1, 6.0], 0.1);
            motion.steps = 20_000;
            motion.ask::<f64>("the same on an incline, in steps of 5 us")
        }),
    );
    tasks
}
