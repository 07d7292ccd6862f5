use std::path::{Path, PathBuf};

use guen_runtime::lanes::{Backend, Lanes, Width};
use guen_runtime::steppers::{Integration, Rk4};
use guen_runtime::{Laned, OutputMap, Real, Simulate, System, Trigger};

use super::{Design, DesignFault, Rows, Sweep, SweepError};

#[cfg(feature = "parquet")]
mod parquet;
mod refused;
mod shared;

/// `q'' = sqrt(q^2 - 1) - k sin q`: it runs away, or fails where it comes below one.
#[derive(Clone, Copy, Debug)]
struct Oscillator<R>(R);

impl<R: Real> System<R, 2> for Oscillator<R> {
    #[inline]
    fn rhs(&self, _t: R, &[q, w]: &[R; 2]) -> [R; 2] {
        R::vectorize(
            #[inline(always)]
            || [w, (q * q - R::one()).sqrt().minus_times(self.0, q.sin())],
        )
    }
}

impl Simulate<f64, 2> for Oscillator<f64> {
    type State = [f64; 2];
    const STATES: &'static [&'static str] = &["q", "w"];
    const UNITS: &'static [&'static str] = &["rad", "1/s"];
}

impl Laned<2> for Oscillator<f64> {
    type Over<L: Lanes> = Oscillator<L>;

    fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Oscillator<L> {
        Oscillator(L::from_fn(|lane| member(lane).0))
    }
}

impl OutputMap<f64, 2, 1> for Oscillator<f64> {
    type Outputs = f64;
    const OUTPUTS: [&'static str; 1] = ["speed"];
    const OUTPUT_UNITS: &'static [&'static str] = &["1/s"];
    fn output_values(&self, _t: f64, &[_, w]: &[f64; 2]) -> [f64; 1] {
        [w.abs()]
    }
    fn named_outputs(values: &[f64; 1]) -> f64 {
        values[0]
    }
}

const METHOD: Rk4 = Rk4::new(0.03);

fn design(count: u64) -> Design {
    Design::latin_hypercube(count, 5).uniform("k", 0.5, 1.5).uniform("q", 1.4, 3.4).design()
}

fn member(k: f64, q: f64) -> (Oscillator<f64>, [f64; 2]) {
    (Oscillator(k), [q, -1.0])
}

fn motions<'a>(count: u64) -> super::Motions<'a, Oscillator<f64>, 2> {
    Sweep::over(design(count), |point| {
        if point.index() == 17 {
            return Err("no seventeenth".into());
        }
        Ok(member(point.get("k")?, point.get("q")?))
    })
}

fn ends<'a>(count: u64) -> Sweep<'a> {
    motions(count).end_states(METHOD, 0.0..2.5).with_chunk(40).silent()
}

