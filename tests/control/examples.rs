//! The systems of the example programs: their linearisations, and their energy against the work along a run.

use guen::prelude::*;

use crate::balance::balance;
use crate::jacobians::{check, numbers};
use guen_study::Digits71;

/// The plant of `balancing_robot` and of the bare library.
#[path = "../../workshop/guen-bare/src/plant.rs"]
#[allow(dead_code, reason = "what controllers need beside the system")]
mod plant;

/// Systems are cut out of their programs, which are modules here and never run.
macro_rules! programs {
    ($($name:ident $path:literal;)*) => {
        $(
            #[path = $path]
            #[allow(dead_code, unused_imports, clippy::duplicate_mod, reason = "only the systems are of interest")]
            mod $name;
        )*
    };
}

programs! {
    sled_tracking "../../examples/sled_tracking.rs";
    estimator "../../examples/estimator.rs";
    identification "../../examples/identification.rs";
    drift "../../examples/drift.rs";
}

use drift::{FourBar, Pendulum, Top};
use estimator::Hoop;
use identification::Sled as Glider;
use plant::Robot;
use sled_tracking::Sled;

#[test]
fn linearisations() {
    for seed in 1..4 {
        let (system, long) = both!(Robot {
            m: 10.0,
            mw: 1.0,
            h: 0.5,
            b: 0.3,
            r: 0.1,
            A: 0.5,
            B: 0.4,
            C: 0.2,
            I: 0.003,
            J: 0.005,
            c: 0.02,
            torque_max: 5.0,
            g: 9.81
        });
        check("balancing_robot", &system, &long, numbers::<9>(seed), numbers::<3>(seed + 10));
        let (system, long) = both!(Sled {
            m: 2.0,
            ahead: 0.1,
            k: 0.4,
            drag: 0.3,
            swirl: 0.05,
            thrust_max: 4.0,
            torque_max: 1.0
        });
        check("sled_tracking", &system, &long, numbers::<5>(seed), numbers::<3>(seed + 10));
        let (system, long) = both!(Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 });
        let mut tilted = numbers::<9>(seed);
        tilted[0] += 1.5;
        check("estimator", &system, &long, tilted, []);
        let (system, long) = both!(Glider { m: 2.0, ahead: 0.1, k: 0.4, drag: 0.3, swirl: 0.05 });
        check("identification", &system, &long, numbers::<5>(seed), []);
        let (system, long) = both!(Pendulum { m: 1.3, l: 0.8, g: 9.81 });
        check("pendulum", &system, &long, numbers::<3>(seed), []);
        let (system, long) = both!(Top { A: 1.0, B: 2.0, C: 2.5 });
        check("top", &system, &long, numbers::<7>(seed), []);
        let (system, long) = both!(FourBar { a: 1.0, b: 2.5, c: 2.0, d: 2.2, rho: 1.0, g: 9.81 });
        let mut open = numbers::<4>(seed);
        (open[1], open[2]) = (0.6 + 0.1 * open[1], 1.9 + 0.1 * open[2]);
        check("four_bar", &system, &long, open, []);
    }
}

#[test]
fn work_is_the_change_of_energy() {
    let system = Robot {
        m: 10.0,
        mw: 1.0,
        h: 0.5,
        b: 0.3,
        r: 0.1,
        A: 0.5,
        B: 0.4,
        C: 0.2,
        I: 0.003,
        J: 0.005,
        c: 0.02,
        torque_max: 5.0,
        g: 9.81,
    };
    let system = system.prepare().unwrap();
    let inputs = plant::robot::Inputs { left_torque: 0.8, right_torque: 0.3, push: -2.0 };
    let power = |t, s: &[f64; 9]| system.power(t, &plant::robot::State::from(*s), &inputs);
    assert!(balance::<9, 10>("balancing_robot", &system.driven(inputs), power, numbers(5), 2.0) > 0.1);

    let system =
        Sled { m: 2.0, ahead: 0.1, k: 0.4, drag: 0.3, swirl: 0.05, thrust_max: 4.0, torque_max: 1.0 };
    let system = system.prepare().unwrap();
    let inputs = sled_tracking::sled::Inputs { thrust: 1.5, torque: 0.2, wind: 0.7 };
    let power = |t, s: &[f64; 5]| system.power(t, &sled_tracking::sled::State::from(*s), &inputs);
    assert!(balance::<5, 6>("sled_tracking", &system.driven(inputs), power, numbers(3), 5.0) > 0.1);

    let system = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
    let power = |t, s: &[f64; 9]| system.power(t, &estimator::hoop::State::from(*s));
    let start = [1.2, 0.0, 0.0, 0.0, 0.0, 0.7 * 1.2_f64.sin(), 0.1, 0.4, 5.0];
    assert!(balance::<9, 10>("estimator", &system, power, start, 2.0) < 1e-8);

    let system = Glider { m: 2.0, ahead: 0.1, k: 0.4, drag: 0.3, swirl: 0.05 }.prepare().unwrap();
    let power = |t, s: &[f64; 5]| system.power(t, &identification::sled::State::from(*s));
    assert!(balance::<5, 6>("identification", &system, power, numbers(2), 5.0) > 0.1);

    let system = Top { A: 1.0, B: 2.0, C: 2.5 }.prepare().unwrap();
    let power = |t, s: &[f64; 7]| system.power(t, &drift::top::State::from(*s));
    let start = [1.0, 0.0, 0.0, 0.0, 0.3, -0.7, 1.1];
    assert!(balance::<7, 8>("top", &system, power, start, 3.0) < 1e-9);
}
