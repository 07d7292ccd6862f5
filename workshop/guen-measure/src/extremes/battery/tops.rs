//! Euler's top next to its separatrix, and at any ratio of its moments.

use super::motion::Motion;
use super::systems::EulerTop;
use super::{Line, Task};
use crate::both;

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add = |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("top", quick, ask));
    for (quick, off) in [(true, 1e-3), (false, 1e-8), (true, 1e-14), (false, 0.0)] {
        add(
            quick,
            Box::new(move || {
                let (double, long) = both!(EulerTop { I1: 1.0, I2: 2.0, I3: 3.0 });
                Motion::new("top", double, long, [0.1, 1.2, 0.3, off, 1.0, off], (0.0, 20.0))
                    .ask::<f64>(format!("turning about the middle axis, off by {off:e}, for 20 s"))
            }),
        );
    }
    for (quick, ratio, span) in [(true, 1e-12, 1e-5), (false, 1e12, 1e-8)] {
        add(
            quick,
            Box::new(move || {
                let (double, long) = both!(EulerTop { I1: 1.0, I2: 2.0, I3: 3.0 * ratio });
                Motion::new("top", double, long, [0.1, 1.2, 0.3, 0.2, 0.3, 1e-3], (0.0, span))
                    .ask::<f64>(format!("a third moment of {ratio:e} of the others, for {span:.0e} s"))
            }),
        );
    }
    add(
        true,
        Box::new(|| {
            let (double, long) = both!(EulerTop { I1: 1.0, I2: 2.0, I3: 3.0 });
            Motion::new("top", double, long, [0.0, 1e-9, 0.0, 0.2, 0.3, 1.0], (0.0, 1.0))
                .ask::<f64>("at the edge of Euler's angles, theta = 1e-9")
        }),
    );
    tasks
}
