//! Pages whose data are hard to show, for `tests/browser/data.py`: long runs, far places, short and long spans, odd names.
//!
//! ```text
//! cargo run --release -p guen-measure --bin pages -- FOLDER                   # those that take seconds
//! cargo run --release -p guen-measure --bin pages -- FOLDER 10000000 50       # one of so many samples and bodies
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use guen_study::{Pose, Recording, Shape, StudyError, Viewer};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match &arguments[..] {
        [folder] => hard(Path::new(folder)).map_err(Box::from),
        [folder, samples, bodies] => large(&PathBuf::from(folder).join("large.html"), samples, bodies),
        _ => {
            eprintln!("usage: pages FOLDER [SAMPLES BODIES]");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// A recording of the time alone: everything else is computed from it.
fn clock(samples: u32, span: f64, start: f64) -> Recording<1> {
    let mut recording = Recording::new(&["t"]);
    for k in 0..samples {
        let t = start + span * f64::from(k) / f64::from(samples - 1);
        recording.record(t, &[t]);
    }
    recording
}

fn hard(folder: &Path) -> Result<(), StudyError> {
    let ball = || [Shape::sphere(0.3)];

    // A circle of 5 m on the surface of the Earth, whose centre is the origin.
    let recording = clock(600, 10.0, 0.0);
    let around = |t: f64| [6.4e6 + 5.0 * t.cos(), 5.0 * t.sin(), 3.0];
    Viewer::new("Far away", &recording)
        .body("satellite", ball(), |t, _| Pose::at(around(t)))
        .path("way", |t, _| around(t))
        .panel("x in m")
        .curve("x", |t, _| around(t)[0])
        .write(folder.join("far.html"))?;

    for (name, span) in [("short", 1e-5), ("long", 1e5)] {
        let recording = clock(1000, span, 0.0);
        let phase = |t: f64| 20.0 * t / span;
        Viewer::new(format!("A {name} span"), &recording)
            .body("bead", ball(), |t, _| Pose::at([phase(t).cos(), phase(t).sin(), 0.5]))
            .panel("x in m")
            .curve("x", |t, _| phase(t).cos())
            .write(folder.join(format!("{name}.html")))?;
    }

    // A million samples; in them one pulse of a single sample. Then the same, complete.
    let million = clock(1_000_000, 100.0, 0.0);
    let pulse = million.times()[654_321];
    for (name, viewer) in
        [("million", Viewer::new("A million", &million)), ("complete", Viewer::complete("All", &million))]
    {
        let wave = |t: f64| (3.0 * t).sin() + if t == pulse { 5.0 } else { 0.0 };
        viewer
            .body("wheel", [Shape::disc(0.5, 0.2).about([0.0, 1.0, 0.0])], |t, _| {
                Pose::at([0.1 * t, 0.0, 0.5]).turned([0.0, 1.0, 0.0], 40.0 * t)
            })
            .path("way", |t, _| [0.1 * t, 0.3 * (5.0 * t).sin(), 0.0])
            .panel("waves")
            .curve("slow", |t, _| wave(t))
            .curve("fast", |t, _| (3e4 * t).sin())
            .write(folder.join(format!("{name}.html")))?;
    }

    let recording = clock(100, 5.0, 0.0);
    let names = [
        "</script><script>window.broken = 1</script>",
        "<img src=x onerror=\"window.broken = 1\">",
        "--><svg/onload=window.broken=1>",
        "&lt;b&gt; & ' \" \\ ` ${window.broken = 1}",
        "маятник Фуко",
        "振り子",
        "עגלה (1)",
        "\u{202e}reversed",
        "مذبذب 2",
        "\u{1f680}\u{0}\n\t\u{2028}",
        "",
    ];
    let place = |k: usize, t: f64| [0.6 * k as f64, 0.4 * (t + k as f64).sin(), 0.3];
    names
        .iter()
        .enumerate()
        .fold(Viewer::new(names[0], &recording).time_unit("<b>s"), |page, (k, name)| {
            page.body(*name, ball(), move |t, _| Pose::at(place(k, t)))
                .path(*name, move |t, _| place(k, t))
                .panel(*name)
                .curve(*name, move |t, _| place(k, t)[1])
        })
        .write(folder.join("names.html"))?;

    // Two runs with one clock: the other one is slower, begins later and ends before.
    let own = clock(601, 10.0, 0.0);
    let mut slower = Recording::new(&["t", "angle"]);
    (0..=360).map(|k| 1.0 + f64::from(k) / 60.0).for_each(|t| slower.record(t, &[t, 0.9 * t]));
    let around = |angle: f64| [2.0 * angle.cos(), 2.0 * angle.sin(), 0.3];
    for (name, is_ghost) in [("ghost", true), ("beside", false)] {
        let guest = Viewer::new("slower", &slower)
            .body("ball", ball(), |_, s| Pose::at(around(s[1])).turned([0.0, 0.0, 1.0], s[1]))
            .path("way", |_, s| around(s[1]))
            .arrow("velocity", 0.02, |_, s| [around(s[1]), [-1.8 * s[1].sin(), 1.8 * s[1].cos(), 0.0]])
            .panel("place in m")
            .curve("x", |_, s| around(s[1])[0])
            .panel("angle in rad")
            .curve("angle", |_, s| s[1]);
        let page = Viewer::new("Two runs", &own)
            .called("quick")
            .body("ball", ball(), |t, _| Pose::at(around(t)).turned([0.0, 0.0, 1.0], t))
            .path("way", |t, _| around(t))
            .arrow("velocity", 0.02, |t, _| [around(t), [-2.0 * t.sin(), 2.0 * t.cos(), 0.0]])
            .panel("place in m")
            .curve("x", |t, _| around(t)[0])
            .curve("y", |t, _| around(t)[1]);
        let page = if is_ghost { page.ghost(guest) } else { page.beside(guest) };
        page.write(folder.join(format!("{name}.html")))?;
    }

    // One sample: a picture.
    let mut single = Recording::new(&["t"]);
    single.record(2.5, &[2.5]);
    Viewer::new("One sample", &single)
        .body("ball", ball(), |_, _| Pose::at([1.0, 2.0, 0.3]))
        .path("way", |_, _| [1.0, 2.0, 0.0])
        .rod("rod", 0.05, |_, _| [[0.0; 3], [1.0, 2.0, 0.3]])
        .curve("height in m", |_, _| 0.3)
        .write(folder.join("single.html"))?;

    let recording = clock(500, 10.0, 0.0);
    (0..1000_u32)
        .fold(Viewer::new("A thousand bodies", &recording), |page, k| {
            let [x, y] = [f64::from(k % 40), f64::from(k / 40)];
            page.body(format!("body {k}"), ball(), move |t, _| Pose::at([x, y, 1.0 + (t + x * y).sin()]))
        })
        .write(folder.join("thousand.html"))?;
    Ok(())
}

/// Fifty bodies that swing, turn and knock, or another number.
fn large(path: &Path, samples: &str, bodies: &str) -> Result<(), Box<dyn Error>> {
    let (samples, bodies): (u32, u32) = (samples.parse()?, bodies.parse()?);
    let begin = Instant::now();
    let recording = clock(samples, 1000.0, 0.0);
    let mut page = Viewer::new("A large run", &recording).panel("heights in m");
    let knocks = |k: f64, t: f64| (2.0 * t + k).sin().abs() + 0.05 * (31.0 * t + k * k).sin();
    for k in 0..bodies {
        let k = f64::from(k);
        let place =
            move |t: f64| [(k % 10.0) * 2.0 + (0.3 * t).sin(), (k / 10.0).floor() * 2.0, 0.5 + knocks(k, t)];
        page = page
            .body(format!("body {k}"), [Shape::cuboid([0.6, 0.4, 0.3])], |t, _| {
                Pose::at(place(t)).turned([0.0, 1.0, 0.3], (1.0 + 0.1 * k) * t)
            })
            .curve(format!("body {k}"), |t, _| place(t)[2]);
    }
    println!("described in {:.1} s", begin.elapsed().as_secs_f64());
    page.write(path)?;
    println!("written in {:.1} s: {} bytes", begin.elapsed().as_secs_f64(), std::fs::metadata(path)?.len());
    Ok(())
}
