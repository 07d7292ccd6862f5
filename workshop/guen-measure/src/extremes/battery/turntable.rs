//! The ball on a turntable: huge speeds, a speed that changes its sign, clocks that have run for thirty years.

use super::motion::Motion;
use super::systems::Turntable;
use super::{Line, Task};
use crate::both;

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add =
        |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("turntable", quick, ask));
    let start = [0.5, 0.1, 0.2, 1.1, 0.0, 0.3, -0.4, 0.5];
    for (quick, speed) in [(false, 1e3), (true, 1e6), (false, -1e6)] {
        add(
            quick,
            Box::new(move || {
                let (double, long) = both!(Turntable { m: 1.0, a: 0.1, Omega: speed, swing: 0.0, nu: 0.0 });
                let span = 10.0 / f64::abs(speed);
                // The ball itself has to turn as fast to roll there.
                let mut start = start;
                start[5] = -speed * start[0] / 0.1;
                let mut motion = Motion::new("turntable", double, long, start, (0.0, span));
                // It comes near the edge again and again, where a method of order five takes too many steps.
                motion.due = &["Tsit5", "DOP853", "Taylor"];
                motion.ask::<f64>(format!("Omega = {speed:e} rad/s, for {span:.0e} s"))
            }),
        );
    }
    add(
        true,
        Box::new(move || {
            let (double, long) = both!(Turntable { m: 1.0, a: 0.1, Omega: 0.0, swing: 5.0, nu: 3.0 });
            Motion::new("turntable", double, long, start, (0.0, 4.0))
                .ask::<f64>("a speed that changes its sign")
        }),
    );
    for (quick, since) in [(false, 1e6), (true, 1e9)] {
        add(
            quick,
            Box::new(move || {
                let (double, long) = both!(Turntable { m: 1.0, a: 0.1, Omega: 0.5, swing: 0.7, nu: 2.0 });
                let mut motion = Motion::new("turntable", double, long, start, (since, since + 1.0));
                // A rounding of the time, seen by a phase of nu t and by the steps.
                motion.tolerance = f64::max(1e-12, since * f64::EPSILON);
                motion.ask::<f64>(format!("a swinging speed at t = {since:e} s, for 1 s"))
            }),
        );
    }
    tasks
}
