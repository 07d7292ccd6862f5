//! Starts and spans at the extremes: off the constraints, not finite, subnormal, huge; no span, backwards, 10^8 steps.

use guen::prelude::*;
use guen::steppers::Method;

use guen_study::Digits71;

use super::growth::{allowed, growth};
use super::methods::{self, Promise, Settings, Visitor};
use super::motion::{Motion, refusal};
use super::reference::{PARTS, Reference};
use super::systems::{Circle, Hoop, hoop};
use super::{Answer, Line, Task, Verdict};
use crate::both;

const ROLLING: hoop::State = hoop::State {
    theta: 1.2,
    psi: 0.3,
    phi: -0.2,
    xi: 0.0,
    eta: 0.0,
    zeta: 0.932039085967226,
    eta1: 0.1,
    eta2: 0.6,
    eta3: 2.0,
};

fn rolling(start: hoop::State, span: f64) -> Motion<hoop::Prepared, hoop::Prepared<Digits71>, 9> {
    let (double, long) = both!(Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 });
    Motion::new("starts", double, long, start.into(), (0.0, span))
}

/// A run there and back by every method: back at the start.
struct Return {
    system: hoop::Prepared,
    start: [f64; 9],
    to: f64,
    /// How errors grow on the way back; those made on the way there come to the end by it too.
    growth: f64,
    answers: Vec<Answer>,
}

impl Visitor<f64, hoop::Prepared, 9> for Return {
    fn visit<M: Method<f64, hoop::Prepared, 9>>(&mut self, by: &'static str, promise: Promise, method: &M) {
        let there = Integration::new(&self.system, 0.0, &self.start).run(method, self.to);
        let back = match &there {
            Ok(there) => Integration::new(&self.system, self.to, &there.state).run(method, 0.0),
            Err(error) => Err(*error),
        };
        let verdict = match (there, back) {
            (Ok(there), Ok(back)) => {
                let steps = there.statistics.accepted + back.statistics.accepted;
                let off = (0..9).map(|i| (back.state[i] - self.start[i]).abs()).fold(0.0, f64::max);
                let size = self.start.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                let allowed = match promise {
                    Promise::Fixed => 0.1,
                    Promise::Adaptive(tolerance) => allowed::<9>(steps, self.growth, tolerance),
                };
                Verdict::of(off / size, allowed)
            }
            (Err(error), _) | (_, Err(error)) => refusal(&error, matches!(promise, Promise::Adaptive(_))),
        };
        self.answers.push(Answer { by, verdict });
    }
}

fn there_and_back(to: f64) -> Result<Vec<Answer>, String> {
    let (system, long) = both!(Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 });
    let start: [f64; 9] = ROLLING.into();
    let far = Reference::new(&long, &start, (0.0, to), 1e-3)?.path[PARTS].1.map(Real::to_f64);
    let growth = growth(&system, &Reference::new(&long, &far, (to, 0.0), 1e-3)?)?;
    let mut returns = Return { system, start, to, growth, answers: Vec::new() };
    let settings = Settings { step: if to == 0.0 { 0.1 } else { 1e-3 }, relative: 1e-12, absolute: 1e-12 };
    methods::all::<f64, _, _, 9>(settings, &mut returns);
    Ok(returns.answers)
}

fn line(asked: &str, against: &str, answers: Result<Vec<Answer>, String>) -> Line {
    let failed = |text| vec![Answer { by: "reference", verdict: Verdict::Failed { text } }];
    let answers = answers.unwrap_or_else(failed);
    Line { system: "starts", asked: asked.to_owned(), against: against.to_owned(), answers }
}

/// One method, many steps.
fn many_steps() -> Line {
    let (system, long) = both!(Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 });
    let start: [f64; 9] = ROLLING.into();
    let answer = || {
        let reference = Reference::new(&long, &start, (0.0, 100.0), 1e-3)?;
        // Every step rounds every entry once or twice, and it grows.
        let allowed = 2e8 * 0.5 * f64::EPSILON * growth(&system, &reference)?;
        let verdict = match Integration::new(&system, 0.0, &start).run(&Rk4::new(1e-6), 100.0) {
            Ok(done) => Verdict::of(reference.error(&done.state), allowed),
            Err(error) => refusal(&error, true),
        };
        Ok(vec![Answer { by: "RK4", verdict }])
    };
    line("10^8 steps of RK4 over 100 s", "71 digits", answer())
}

/// A day of rolling, by its energy.
fn a_day() -> Line {
    let system = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let start: [f64; 9] = ROLLING.into();
    let energy = |x: &[f64; 9]| system.energy(0.0, &(*x).into());
    let method = Dop853::new(1e-12, 1e-12).with_max_steps(100_000_000);
    let verdict = match Integration::new(&system, 0.0, &start).run(&method, 86_400.0) {
        Ok(done) => {
            let off = (energy(&done.state) / energy(&start) - 1.0).abs();
            // An error of the tolerance in every step, and twice that in an energy of squares.
            Verdict::of(off, 2.0 * allowed::<9>(done.statistics.accepted, 1.0, 1e-12))
        }
        Err(error) => refusal(&error, true),
    };
    line("rolling for a day", "its energy at the start", Ok(vec![Answer { by: "DOP853", verdict }]))
}

pub fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    let mut add = |quick, ask: Box<dyn FnOnce() -> Line + Send>| tasks.push(Task::new("starts", quick, ask));
    for (name, value) in [("not a number", f64::NAN), ("infinite", f64::INFINITY)] {
        add(
            true,
            Box::new(move || {
                rolling(hoop::State { eta2: value, ..ROLLING }, 1.0)
                    .refused()
                    .ask::<f64>(format!("a velocity that is {name}"))
            }),
        );
    }
    add(
        true,
        Box::new(|| {
            let start = hoop::State { eta1: 5e-324, psi: -5e-324, eta2: 1e-310, ..ROLLING };
            rolling(start, 0.2).ask::<f64>("subnormal velocities")
        }),
    );
    for exponent in [150, 160] {
        let spin = 10.0_f64.powi(exponent);
        add(
            exponent == 150,
            Box::new(move || {
                let start = hoop::State { eta3: spin, eta1: 0.0, eta2: 0.0, ..ROLLING };
                let motion = rolling(start, 20.0 / spin);
                // Its square is no number any more.
                let motion = if exponent > 150 { motion.refused() } else { motion };
                motion.ask::<f64>(format!("spinning at 1e{exponent} rad/s"))
            }),
        );
    }
    for (off, within) in [(1e-12, true), (1e-2, false)] {
        add(
            true,
            Box::new(move || {
                let (double, long) = both!(Circle { m: 1.0, l: 1.0, g: 9.81 });
                let start = [f64::sin(0.3) * (1.0 + off), -f64::cos(0.3) * (1.0 + off), 0.5];
                let motion = Motion::new("starts", double, long, start, (0.0, 1.0));
                let motion = if within { motion } else { motion.refused() };
                motion.ask::<f64>(format!("a particle off its circle by {off:e}"))
            }),
        );
    }
    add(true, Box::new(|| line("no span of time", "the start", there_and_back(0.0))));
    add(true, Box::new(|| line("backwards for 2 s and back again", "the start", there_and_back(-2.0))));
    add(
        true,
        Box::new(|| {
            let mut motion = rolling(ROLLING, 0.0);
            motion.span = (0.0, -2.0);
            motion.ask::<f64>("backwards for 2 s")
        }),
    );
    add(false, Box::new(many_steps));
    add(false, Box::new(a_day));
    tasks
}
