//! Single precision, and lanes of which one fails.

use guen::Laned;
use guen::lanes::{LaneTask, Lanes, Width, dispatch};
use guen::prelude::*;
use guen::steppers::InLanes;
use guen_study::Digits71;

use super::motion::Motion;
use super::systems::{Hoop, Sled, hoop};
use super::{Answer, Line, Task, Verdict};

/// Numbers of single precision.
fn short<const N: usize>(state: [f64; N]) -> [f64; N] {
    state.map(|x| f64::from(x as f32))
}

/// A motion in single precision, whose constants are exact there.
macro_rules! single {
    ($System:ident { $($constant:ident: $value:expr),* }, $start:expr, $span:expr) => {{
        let single = $System::<f32> { $($constant: $value),* }.prepare().expect("constants in their bounds");
        let long = $System { $($constant: Digits71::from_f64(f64::from($value as f32))),* }.prepare();
        let long = long.expect("constants in their bounds");
        let mut motion = Motion::new("single", single, long, short($start), (0.0, $span));
        motion.tolerance = 1e-5;
        motion.steps = 128;
        motion
    }};
}

/// Eight hoops, one of which is faulty, in as many lanes as are asked for.
struct Hoops<'a> {
    system: &'a hoop::Prepared,
    starts: &'a [[f64; 9]; 8],
}

impl LaneTask for Hoops<'_> {
    type Output = Vec<InLanes<9>>;

    fn run<L: Lanes>(self) -> Self::Output {
        let system = <hoop::Prepared as Laned<9>>::gather::<L>(|_| self.system);
        (0..8 / L::COUNT)
            .map(|group| {
                let start =
                    std::array::from_fn(|i| L::from_fn(|lane| self.starts[group * L::COUNT + lane][i]));
                Rk4::new(1e-3).integrate_in_lanes(&system, 0.0, &start, 1.0)
            })
            .collect()
    }
}

fn lanes(asked: &str, width: Width, faulty: [f64; 9]) -> Line {
    const FAULTY: usize = 5;
    let system = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let mut starts: [[f64; 9]; 8] = std::array::from_fn(|k| {
        let theta = 1.0 + 0.05 * k as f64;
        hoop::State { theta, zeta: theta.sin(), eta1: 0.1, eta2: 0.5, eta3: 2.0, ..Default::default() }.into()
    });
    starts[FAULTY] = faulty;
    let ends: Vec<_> =
        dispatch(width, Hoops { system: &system, starts: &starts }).into_iter().flatten().collect();
    let alone = |k: usize| Integration::new(&system, 0.0, &starts[k]).run(&Rk4::new(1e-3), 1.0);
    let mut others = 0.0_f64;
    for (k, end) in ends.iter().enumerate().filter(|(k, _)| *k != FAULTY) {
        let same = matches!((end, &alone(k)), (Ok(a), Ok(b)) if a.state == b.state);
        others = if same { others } else { f64::INFINITY };
    }
    // The faulty one has to end as alone too: for the same reason, at the same time.
    let own = match (ends.get(FAULTY), &alone(FAULTY)) {
        (Some(Err(error)), Err(alone)) if (error.cause, error.time) == (alone.cause, alone.time) => {
            super::motion::refusal(error, false)
        }
        _ => Verdict::Silent { error: f64::INFINITY, allowed: 0.0 },
    };
    let all = if ends.len() == 8 { others } else { f64::INFINITY };
    Line {
        system: "lanes",
        asked: asked.to_owned(),
        against: "each alone".to_owned(),
        answers: vec![
            Answer { by: "the faulty lane", verdict: own },
            Answer { by: "the other lanes", verdict: Verdict::of(all, 0.0) },
        ],
    }
}

pub fn tasks() -> Vec<Task> {
    let mut tasks = vec![
        Task::new("single", true, || {
            let start = [1.25, 0.0, 0.0, 0.0, 0.0, 0.9375, 0.125, 0.5, 2.0];
            single!(Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.8125 }, start, 1.0).ask::<f32>("the hoop in f32")
        }),
        Task::new("single", true, || {
            let start = [1e-3, 0.0, 0.0, 0.0, 0.0, 1e-3, 0.0, 4.0, -4e3];
            single!(Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.8125 }, start, 0.001)
                .ask::<f32>("the hoop in f32, tilt 1e-3")
        }),
        Task::new("single", true, || {
            let start = [0.25, 0.0, 0.0, 0.5, 0.5];
            single!(Sled { m: 1.0, alpha: 0.25, beta: 0.5, k: 0.001, incline: 0.25, g: 9.8125 }, start, 0.5)
                .ask::<f32>("the sled in f32, gamma^2 - beta^2 = 0.2 of gamma^2")
        }),
        Task::new("single", true, || {
            let start = [0.25, 0.0, 0.0, 0.5, 0.5];
            // The condition is 1e5, of which single precision leaves two digits.
            single!(Sled { m: 1.0, alpha: 0.001, beta: 0.5, k: 0.001, incline: 0.25, g: 9.8125 }, start, 0.01)
                .refused()
                .ask::<f32>("the sled in f32, gamma^2 - beta^2 = 8e-6 of gamma^2")
        }),
    ];
    let falling: [f64; 9] = hoop::State { theta: 0.5, zeta: 0.5_f64.sin(), ..Default::default() }.into();
    let mut missing = falling;
    missing[7] = f64::NAN;
    let fast: [f64; 9] =
        hoop::State { theta: 0.3, zeta: 0.3_f64.sin(), eta2: 300.0, eta3: -900.0, ..Default::default() }
            .into();
    for (name, width) in [("four", Width::Four), ("eight", Width::Eight)] {
        tasks.push(Task::new("lanes", true, move || {
            lanes(&format!("{name} lanes, a hoop that is not a number among others"), width, missing)
        }));
        tasks.push(Task::new("lanes", true, move || {
            lanes(&format!("{name} lanes, a hoop that falls through tilt zero among others"), width, falling)
        }));
        tasks.push(Task::new("lanes", true, move || {
            lanes(&format!("{name} lanes, a hoop too fast for its steps among others"), width, fast)
        }));
    }
    tasks
}