/// A folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("guen-study-sweep-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn below(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// All files of a folder but locks, with their contents.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for below in [folder.to_path_buf(), folder.join("rows")] {
        for entry in std::fs::read_dir(below).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().to_str().unwrap().to_owned();
            if path.is_file() && !name.ends_with(".lock") {
                found.push((name, std::fs::read(path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

fn differing(a: &[(String, Vec<u8>)], b: &[(String, Vec<u8>)]) -> Vec<String> {
    let only = |a: &[(String, Vec<u8>)], b: &[(String, Vec<u8>)]| {
        a.iter().filter(|file| !b.contains(file)).map(|file| file.0.clone()).collect::<Vec<String>>()
    };
    [only(a, b), only(b, a)].concat()
}

/// No files.
const NONE: [String; 0] = [];

/// The rows of a folder of comma-separated values.
fn rows(folder: &Path) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for (name, content) in files(folder) {
        if name.starts_with("rows/") {
            let text = String::from_utf8(content).unwrap();
            all.extend(text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()));
        }
    }
    all
}

#[test]
fn rows_are_the_motions_alone_and_faults_say_why() {
    let folder = Folder::new("rows");
    let summary = ends(101).run_in(&folder.0).unwrap();
    let rows = rows(&folder.0);
    assert_eq!(rows.len(), 101);
    let (mut faults, mut sum) = (0, 0.0);
    for (motion, row) in rows.iter().enumerate() {
        let point = design(101).point(motion as u64).unwrap();
        let text = |x: f64| format!("{x:?}");
        assert_eq!(row[..3], [motion.to_string(), text(point[0]), text(point[1])]);
        if motion == 17 {
            assert_eq!(row[3..], ["", "", "", "no seventeenth"]);
            faults += 1;
            continue;
        }
        let (system, start) = member(point[0], point[1]);
        match Integration::new(&system, 0.0, &start).run(&METHOD, 2.5) {
            Ok(end) => {
                assert_eq!(row[3..], [text(end.state[0]), text(end.state[1]), String::new(), String::new()]);
                sum += end.state[0];
            }
            Err(error) => {
                faults += 1;
                assert_eq!(row[3..6], ["", "", &text(error.time)]);
                assert!(row[6].contains("not finite"), "{}", row[6]);
            }
        }
    }
    assert!(faults > 5 && faults < 90, "{faults}");
    let statistics = summary.statistics();
    assert_eq!((statistics.motions(), statistics.faults()), (101, faults));
    let q = statistics.column("q").unwrap();
    assert_eq!((q.count(), q.unit()), (101 - faults, "rad"));
    assert!((q.mean().unwrap() - sum / q.count() as f64).abs() < 1e-12);
    // The axis that has the name of an entry is told apart, and has its unit.
    let head = std::fs::read_to_string(folder.below("columns.csv")).unwrap();
    assert_eq!(head.lines().nth(3), Some("design_q,rad"));
    assert_eq!(head.lines().nth(5), Some("w,1/s"));
}

#[test]
fn threads_lanes_parts_and_chunks_in_any_order_have_the_same_bits() {
    let folder = Folder::new("bits");
    let whole = ends(333).with_threads(1).run_in(folder.below("whole")).unwrap();
    let expected = files(&folder.below("whole"));
    assert_eq!(whole.digest(), ends(333).run().unwrap().digest());
    for threads in [1, 3] {
        for backend in Backend::ALL {
            for width in [Width::Four, Width::Eight] {
                let sweep = ends(333).with_threads(threads).with_lanes(backend, width);
                assert_eq!(sweep.run().unwrap(), whole, "{threads} {backend:?} {width:?}");
            }
        }
    }
    for parts in [2, 7, 12] {
        let place = folder.below(&format!("of-{parts}"));
        let merged = folder.below(&format!("merged-of-{parts}"));
        for part in (0..parts).rev() {
            // Half of the parts on another machine.
            let place = if part % 2 == 0 { place.clone() } else { place.join("elsewhere") };
            ends(333).part(part, parts).unwrap().run_in(&place).unwrap();
        }
        let summary = ends(333).merge([place.join("elsewhere"), place.clone()], &merged).unwrap();
        assert_eq!(summary, whole);
        assert_eq!(differing(&files(&merged), &expected), NONE, "{parts}");
        // A merged folder is that of a finished run.
        let again = ends(333).part(0, 1).unwrap().run_in(&merged).unwrap();
        assert_eq!((again.found, again.computed), (9, 0));
    }
}

#[test]
fn damage_is_found_and_computed_anew() {
    let folder = Folder::new("damage");
    ends(200).run_in(&folder.0).unwrap();
    let expected = files(&folder.0);
    // A file cut short, one with a changed byte, one that is lost, and one that was not finished.
    let file = |chunk| folder.below(&format!("rows/chunk-{chunk:08}.csv"));
    let cut = std::fs::read(file(0)).unwrap();
    std::fs::write(file(0), &cut[..cut.len() / 2]).unwrap();
    let mut changed = std::fs::read(file(1)).unwrap();
    changed[100] ^= 1;
    std::fs::write(file(1), changed).unwrap();
    std::fs::remove_file(file(3)).unwrap();
    std::fs::write(folder.below("rows/chunk-00000003.unfinished"), "motion").unwrap();
    let merged = ends(200).merge([&folder.0], &folder.0).unwrap_err();
    assert!(
        matches!(&merged, SweepError::Corrupt { path, .. } if path.ends_with("chunk-00000000.csv")),
        "{merged}"
    );
    let report = ends(200).part(0, 1).unwrap().run_in(&folder.0).unwrap();
    assert_eq!((report.found, report.computed, report.rewritten), (5, 3, 3));
    assert_eq!(differing(&files(&folder.0), &expected), NONE);
    // A record that does not fit its digest is no record; the rows come out the same.
    let record = folder.below("part-0-of-1.txt");
    let text = std::fs::read_to_string(&record).unwrap();
    for damaged in [&text[..text.len() - 30], &text.replacen("complete 1", "complete 2", 1), "", "sha256 "] {
        std::fs::write(&record, damaged).unwrap();
        let error = ends(200).merge([&folder.0], &folder.0).unwrap_err();
        assert!(
            matches!(&error, SweepError::Corrupt { path, .. } if path.ends_with("part-0-of-1.txt")),
            "{error}"
        );
        let report = ends(200).part(0, 1).unwrap().run_in(&folder.0).unwrap();
        assert_eq!((report.found, report.computed, report.record_was_damaged), (0, 5, true));
        assert_eq!(differing(&files(&folder.0), &expected), NONE);
    }
}

#[test]
fn a_chunk_with_other_bits_is_not_counted_twice() {
    let folder = Folder::new("bits-differ");
    let count = std::sync::atomic::AtomicU64::new(0);
    let sweep = Sweep::over(design(30), |point| {
        let call = count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        // A closure that does not make the same motion of the same point, once it has been probed and run.
        let drift = if call > 60 && point.index() == 3 { 1e-9 } else { 0.0 };
        Ok(member(point.get("k")? + drift, 2.9))
    })
    .end_states(METHOD, 0.0..0.3)
    .with_chunk(30)
    .silent();
    sweep.part(0, 1).unwrap().run_in(&folder.0).unwrap();
    std::fs::remove_file(folder.below("rows/chunk-00000000.csv")).unwrap();
    let error = sweep.part(0, 1).unwrap().run_in(&folder.0).unwrap_err();
    assert!(matches!(error, SweepError::NotReproducible { first: 0 }), "{error}");
}

#[test]
fn a_folder_of_another_sweep_is_refused() {
    let folder = Folder::new("other");
    ends(60).run_in(&folder.0).unwrap();
    let expected = files(&folder.0);
    let others: Vec<(&str, Sweep<'_>)> = vec![
        ("design", ends(61)),
        ("kept", motions(60).end_states(Rk4::new(0.02), 0.0..2.5).with_chunk(40).silent()),
        ("motions of a chunk", ends(60).with_chunk(20)),
        ("name", ends(60).named("another")),
        ("rows", ends(60).with_rows(Rows::Nothing)),
        ("statistics", ends(60).with_statistics_of(["q"])),
        // Another declaration, or another constant that the design does not name.
        (
            "systems and starts",
            Sweep::over(design(60), |point| Ok(member(point.get("k")? + 1e-12, point.get("q")?)))
                .end_states(METHOD, 0.0..2.5)
                .with_chunk(40)
                .silent(),
        ),
    ];
    for (line, sweep) in others {
        let errors =
            [sweep.run_in(&folder.0).unwrap_err(), sweep.merge([&folder.0], folder.below("x")).unwrap_err()];
        for error in errors {
            let SweepError::OtherSweep { found, expected, .. } = &error else { panic!("{error}") };
            assert!(found.starts_with(line) && expected.starts_with(line) && found != expected, "{error}");
        }
    }
    let error = ends(60).part(0, 2).unwrap().run_in(&folder.0).unwrap_err();
    assert!(matches!(error, SweepError::OtherParts { found: 1, asked: 2, .. }), "{error}");
    assert_eq!(differing(&files(&folder.0), &expected), NONE);
    assert!(matches!(ends(60).part(2, 2), Err(SweepError::Part { part: 2, parts: 2 })));
}

/// A system as the macro generates it of a declaration with this digest.
#[derive(Clone)]
struct Declared<const DIGEST: u64>(Oscillator<f64>);

impl<const DIGEST: u64> System<f64, 2> for Declared<DIGEST> {
    fn rhs(&self, t: f64, state: &[f64; 2]) -> [f64; 2] {
        self.0.rhs(t, state)
    }
}

impl<const DIGEST: u64> Simulate<f64, 2> for Declared<DIGEST> {
    type State = [f64; 2];
    const DECLARATION: u64 = DIGEST;
}

fn declared<'a, const DIGEST: u64>() -> Sweep<'a> {
    Sweep::over(design(60), |point| {
        let (system, start) = member(point.get("k")?, point.get("q")?);
        Ok((Declared::<DIGEST>(system), start))
    })
    .simulations([("q", "rad")], |simulation| simulation.run(0.0..1.0).map(|motion| [motion.end()[0]]))
    .with_chunk(20)
    .silent()
}

#[test]
fn a_folder_of_another_declaration_is_refused_and_stays() {
    let folder = Folder::new("declaration");
    declared::<0x2a>().part(0, 2).unwrap().run_in(&folder.0).unwrap();
    let expected = files(&folder.0);
    let manifest = std::fs::read_to_string(folder.below("sweep.txt")).unwrap();
    assert_eq!(manifest.lines().nth(1), Some("declaration: 000000000000002a"));
    // The rates are the same: only the text of the declaration is another.
    for error in [
        declared::<0x2b>().part(0, 2).unwrap().run_in(&folder.0).unwrap_err(),
        // The name is another, too.
        declared::<0x2b>().named("edited").part(1, 2).unwrap().run_in(&folder.0).unwrap_err(),
        declared::<0x2b>().merge([&folder.0], folder.below("x")).unwrap_err(),
    ] {
        let SweepError::OtherDeclaration { found, expected, .. } = &error else { panic!("{error}") };
        assert_eq!([found.as_str(), expected], ["000000000000002a", "000000000000002b"]);
    }
    assert_eq!(differing(&files(&folder.0), &expected), NONE);
    let report = declared::<0x2a>().part(0, 2).unwrap().run_in(&folder.0).unwrap();
    assert_eq!((report.found, report.computed), (2, 0));
    assert_eq!(ends(60).engine.declaration(), 0);
}

#[test]
fn parts_that_are_missing_or_there_twice_are_told() {
    let folder = Folder::new("missing");
    for part in [0, 2] {
        ends(200).part(part, 3).unwrap().run_in(folder.below("a")).unwrap();
    }
    let error = ends(200).merge([folder.below("a")], folder.below("b")).unwrap_err();
    assert!(matches!(error, SweepError::Unfinished { first: 40, missing: 80 }), "{error}");
    assert!(!folder.below("b").exists());
    ends(200).part(2, 3).unwrap().run_in(folder.below("c")).unwrap();
    let error = ends(200).merge(["a", "c"].map(|name| folder.below(name)), folder.below("b")).unwrap_err();
    assert!(matches!(error, SweepError::Overlap { first: 80 }), "{error}");
    let error = ends(200).merge([folder.below("nowhere")], folder.below("b")).unwrap_err();
    assert!(matches!(error, SweepError::Io { .. }), "{error}");
}

#[test]
fn two_runs_of_one_part_into_one_folder_are_refused() {
    let folder = Folder::new("busy");
    let (path, error) = (folder.0.clone(), std::sync::Mutex::new(None));
    // The closure of the first run begins a second one.
    let sweep = Sweep::over(design(40), |point| {
        if point.index() == 39 {
            let second = ends(40).part(0, 1).and_then(|part| part.run_in(&path));
            error.lock().unwrap().get_or_insert(second.map(|_| ()));
        }
        if point.index() == 17 {
            Err("no seventeenth".into())
        } else {
            Ok(member(point.get("k")?, point.get("q")?))
        }
    })
    .end_states(METHOD, 0.0..2.5)
    .with_chunk(40)
    .silent();
    sweep.run_in(&folder.0).unwrap();
    let found = error.lock().unwrap().take().unwrap();
    assert!(matches!(found, Err(SweepError::Busy { part: 0, parts: 1, .. })), "{found:?}");
    // When the first has ended, there is nothing left to do.
    assert_eq!(ends(40).part(0, 1).unwrap().run_in(&folder.0).unwrap().computed, 0);
    let unlocked = ends(40).without_locks().part(0, 1).unwrap().run_in(folder.below("unlocked")).unwrap();
    assert_eq!(unlocked.computed, 1);
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = Folder::new("unwritable");
    // Not even the administrator makes a folder of a file.
    std::fs::write(folder.below("file"), "kept").unwrap();
    let error = ends(40).run_in(folder.below("file")).unwrap_err();
    assert!(
        matches!(&error, SweepError::Io { path, .. } if path.starts_with(folder.below("file"))),
        "{error}"
    );
    // A row file that cannot be written ends the run; the other chunks are not lost.
    ends(200).part(1, 2).unwrap().run_in(folder.below("half")).unwrap();
    let blocked = folder.below("half/rows/chunk-00000004.csv");
    std::fs::create_dir_all(&blocked).unwrap();
    let error = ends(200).with_threads(1).part(0, 2).unwrap().run_in(folder.below("half")).unwrap_err();
    assert!(matches!(&error, SweepError::Io { path, .. } if *path == blocked), "{error}");
    std::fs::remove_dir(blocked).unwrap();
    let report = ends(200).part(0, 2).unwrap().run_in(folder.below("half")).unwrap();
    assert_eq!((report.found, report.computed), (2, 1));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_and_loses_nothing() {
    let folder = Folder::new("full");
    ends(200).run_in(folder.below("whole")).unwrap();
    let place = folder.below("full");
    std::fs::create_dir_all(place.join("rows")).unwrap();
    // A device that is always full stands where the rows of a chunk are to be written first.
    std::os::unix::fs::symlink("/dev/full", place.join("rows/chunk-00000002.unfinished")).unwrap();
    let error = ends(200).with_threads(1).run_in(&place).unwrap_err();
    let SweepError::Io { path, source } = &error else { panic!("{error}") };
    assert!(
        path.ends_with("chunk-00000002.csv") && source.kind() == std::io::ErrorKind::StorageFull,
        "{error}"
    );
    let report = ends(200).part(0, 1).unwrap().run_in(&place).unwrap();
    assert_eq!((report.found, report.computed), (2, 3));
    ends(200).run_in(&place).unwrap();
    assert_eq!(differing(&files(&place), &files(&folder.below("whole"))), NONE);
}

#[test]
fn what_is_kept_is_that_of_the_methods() {
    let folder = Folder::new("kept");
    let times = [0.3, 0.9, 0.6];
    let point = |motion: u64| {
        let point = design(24).point(motion).unwrap();
        member(point[0], point[1])
    };
    let sampled = |motion, method: &Rk4| {
        let (system, start) = point(motion);
        let mut states = Vec::new();
        let end = method.sample(&system, 0.0, &start, &times, |_, _, state| states.push(*state));
        (states, end)
    };
    let text = |x: f64| format!("{x:?}");
    // Samples: rows until a fault, and then the fault.
    let samples = motions(24).samples(METHOD, 0.0, times).silent();
    let summary = samples.run_in(folder.below("samples")).unwrap();
    let all = rows(&folder.below("samples"));
    let mut at = all.iter();
    let mut last = Vec::new();
    for motion in (0..24).filter(|motion| *motion != 17) {
        let (states, end) = sampled(motion, &METHOD);
        for (state, t) in states.iter().zip(times) {
            let row = at.find(|row| row[0] != "17").unwrap();
            assert_eq!(row[3..6], [text(t), text(state[0]), text(state[1])]);
        }
        if end.is_err() {
            assert!(at.find(|row| row[0] != "17").unwrap()[7].contains("not finite"));
        }
        last.extend(states.get(2).map(|state| state[1]));
    }
    let third = summary.statistics().at(2, "w").unwrap();
    assert_eq!(third.count(), last.len() as u64);
    assert!((third.mean().unwrap() - last.iter().sum::<f64>() / last.len() as f64).abs() < 1e-14);
    // Extrema.
    motions(24).extrema(METHOD, 0.0, times).silent().run_in(folder.below("extrema")).unwrap();
    for row in rows(&folder.below("extrema")).iter().filter(|row| row[8].is_empty()) {
        let (states, _) = sampled(row[0].parse().unwrap(), &METHOD);
        let of = |entry: usize, pick: fn(f64, f64) -> f64| {
            text(states.iter().map(|state| state[entry]).reduce(pick).unwrap())
        };
        assert_eq!(row[3..7], [of(0, f64::min), of(1, f64::min), of(0, f64::max), of(1, f64::max)]);
    }
    // Ends with estimates of their errors.
    let finer = Rk4::new(0.015);
    let errors = motions(24).end_states_with_errors(METHOD, finer, 0.0..0.6).silent();
    errors.run_in(folder.below("errors")).unwrap();
    for row in rows(&folder.below("errors")).iter().filter(|row| row[8].is_empty()) {
        let (system, start) = point(row[0].parse().unwrap());
        let end = |method: &Rk4| Integration::new(&system, 0.0, &start).run(method, 0.6).unwrap().state;
        let (coarse, fine) = (end(&METHOD), end(&finer));
        let error = |k: usize| text((coarse[k] - fine[k]).abs());
        assert_eq!(row[3..7], [text(coarse[0]), text(coarse[1]), error(0), error(1)]);
    }
    // Outputs.
    motions(24).end_outputs(METHOD, 0.0..0.6).silent().run_in(folder.below("outputs")).unwrap();
    for row in rows(&folder.below("outputs")).iter().filter(|row| row[7].is_empty()) {
        assert_eq!(row[5], row[4].trim_start_matches('-'));
    }
}

#[test]
fn simulations_keep_what_a_closure_says() {
    let folder = Folder::new("simulations");
    let columns = [("t", "s"), ("q", "rad")];
    let events = motions(20).simulation_rows(columns, |simulation| {
        let turn = Trigger::new(|_: f64, &[_, w]: &[f64; 2]| w);
        simulation.events([turn]).run(0.0..2.5).map(|motion| {
            motion.events().iter().map(|event| [event.time, event.state[0]]).collect::<Vec<[f64; 2]>>()
        })
    });
    let summary = events.silent().run_in(&folder.0).unwrap();
    let rows = rows(&folder.0);
    let turned = rows.iter().filter(|row| row[6].is_empty()).count();
    assert_eq!(summary.statistics().column("t").unwrap().count(), turned as u64);
    assert!(turned > 3 && rows.iter().any(|row| row[6].contains("simulation stopped at t = ")), "{rows:?}");
    // The times of events that do not happen are no numbers, and counted.
    let first = motions(20).simulations([("t", "s")], |simulation| {
        simulation.run(0.0..0.1).map(|motion| [motion.events().first().map_or(f64::NAN, |event| event.time)])
    });
    let summary = first.silent().run().unwrap();
    let t = summary.statistics().column("t").unwrap();
    assert_eq!((t.count(), t.mean()), (0, None));
    assert_eq!(t.not_finite() + summary.statistics().faults(), 20);
}

#[test]
fn names_that_are_not_there_are_refused_before_anything_is_computed() {
    let folder = Folder::new("names");
    let typo = Sweep::over(design(9), |point| Ok(member(point.get("kk")?, 2.0))).end_states(METHOD, 0.0..1.0);
    let error = typo.run_in(folder.below("typo")).unwrap_err();
    assert_eq!(error.to_string(), "the design has no axis `kk`, but k, q");
    let error = Sweep::of_starts(design(9), Oscillator(1.0), [2.0, 0.0]).end_states(METHOD, 0.0..1.0).run();
    let error = error.unwrap_err();
    assert_eq!(error.to_string(), "the state has no entry `k` for the axis of this name, but q, w");
    let error = ends(9).with_statistics_of(["v"]).run().unwrap_err();
    assert_eq!(error.to_string(), "the rows have no column `v`, but k, design_q, q, w");
    let twice = motions(9).simulations([("x", ""), ("fault", "")], |_| Ok::<_, SweepError>([0.0; 2]));
    assert_eq!(twice.run().unwrap_err().to_string(), "two columns of the rows are called `fault`");
    let error = ends(9).with_histogram("q", 1.0, 1.0, 4).run().unwrap_err();
    assert!(matches!(error, SweepError::Histogram { .. }), "{error}");
    let error =
        Sweep::over(Design::random(0, 1), |_| Ok(member(1.0, 2.0))).end_states(METHOD, 0.0..1.0).run();
    assert!(matches!(error, Err(SweepError::Design { axis: None, fault: DesignFault::NoPoints })));
    assert!(!folder.below("typo").exists());
}

#[test]
fn entries_of_a_start_are_axes() {
    let starts = Design::grid().linear("w", -2.0, 0.0, 5);
    let sweep = Sweep::of_starts(starts, Oscillator(1.0), [2.9, 0.0]).end_states(METHOD, 0.0..0.6).silent();
    let summary =
        sweep.with_statistics_of(["design_w", "w"]).with_histogram("w", -1.0, 3.0, 8).run().unwrap();
    let correlation = summary.statistics().correlation("design_w", "w").unwrap();
    assert!(correlation > 0.9 && correlation <= 1.0, "{correlation}");
    assert_eq!(summary.statistics().names().collect::<Vec<_>>(), ["design_w", "w"]);
    let histogram = summary.statistics().column("w").unwrap().histogram();
    assert_eq!(histogram.iter().map(|bin| bin.2).sum::<u64>(), 5);
}
