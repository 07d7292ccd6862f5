//! Data that nobody wants to have, through everything that writes a file: nothing is lost, nothing is executed, no panic.

use std::fs;
use std::path::{Path, PathBuf};

use crate::{Plot, Recording, StudyError};

/// Names with markup, formulas, other scripts and directions, and characters that no document may have.
const NAMES: [&str; 8] = [
    "</title><script>alert(1)</script>",
    "<img src=x onerror=\"alert(1)\">",
    "]]><!-- & ' \" \\",
    "=1+1",
    "маятник, 振り子",
    "עגלה (1)",
    "\u{202e}reversed",
    "\u{0}\u{1b}[31m\u{7f}\u{fffe}\n\t\u{2028}",
];

fn recorded(samples: &[(f64, f64)]) -> Recording<8> {
    let mut recording = Recording::new(&NAMES);
    samples.iter().for_each(|(t, x)| recording.record(*t, &[*x; 8]));
    recording
}

/// All three forms of a recording, written below a folder: table, picture, page.
fn written(recording: &Recording<8>, folder: &Path) -> Vec<(PathBuf, Result<(), StudyError>)> {
    let [csv, svg, html] = ["a.csv", "a.svg", "a.html"].map(|name| folder.join(name));
    let plot = (0..8).fold(Plot::new(NAMES[0]), |plot, i| plot.line(NAMES[i], recording.curve(i)));
    let files = [
        (csv.clone(), recording.save_csv(&csv)),
        (svg.clone(), plot.axes(NAMES[1], NAMES[7]).size(900, 700).save(&svg)),
    ];
    #[cfg(feature = "viewer")]
    let pages = [(html.clone(), crate::Viewer::new(NAMES[0], recording).states(&[]).write(&html))];
    #[cfg(not(feature = "viewer"))]
    let pages = {
        let _ = html;
        []
    };
    files.into_iter().chain(pages).collect()
}

/// A folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("guen-study-bad-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = Folder::new("folder");
    // Not even the administrator makes a folder of a file.
    let file = folder.0.join("file");
    fs::write(&file, "kept").unwrap();
    for below in [file.clone(), file.join("deep/er")] {
        for (path, done) in written(&recorded(&[(0.0, 0.0), (1.0, 2.0)]), &below) {
            let Err(error) = done else { panic!("{} is written", path.display()) };
            assert!(matches!(&error, StudyError::Io { path: at, .. } if path.starts_with(at)), "{error:?}");
            assert!(error.to_string().starts_with(&format!("cannot write `{}", file.display())), "{error}");
        }
    }
    assert_eq!(folder.text("file"), "kept");
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1, "something is left behind");
}

