//! Chains: twenty links, upright and folded, mass ratios from 1e-6 to 1e6.

use std::f64::consts::PI;

use super::motion::Motion;
use super::systems::{Chain2, Chain20};
use super::{Line, Task};
use crate::both;

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add = |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("chains", quick, ask));
    for (name, ratio) in [
        ("hanging", 1.0),
        ("hanging", 1e-6),
        ("hanging", 1e6),
        ("upright", 1.0),
        ("upright", 1e-6),
        ("upright", 1e6),
        ("folded", 1.0),
        ("folded", 1e-6),
        ("folded", 1e6),
    ] {
        add(
            false,
            Box::new(move || {
                let (double, long) = both!(Chain20 { m: 1.0, M: ratio, l: 0.1, g: 9.81 });
                let mut start = [0.0; 40];
                for (k, angle) in start.iter_mut().take(20).enumerate() {
                    let bend = 0.1 * f64::sin(k as f64 + 1.0);
                    *angle = match name {
                        "upright" => PI + 1e-6 * bend,
                        "folded" => PI * (k % 2) as f64 + 1e-3 * bend,
                        _ => bend,
                    };
                }
                let mut motion =
                    Motion::new("chains", double, long, start, (0.0, if ratio > 1.0 { 5e-3 } else { 0.05 }));
                // Upright under a heavy end the motion begins within a few hundred of Euler's steps, between two looks.
                motion.steps = if name == "upright" && ratio > 1.0 { 2000 } else { 500 };
                motion.tolerance = 1e-10;
                motion.ask_explicit::<f64>(format!("20 links, {name}, the last mass {ratio:e} of the others"))
            }),
        );
    }
    for (quick, ratio) in [(false, 1e-6), (true, 1e6), (false, 1e12), (true, 1e14)] {
        add(
            quick,
            Box::new(move || {
                let (double, long) = both!(Chain2 { m: 1.0, M: ratio, l: 1.0, g: 9.81 });
                // The inner mass swings between the outer one and the hinge, at the root of their ratio.
                let span = 10.0 / f64::sqrt(9.81 * ratio.max(1.0));
                let motion = Motion::new("chains", double, long, [0.5, 0.5, 0.0, 0.0], (0.0, span));
                let motion = if ratio < 1e12 { motion } else { motion.or_refused() };
                motion.ask::<f64>(format!(
                    "a double pendulum, the last mass {ratio:e} of the other, started straight, for {span:.0e} s"
                ))
            }),
        );
    }
    add(
        true,
        Box::new(|| {
            let (double, long) = both!(Chain2 { m: 1.0, M: 1.0, l: 1.0, g: 9.81 });
            Motion::new("chains", double, long, [PI, PI, 0.0, 0.0], (0.0, 3.0))
                .ask::<f64>("a double pendulum upright, to a rounding of pi")
        }),
    );
    add(
        true,
        Box::new(|| {
            let (double, long) = both!(Chain2 { m: 1.0, M: 1.0, l: 1.0, g: 9.81 });
            Motion::new("chains", double, long, [0.0, PI, 1e-3, 1e4], (0.0, 2e-3))
                .ask::<f64>("a double pendulum folded, the outer link turning at 1e4 rad/s")
        }),
    );
    tasks
}
