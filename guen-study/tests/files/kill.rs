//! A program that is killed while it writes leaves the old file or the new one, whole.
//!
//! The program is this test's own executable, started again as `writes_until_it_is_killed`.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use std::{env, fs, thread};

use guen_study::{Plot, Recording, replace_file};

use crate::{Folder, Random};

/// Kills in a usual run; `GUEN_KILLS` sets another number.
const KILLS: u64 = 40;
/// The longest time from the first file to the kill, in microseconds: some rounds of all writers.
const LONGEST: u64 = 60_000;
/// The variable by which the program that is to be killed learns where to write.
const FOLDER: &str = "GUEN_TEST_FOLDER";
/// The samples of the two versions of every file.
const VERSIONS: [usize; 2] = [3_000, 2_000];

/// Writes a file by every writer that there is.
struct Writers {
    recording: Recording<2>,
    #[cfg(all(feature = "study", feature = "serde"))]
    report: guen_study::StudyReport,
}

impl Writers {
    fn new(samples: usize) -> Self {
        let mut recording = Recording::new(&["x", "v"]);
        for k in 0..samples {
            let t = k as f64 / 64.0;
            recording.record(t, &[t.sin(), t.cos()]);
        }
        Self {
            recording,
            #[cfg(all(feature = "study", feature = "serde"))]
            report: report(samples),
        }
    }

    fn write(&self, folder: &Path) {
        let recording = &self.recording;
        recording.save_csv(folder.join("run.csv")).unwrap();
        Plot::new("x").line("x", recording.curve(0)).save(folder.join("run.svg")).unwrap();
        replace_file(folder.join("run.bin"), |out| {
            recording.times().iter().try_for_each(|t| out.write_all(&t.to_le_bytes()))
        })
        .unwrap();
        #[cfg(feature = "serde")]
        recording.save_json(folder.join("run.json")).unwrap();
        #[cfg(feature = "viewer")]
        guen_study::Viewer::new("x", recording)
            .curve("x", |_, x| x[0])
            .write(folder.join("run.html"))
            .unwrap();
        #[cfg(all(feature = "study", feature = "serde"))]
        {
            self.report.save_csv(folder.join("rows.csv")).unwrap();
            self.report.save_picture(folder.join("rows.svg")).unwrap();
            self.report.save_json(folder.join("rows.json")).unwrap();
        }
    }
}

/// A report of many rows, none of which was measured on this machine.
#[cfg(all(feature = "study", feature = "serde"))]
fn report(size: usize) -> guen_study::StudyReport {
    let row = |k: usize| {
        let step = 1.0 / (k + 1) as f64;
        serde_json::json!({
            "method": "RK4", "real": "f64", "form": "declared", "knob": "Step", "setting": step,
            "error": step.powi(4), "limited": false, "nearby": null, "evaluations": 4.0 / step,
            "jacobians": 0.0, "failure": null, "code": "",
            "cost": { "median": 4.0 / step, "low": 4.0 / step, "high": 4.0 / step, "repetitions": 1 },
        })
    };
    let rows: Vec<_> = (0..size / 10).map(row).collect();
    serde_json::from_value(serde_json::json!({
        "title": "x", "measure": "the end state", "span": [0.0, 1.0], "starts": 1, "unit": "Evaluations",
        "reference": null, "rows": rows, "ending": "Complete", "probes": 0, "noise": 0.0, "seconds": 0.0,
        "conditions": "",
    }))
    .unwrap()
}

/// The program that is to be killed; as a test of its own it does nothing.
#[test]
fn writes_until_it_is_killed() {
    let Some(folder) = env::var_os(FOLDER) else { return };
    let writers = VERSIONS.map(Writers::new);
    println!("ready");
    loop {
        for writer in &writers {
            writer.write(Path::new(&folder));
        }
    }
}

/// The files of a folder by their names; those that are temporary are left out and removed.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if name.starts_with(".guen-") {
            fs::remove_file(path).unwrap();
        } else {
            found.insert(name, fs::read(path).unwrap());
        }
    }
    found
}

#[test]
fn a_kill_at_any_instant_leaves_whole_files() {
    let kills = env::var("GUEN_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(KILLS);
    let folder = Folder::new("kill");
    let versions = VERSIONS.map(|samples| {
        let place = folder.0.join(samples.to_string());
        fs::create_dir(&place).unwrap();
        Writers::new(samples).write(&place);
        files(&place)
    });
    let place = folder.0.join("killed");
    fs::create_dir(&place).unwrap();
    let mut random = Random(19);
    let (mut torn, mut checked) = (Vec::new(), 0);
    for kill in 0..kills {
        let mut program = Command::new(env::current_exe().unwrap())
            .args(["--exact", "kill::writes_until_it_is_killed", "--nocapture"])
            .env(FOLDER, &place)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(program.stdout.take().unwrap()).lines();
        assert!(lines.any(|line| line.unwrap().ends_with("ready")));
        thread::sleep(Duration::from_micros(random.below(LONGEST)));
        program.kill().unwrap();
        program.wait().unwrap();
        for (name, content) in files(&place) {
            checked += 1;
            if !versions.iter().any(|version| version[&name] == content) {
                torn.push(format!("{name} after kill {kill}: {} bytes", content.len()));
            }
        }
    }
    println!("{kills} kills, {checked} files looked at, {} torn", torn.len());
    assert!(torn.is_empty(), "{torn:#?}");
    assert!(checked > kills, "nothing was written before the kills");
}
