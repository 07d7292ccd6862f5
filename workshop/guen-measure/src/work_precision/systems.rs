//! The six systems of the references, each with the cases of its file.

use std::error::Error;
use std::rc::Rc;

use guen::prelude::*;
use guen::{Fused, TaylorSeries};

use super::methods::{Candidate, Form, candidates};
use super::references::{Case, read};

guen_benchmarks::hoop! { guen::mechanical_system; provide taylor, carried; }
guen_benchmarks::appell! { guen::mechanical_system; provide taylor, carried; }
guen_benchmarks::sled! { guen::mechanical_system; provide taylor, carried; }
guen_benchmarks::even_turntable! { guen::mechanical_system; provide taylor, carried; }
guen_benchmarks::turntable! { guen::mechanical_system; provide taylor, carried; }
guen_benchmarks::euler_top! { guen::mechanical_system; provide taylor, carried; }

/// Trajectories are followed so far, in seconds, where their file goes on.
const LONGEST: f64 = 10.0;

/// One motion of one system, and the methods on it.
pub struct Problem {
    pub system: &'static str,
    pub case: String,
    pub span: f64,
    /// What the roundings of the initial state amount to at the end: no method can be asked for less.
    pub rounding: f64,
    pub candidates: Vec<Candidate>,
}

type Problems = Result<Vec<Problem>, Box<dyn Error>>;

/// A name to ask for a system by, and what reads its references.
type Entry = (&'static str, fn() -> Problems);

/// What comes of the initial state's roundings, to first order: the change of the end, in any entry, by half of the spacing
/// of doubles in each entry of the start, added up. Infinite where the motion cannot be followed that closely.
fn rounding<S: TaylorSeries<f64, N>, const N: usize>(system: &S, case: &Case<N>) -> f64 {
    /// So many spacings are taken for one, that the change is above what the run itself rounds.
    const SPACINGS: f64 = 1e4;

    let end = |start: &[f64; N]| {
        let run = Integration::new(system, 0.0, start).run(&Taylor::new(1e-15, 1e-15), case.span);
        run.map_or([f64::NAN; N], |done| done.state)
    };
    let straight = end(&case.start);
    let mut changes = [0.0; N];
    for j in 0..N {
        let mut moved = case.start;
        moved[j] += SPACINGS * f64::EPSILON * moved[j].abs();
        for (change, (x, y)) in changes.iter_mut().zip(end(&moved).iter().zip(&straight)) {
            *change += (x - y).abs() / (2.0 * SPACINGS);
        }
    }
    changes.into_iter().fold(0.0, |most, change| if change > most || change.is_nan() { change } else { most })
}

/// A function that makes the problems of a system: constants by their names in the declaration and in the file.
macro_rules! problems {
    ($name:ident, $title:literal, $file:literal, $module:ident :: $System:ident { $($constant:ident = $key:literal),* }) => {
        fn $name() -> Problems {
            let mut problems = Vec::new();
            for case in read(include_str!(concat!("../../../../tests/data/", $file)), LONGEST)? {
                let case = Rc::new(case);
                let system = $System { $($constant: case.constant($key)?),* }.prepare()?;
                let carried = system.carried()?;
                let state = $module::State::from(case.start).carried(&carried, 0.0);
                let fused = $System { $($constant: Fused::new(case.constant($key)?)),* }.prepare()?.carried()?;
                let fused_state = $module::carried::State::from(<[f64; _]>::from(state).map(Fused::new));
                problems.push(Problem {
                    system: $title,
                    case: case.label.clone(),
                    span: case.span,
                    rounding: rounding(&system, &case),
                    candidates: candidates(
                        Form { system, start: case.start, case: case.clone() },
                        Form { system: carried, start: state.into(), case: case.clone() },
                        Form { system: fused, start: fused_state.into(), case: case.clone() },
                    ),
                });
            }
            Ok(problems)
        }
    };
}

problems!(hoop_problems, "hoop", "01_hoop_rolling.json", hoop::Hoop { a = "a", A = "A", C = "C", g = "g" });
problems!(appell_problems, "Appell's system", "02_appell_holonomic.json", appell::Appell { a = "a", A = "A", C = "C", g = "g" });
problems!(sled_problems, "sled", "03_sled_incline.json", sled::Sled {
    m = "m", alpha = "alpha", beta = "beta", k = "k", incline = "incl", g = "g"
});
problems!(even_problems, "turntable", "04a_ball_turntable_const.json", even_turntable::EvenTurntable {
    m = "m", a = "a", Omega = "Om0"
});
problems!(varying_problems, "turntable at a varying speed", "04b_ball_turntable_varying.json", turntable::Turntable {
    m = "m", a = "a", Omega = "Om0", swing = "Om1", nu = "nu"
});
problems!(top_problems, "Euler's top", "05_euler_top.json", euler_top::EulerTop { I1 = "I1", I2 = "I2", I3 = "I3" });

/// The systems, by the names that they are asked for by.
pub const SYSTEMS: [Entry; 6] = [
    ("hoop", hoop_problems),
    ("appell", appell_problems),
    ("sled", sled_problems),
    ("turntable", even_problems),
    ("varying", varying_problems),
    ("top", top_problems),
];
