//! The systems, and their symbols.

use guen::prelude::*;
use guen::steppers::Bounded;

use super::paths;

hoop! { guen::mechanical_system; provide carried, taylor; scene Tilt { track theta; provide energy; } }
sled! { guen::mechanical_system; provide taylor; }
robot! { guen::mechanical_system }
train! { guen::mechanical_system }
cart! { guen::mechanical_system }
particle_pendulum! { guen::mechanical_system }
// A chain of ten links: the test compares it with the one of the benchmarks.
include!("chain.rs");

/// The symbols of one system: for each path its name and what it does with the prepared system, the state, time, step and
/// span.
macro_rules! symbols {
    ($name:ident [$size:literal] |$constants:ident: $count:literal| $prepared:expr;
        $($path:literal: |$system:ident, $state:ident, $t:ident, $step:ident, $span:ident| $work:expr;)*) => {
        $(const _: () = {
            #[unsafe(export_name = concat!(stringify!($name), "_", $path))]
            extern "C" fn exported(
                $constants: &[f64; $count], $state: &mut [f64; $size], $t: f64, $step: f64, $span: f64,
            ) -> bool {
                let _ = ($step, $span);
                match $prepared {
                    Ok($system) => $work,
                    Err(_) => false,
                }
            }
        };)*
    };
}

/// The paths that every system has, besides those given.
macro_rules! all_paths {
    ($name:ident [$size:literal] |$constants:ident: $count:literal| $prepared:expr; $($more:tt)*) => {
        symbols! { $name [$size] |$constants: $count| $prepared;
            "rhs": |system, state, t, step, span| paths::rates(&system, state, t);
            "jacobian": |system, state, t, step, span| paths::slopes(&system, state, t);
            "euler": |system, state, t, step, span| paths::run(&system, &Euler::new(step), state, t, span);
            "rk4": |system, state, t, step, span| paths::run(&system, &Rk4::new(step), state, t, span);
            "compensated": |system, state, t, step, span| {
                paths::run(&system, &Rk4::new(step).compensated(), state, t, span)
            };
            "rk8": |system, state, t, step, span| paths::run(&system, &Rk8::new(step), state, t, span);
            "gauss4": |system, state, t, step, span| paths::run(&system, &Gauss4::new(step), state, t, span);
            "gauss6": |system, state, t, step, span| paths::run(&system, &Gauss6::new(step), state, t, span);
            "watched": |system, state, t, step, span| paths::watched(&system, &Rk4::new(step), state, t, span);
            "landing": |system, state, t, step, span| paths::landing(&system, state, t, step, &[t + step, t + span]);
            "period5": |system, state, t, step, span| paths::period(&system, &Bounded::tsit5(25), state, t, span);
            "period8": |system, state, t, step, span| paths::period(&system, &Bounded::dop853(48), state, t, span);
            $($more)*
        }
    };
}

// Methods that choose their steps as well.
all_paths! { hoop [9] |c: 4| Hoop { a: c[0], A: c[1], C: c[2], g: c[3] }.prepare();
    "series": |system, state, t, step, span| paths::series(&system, state, t, step);
    "dop853": |system, state, t, step, span| paths::run(&system, &Dop853::new(step, step), state, t, span);
    "tsit5": |system, state, t, step, span| paths::run(&system, &Tsit5::new(step, step), state, t, span);
    "radau5": |system, state, t, step, span| paths::run(&system, &Radau5::new(step, step), state, t, span);
    "taylor": |system, state, t, step, span| paths::run(&system, &Taylor::new(step, step), state, t, span);
}
// The state is that of the carried form.
all_paths! { carried [13] |c: 4| Hoop { a: c[0], A: c[1], C: c[2], g: c[3] }.prepare().and_then(|hoop| hoop.carried()); }
all_paths! { tilt [4] |c: 4| hoop::Tilt::from(Hoop { a: c[0], A: c[1], C: c[2], g: c[3] }).prepare(); }
all_paths! { sled [5] |c: 6|
    Sled { m: c[0], alpha: c[1], beta: c[2], k: c[3], incline: c[4], g: c[5] }.prepare();
    "series": |system, state, t, step, span| paths::series(&system, state, t, step);
}
all_paths! { chain [20] |c: 3| Chain10 { m: c[0], l: c[1], g: c[2] }.prepare(); }
all_paths! { robot [9] |c: 11|
    Robot {
        m: c[0], mw: c[1], h: c[2], b: c[3], r: c[4], A: c[5], B: c[6], C: c[7], I: c[8], J: c[9], g: c[10],
    }
    .prepare()
    .map(|robot| robot.driven(robot::Inputs { left_torque: c[0], right_torque: c[1] }));
}
all_paths! { train [8] |c: 5|
    Train { m: c[0], I: c[1], l: c[2], d: c[3], k: c[4] }
        .prepare()
        .map(|train| train.driven(train::Inputs { push: c[0], steering: c[1] }));
}
all_paths! { cart [4] |c: 6|
    Cart { M: c[0], m: c[1], l: c[2], I: c[3].into(), c: c[4], g: c[5] }
        .prepare()
        .map(|cart| cart.driven(cart::Inputs { push: c[0], wind: c[1] }));
}
all_paths! { circle [3] |c: 3| ParticlePendulum { m: c[0], l: c[1], g: c[2] }.prepare(); }
// The same, brought back onto its circle after every step.
all_paths! { projected [3] |c: 3| ParticlePendulum { m: c[0], l: c[1], g: c[2] }.prepare().map(guen::projected); }