#[test]
fn names_are_texts_in_every_file() {
    let folder = Folder::new("names");
    for (path, done) in written(&recorded(&[(0.0, 0.0), (1.0, 2.0)]), &folder.0) {
        done.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    let picture = folder.text("a.svg");
    // Of a picture every element is one that a plot has, and every character one that XML allows.
    for element in picture.split('<').skip(1) {
        let name = element.trim_start_matches('/').split([' ', '>', '/', '\n']).next().unwrap();
        assert!(
            ["svg", "title", "desc", "style", "rect", "text", "polyline", "polygon", "circle", "line"]
                .contains(&name),
            "<{name} in {element}"
        );
    }
    let is_forbidden = |c: char| matches!(c, '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}');
    assert!(!picture.contains(is_forbidden), "{:?}", picture.find(is_forbidden));
    for name in &NAMES[4..7] {
        assert!(picture.contains(name), "{name}");
    }
    // A table has one line of names, whatever is in them.
    let table = folder.text("a.csv");
    assert!(table.contains(",\"'=1+1\",\"маятник, 振り子\",עגלה (1),"), "{table}");
    assert!(table.ends_with("\n0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0\n1.0,2.0,2.0,2.0,2.0,2.0,2.0,2.0,2.0\n"));
}

#[test]
fn what_is_not_finite_is_kept_in_tables_a_gap_in_pictures_and_told_by_pages() {
    let folder = Folder::new("finite");
    let samples = [(0.0, 1.0), (1.0, f64::NAN), (2.0, f64::INFINITY), (3.0, -1.0), (4.0, 2.0)];
    for (path, done) in written(&recorded(&samples), &folder.0) {
        match path.extension().and_then(|text| text.to_str()) {
            Some("html") => {
                assert!(matches!(&done, Err(StudyError::NotDrawable { time: 1.0, .. })), "{done:?}");
                assert!(!path.exists());
            }
            _ => done.unwrap_or_else(|error| panic!("{}: {error}", path.display())),
        }
    }
    let table = folder.text("a.csv");
    assert!(table.contains("\n1.0,NaN,NaN,") && table.contains("\n2.0,inf,inf,"), "{table}");
    let picture = folder.text("a.svg");
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
}

#[test]
fn samples_out_of_order_and_few_of_them() {
    let folder = Folder::new("order");
    let page_fails = |samples: &[(f64, f64)]| {
        let recording = recorded(samples);
        for (path, done) in written(&recording, &folder.0) {
            match path.extension().and_then(|text| text.to_str()) {
                Some("html") => return done.err(),
                // There is nothing in a picture without a point.
                Some("svg") if samples.is_empty() => {
                    assert!(matches!(&done, Err(StudyError::NothingToDraw { .. })), "{done:?}");
                }
                _ => done.unwrap_or_else(|error| panic!("{}: {error}", path.display())),
            }
            // Nothing is lost, and nothing put into another order.
            let lines =
                folder.text("a.csv").lines().rev().take(samples.len()).map(str::to_owned).collect::<Vec<_>>();
            let begins =
                lines.iter().rev().zip(samples).all(|(line, (t, _))| line.starts_with(&format!("{t:?},")));
            assert!(begins, "{lines:?}");
        }
        None
    };
    let with_viewer = cfg!(feature = "viewer");
    let disordered = page_fails(&[(0.0, 1.0), (2.0, 1.0), (1.0, 3.0), (3.0, 1.0)]);
    assert!(
        !with_viewer || matches!(disordered, Some(StudyError::Times { time: 1.0, .. })),
        "{disordered:?}"
    );
    let twice = page_fails(&[(0.0, 1.0), (1.0, 1.0), (1.0, 3.0)]);
    assert!(!with_viewer || matches!(twice, Some(StudyError::Times { time: 1.0, .. })), "{twice:?}");
    let empty = page_fails(&[]);
    assert!(!with_viewer || matches!(empty, Some(StudyError::NothingToDraw { .. })), "{empty:?}");
    let one = page_fails(&[(1.0, 1.0)]);
    assert!(one.is_none(), "{one:?}");
}

#[test]
fn a_thousand_curves_are_refused_by_their_size_and_drawn_where_there_is_room() {
    let curves =
        (0..1000).fold(Plot::new("many"), |plot, k| plot.line("", [(0.0, f64::from(k)), (1.0, 0.0)]));
    assert!(curves.to_svg().is_ok_and(|text| text.matches("<polyline").count() >= 1000));
    let named = (0..1000).fold(Plot::new("many"), |plot, k| plot.line(format!("{k}"), [(0.0, f64::from(k))]));
    assert!(matches!(named.to_svg(), Err(StudyError::Size { .. })));
    assert!(named.size(4000, 4000).to_svg().is_ok());
}

#[test]
fn logarithmic_plots_of_the_least_and_the_largest_numbers_come_to_an_end() {
    for x in [5e-324, 1e-300, 1e-10, 1.0, 1e290, 1e300] {
        for y in [5e-324, 1.0, 1e299] {
            for equal in [false, true] {
                let plot =
                    Plot::new("far").logarithmic(true).equal_scale(equal).line("a", [(x, y), (x, 2.0 * y)]);
                let text = plot.to_svg().unwrap_or_else(|error| panic!("{x:e} {y:e}: {error}"));
                assert!(!text.contains("NaN") && !text.contains("inf"), "{x:e} {y:e}");
            }
        }
    }
}
