//! Damping of a million per second, stiff springs: explicit methods report what they cannot do, implicit ones hold.

use super::motion::Motion;
use super::systems::{Damped, Rod};
use super::{Line, Task};
use crate::both;

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add = |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("stiff", quick, ask));
    for (quick, rate) in [(false, 1e4), (true, 1e6)] {
        add(
            quick,
            Box::new(move || {
                let (double, long) = both!(Damped { m: 1.0, k: rate, c: rate });
                let mut motion = Motion::new("stiff", double, long, [1.0, -1.0], (0.0, 2e4 / rate));
                motion.steps = 20;
                motion.due = &["DOP853", "Radau 5"];
                motion
                    .ask::<f64>(format!("damping of {rate:e}/s, creeping, in steps of {:.0e} s", 1e3 / rate))
            }),
        );
    }
    add(
        true,
        Box::new(|| {
            let (double, long) = both!(Damped { m: 1.0, k: 1.0, c: 1e6 });
            let mut motion = Motion::new("stiff", double, long, [1.0, -1.0], (0.0, 0.01));
            motion.steps = 10;
            motion.due = &["Radau 5"];
            motion.ask::<f64>("damping of 1e6/s that kills a velocity, in steps of 1 ms")
        }),
    );
    add(
        true,
        Box::new(|| {
            let (double, long) = both!(Rod { m: 1.0, l: 1.0, k: 1e8, g: 9.81 });
            let mut motion = Motion::new("stiff", double, long, [1.0 + 9.81e-8, 0.5, 0.0, 0.0], (0.0, 0.1));
            motion.steps = 100;
            // The rod's length has 16 digits, and its force eight: velocities are not to be known better than that.
            motion.absolute = 1.0;
            motion.due = &["DOP853", "Taylor", "Radau 5"];
            motion.ask::<f64>("a rod of 1e8 N/m that swings, in steps of 1 ms")
        }),
    );
    add(
        true,
        Box::new(|| {
            let (double, long) = both!(Damped { m: 1.0, k: -1.0, c: 0.0 });
            let mut motion = Motion::new("stiff", double, long, [1.0, 0.0], (0.0, 30.0));
            motion.steps = 3000;
            motion.ask::<f64>("a spring that pushes: growth by 5e12")
        }),
    );
    tasks
}
