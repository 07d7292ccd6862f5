//! A sweep that is killed at any instant goes on where it was: nothing is lost, and nothing is counted twice.
//!
//! The program is this test's own executable, started again as `runs_a_part_until_it_is_killed`.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

use guen_runtime::lanes::Lanes;
use guen_runtime::steppers::Rk4;
use guen_runtime::{Laned, Real, Simulate, System};
use guen_study::{Design, Sweep};

use crate::{Folder, Random};

/// Kills in a usual run; `GUEN_KILLS` sets another number.
const KILLS: u64 = 12;
/// The variable by which the program that is to be killed learns where to write.
const FOLDER: &str = "GUEN_TEST_SWEEP";

/// `x'' = -k sin x`
#[derive(Clone, Copy)]
struct Pendulum<R>(R);

impl<R: Real> System<R, 2> for Pendulum<R> {
    #[inline]
    fn rhs(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        R::vectorize(
            #[inline(always)]
            || [v, -self.0 * x.sin()],
        )
    }
}

impl Simulate<f64, 2> for Pendulum<f64> {
    type State = [f64; 2];
    const STATES: &'static [&'static str] = &["x", "v"];
}

impl Laned<2> for Pendulum<f64> {
    type Over<L: Lanes> = Pendulum<L>;

    fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Pendulum<L> {
        Pendulum(L::from_fn(|lane| member(lane).0))
    }
}

fn sweep() -> Sweep<'static> {
    let design = Design::latin_hypercube(960, 1).uniform("k", 0.5, 2.0).uniform("start", 0.0, 3.0);
    Sweep::over(design, |point| {
        if point.index() % 97 == 5 {
            Err("left out".into())
        } else {
            Ok((Pendulum(point.get("k")?), [point.get("start")?, 0.0]))
        }
    })
    .end_states(Rk4::new(0.05), 0.0..2.0)
    .with_chunk(8)
    .silent()
}

/// The program that is to be killed; as a test of its own it does nothing.
#[test]
fn runs_a_part_until_it_is_killed() {
    let Some(folder) = env::var_os(FOLDER) else { return };
    sweep().part(0, 1).unwrap().run_in(folder).unwrap();
}

/// The files of a finished sweep by their names, without locks and what a kill has left.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for below in [folder.to_path_buf(), folder.join("rows")] {
        for entry in fs::read_dir(below).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
            if path.is_file() && !name.starts_with('.') {
                found.insert(name, fs::read(path).unwrap());
            }
        }
    }
    found
}

#[test]
fn a_sweep_that_is_killed_ends_with_the_same_files() {
    let kills = env::var("GUEN_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(KILLS);
    let folder = Folder::new("sweeps");
    let (whole, killed) = (folder.0.join("whole"), folder.0.join("killed"));
    let program = |folder: &Path| {
        Command::new(env::current_exe().unwrap())
            .args(["--exact", "sweeps::runs_a_part_until_it_is_killed", "--nocapture"])
            .env(FOLDER, folder)
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    let start = Instant::now();
    assert!(program(&whole).wait().unwrap().success());
    let took = start.elapsed();
    let summary = sweep().merge([&whole], &whole).unwrap();
    let mut random = Random(23);
    let mut before_the_end = 0;
    for kill in 0..kills {
        let written = || fs::read_dir(killed.join("rows")).map_or(0, Iterator::count);
        let awaited = written() + random.below(10) as usize;
        let mut child = program(&killed);
        // Most runs end within one of their next chunks, the last ones anywhere, where they write their record too.
        let wait = if 4 * kill < 3 * kills {
            while written() <= awaited && child.try_wait().unwrap().is_none() {}
            took / 120
        } else {
            took
        };
        thread::sleep(Duration::from_micros(random.below(wait.as_micros() as u64)));
        child.kill().unwrap();
        before_the_end += u32::from(!child.wait().unwrap().success());
    }
    let last = sweep().part(0, 1).unwrap().run_in(&killed).unwrap();
    println!(
        "{before_the_end} of {kills} kills came before the end; the last run found {} chunks",
        last.found
    );
    assert!(!last.record_was_damaged && before_the_end > 0);
    assert_eq!(sweep().merge([&killed], &killed).unwrap(), summary);
    let (found, expected) = (files(&killed), files(&whole));
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    assert!(found == expected, "files differ");
    assert_eq!(summary.statistics().motions(), 960);
    assert_eq!(summary.statistics().faults(), 10);
}
