use super::*;

fn recorded(count: u32) -> Recording<2> {
    let mut recording = Recording::new(&["x", "v"]);
    for k in 0..count {
        let t = 0.125 * f64::from(k);
        recording.record(t, &[t.sin(), t.cos()]);
    }
    recording
}

/// The value of a key of the page's data, up to the closing quote: samples or a text.
fn value<'p>(page: &'p str, key: &str) -> Vec<&'p str> {
    let data = page.split_once("id=\"motion\">").unwrap().1.split_once("</script>").unwrap().0;
    data.split(&format!("\"{key}\":\"")).skip(1).map(|rest| rest.split_once('"').unwrap().0).collect()
}

/// Decodes samples as the page's program does.
fn decoded(text: &str) -> Vec<f32> {
    let letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bits: Vec<u32> =
        text.chars().filter(|c| *c != '=').map(|c| letters.find(c).unwrap() as u32).collect();
    let bytes: Vec<u8> = bits
        .chunks(4)
        .flat_map(|four| {
            let word = four.iter().enumerate().fold(0, |word, (i, six)| word | six << (18 - 6 * i));
            word.to_be_bytes()[1..four.len()].to_vec()
        })
        .collect();
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
}

#[test]
fn numbers_come_back_as_they_went() {
    let recording = recorded(50);
    let page = Viewer::new("t", &recording)
        .body("b", [Shape::sphere(0.1)], |t, s| Pose::at([s[0], s[1], t]).turned([0.0, 0.0, 2.0], t))
        .path("p", |t, s| [t, s[1], -s[0]])
        .rod("r", 0.1, |t, s| [[t; 3], [s[0]; 3]])
        .arrow("a", 0.1, |_, s| [[s[0]; 3], [1.0; 3]])
        .curve("c", |_, s| s[0] * 1e-12)
        .to_html()
        .unwrap();
    let samples = |key: &str, which: usize| decoded(value(&page, key)[which]);
    let expected: Vec<f32> = recording.times().iter().map(|t| *t as f32).collect();
    assert_eq!(samples("times", 0), expected);
    let poses = samples("poses", 0);
    assert_eq!(poses.len(), 7 * 50);
    for (k, (t, [x, v])) in recording.iter().enumerate() {
        let turn = [0.0, 0.0, (t / 2.0).sin(), (t / 2.0).cos()];
        let pose = [*x, *v, t].into_iter().chain(turn);
        assert!(pose.zip(&poses[7 * k..]).all(|(a, b)| (a as f32 - b).abs() <= 1e-7), "at {t}");
    }
    assert_eq!(samples("points", 0)[3..6], [0.125, (0.125_f64).cos() as f32, -(0.125_f64).sin() as f32]);
    assert_eq!(samples("ends", 0)[6..9], [0.125; 3]);
    // An arrow ends where its vector leads from its foot.
    assert_eq!(samples("ends", 1)[3..6], [1.0; 3]);
    assert_eq!(samples("values", 0)[1], ((0.125_f64).sin() * 1e-12) as f32);
}

#[test]
fn names_stay_texts() {
    let evil = "</script><script>alert(\"1\")</script>&<!--'";
    let page = Viewer::new(evil, &recorded(3))
        .body(evil, [Shape::sphere(1.0)], |_, _| Pose::at([0.0; 3]))
        .path(evil, |_, _| [0.0; 3])
        .panel(evil)
        .curve(evil, |_, s| s[0])
        .to_html()
        .unwrap();
    assert!(!page.contains("alert(\"1\")") && !page.contains("<script>alert"));
    // The data, the library, the program, and nothing else.
    assert_eq!((page.matches("<script").count(), page.matches("</script").count()), (3, 3));
    assert!(page.contains("<title>&lt;/script&gt;"));
    assert_eq!(value(&page, "name")[0], r"\u003c/script\u003e\u003cscript\u003ealert(\");
}

#[test]
fn nothing_is_loaded_from_anywhere() {
    let page = Viewer::new("t", &recorded(3)).curve("c", |_, s| s[0]).to_html().unwrap();
    for pattern in ["src=\"", "src='", "@import", "url(http", "href=\"http", "import("] {
        assert!(!page.contains(pattern), "{pattern}");
    }
    assert!(page.contains("default-src 'none'"));
}

#[test]
fn what_has_no_place_is_refused_with_its_name_and_time() {
    let recording = recorded(10);
    let from_a_quarter = |t: f64| if t > 0.2 { f64::NAN } else { t };
    let refused = |viewer: Viewer<'_, 2>, expected: &str, at: f64| match viewer.to_html() {
        Err(StudyError::NotDrawable { title, what, time }) => {
            assert_eq!((title.as_str(), what.as_str(), time), ("v", expected, at));
        }
        other => panic!("{:?}", other.map(|page| page.len())),
    };
    let new = || Viewer::new("v", &recording);
    let ball = || [Shape::sphere(1.0)];
    refused(new().body("b", ball(), |t, _| Pose::at([from_a_quarter(t), 0.0, 0.0])), "b", 0.25);
    refused(new().body("b", ball(), |_, _| Pose::oriented([0.0; 3], &[[0.0; 3]; 3])), "b", 0.0);
    refused(new().path("p", |t, _| [0.0, from_a_quarter(t), 0.0]), "p", 0.25);
    refused(new().rod("r", 0.1, |t, _| [[0.0; 3], [from_a_quarter(t); 3]]), "r", 0.25);
    refused(new().curve("c", |t, _| 1.0 / (t - 0.5)), "c", 0.5);
    refused(new().curve("c", |t, _| 1e30 * t), "c", 0.125);
    refused(new().curve("c", |t, _| t).plane([0.0; 3], [0.0; 3]), "the ground", 0.0);
    refused(new().curve("c", |t, _| t).surface([0.0, 1.0], [0.0, 1.0], |x, _| 1.0 / x), "the ground", 0.0);
    let negative = [Shape::ring(-1.0, 0.1)];
    refused(new().body("b", negative, |_, _| Pose::at([0.0; 3])), "a shape of b", 0.0);
    // The first fault is the one that is told.
    refused(new().path("p", |_, _| [f64::NAN; 3]).path("q", |_, _| [f64::NAN; 3]), "p", 0.0);
}

#[test]
fn unknown_bodies_empty_pages_and_disordered_times_are_refused() {
    let recording = recorded(10);
    let unknown = Viewer::new("v", &recording).curve("c", |t, _| t).follow("nobody").to_html();
    assert!(matches!(unknown, Err(StudyError::UnknownBody { name, .. }) if name == "nobody"));
    let unknown = Viewer::new("v", &recording).curve("c", |t, _| t).drawn("b", []).to_html();
    assert!(matches!(unknown, Err(StudyError::UnknownBody { .. })));
    assert!(matches!(Viewer::new("v", &recording).to_html(), Err(StudyError::NothingToDraw { .. })));
    let short = recorded(1);
    let page = Viewer::new("v", &short).curve("c", |t, _| t).to_html();
    assert!(matches!(page, Err(StudyError::NothingToDraw { .. })));
    let mut disordered = recorded(3);
    disordered.record(0.0, &[0.0; 2]);
    disordered.record(9.0, &[0.0; 2]);
    let page = Viewer::new("v", &disordered).curve("c", |t, _| t).to_html();
    assert!(matches!(page, Err(StudyError::Times { time: 0.0, .. })));
    let mut broken = recorded(3);
    broken.record(f64::NAN, &[0.0; 2]);
    let page = Viewer::new("v", &broken).curve("c", |_, s| s[0]).to_html();
    assert!(matches!(page, Err(StudyError::Times { .. })));
}

#[test]
fn a_run_backwards_is_shown_forwards() {
    let mut recording = Recording::new(&["x"]);
    for t in [3.0, 2.0, 1.0] {
        recording.record(t, &[10.0 * t]);
    }
    let page = Viewer::new("v", &recording).curve("c", |_, s| s[0]).to_html().unwrap();
    assert_eq!(decoded(value(&page, "times")[0]), [0.0, 1.0, 2.0]);
    assert_eq!(decoded(value(&page, "values")[0]), [10.0, 20.0, 30.0]);
    assert!(page.contains("\"start\":1,"));
}

#[test]
fn long_recordings_are_thinned() {
    let recording = recorded(100_000);
    let page = |viewer: Viewer<'_, 2>| viewer.curve("c", |_, s| s[0]).to_html().unwrap();
    let count = |page: &str| decoded(value(page, "times")[0]).len();
    let standard = page(Viewer::new("v", &recording));
    assert_eq!(count(&standard), MOST_SAMPLES);
    assert_eq!(count(&page(Viewer::thinned("v", &recording, 100))), 100);
    let times = decoded(value(&standard, "times")[0]);
    assert_eq!(f64::from(times[MOST_SAMPLES - 1]), recording.last().unwrap().0 as f32 as f64);
    assert!(standard.len() < 700_000, "{} bytes", standard.len());
}

#[test]
fn samples_too_far_apart_are_told() {
    let recording = recorded(20);
    let largest = |rate: f64| {
        let turning = |t: f64, _: &[f64; 2]| Pose::at([0.0; 3]).turned([1.0, 0.0, 0.0], rate * t);
        let page = Viewer::new("v", &recording).body("b", [Shape::sphere(1.0)], turning).to_html().unwrap();
        let (_, rest) = page.split_once("\"largestTurn\":").unwrap();
        rest.split_once(',').unwrap().0.parse::<f64>().unwrap()
    };
    assert!((largest(4.0) - 0.5).abs() < 1e-9);
    assert!((largest(20.0) - 2.5).abs() < 1e-9);
}

/// A turning ball, a body without a place, and a particle.
struct Declared;

impl Bodies<f64, 2, 3> for Declared {
    fn bodies(&self, t: f64, &[x, v]: &[f64; 2]) -> [guen_runtime::Body; 3] {
        let inertia = Some([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
        let turn = [[t.cos(), -t.sin(), 0.0], [t.sin(), t.cos(), 0.0], [0.0, 0.0, 1.0]];
        let nothing =
            guen_runtime::Body { name: "nowhere", mass: None, inertia, center: None, orientation: None };
        [
            guen_runtime::Body { name: "ball", center: Some([0.0; 3]), orientation: Some(turn), ..nothing },
            guen_runtime::Body { orientation: Some(turn), ..nothing },
            guen_runtime::Body { name: "particle 1", center: Some([x, v, 0.0]), inertia: None, ..nothing },
        ]
    }
}

#[test]
fn declared_bodies_are_placed_where_they_are() {
    let recording = recorded(10);
    let viewer = Viewer::new("v", &recording).bodies(&Declared);
    let page = viewer.to_html().unwrap();
    assert_eq!(value(&page, "name"), ["ball", "particle 1"]);
    assert_eq!(value(&page, "kind"), ["sphere", "sphere"]);
    let last = decoded(value(&page, "poses")[0]);
    let half = 9.0 * 0.125 / 2.0_f64;
    assert!((last[7 * 9 + 5] - half.sin() as f32).abs() < 1e-6, "{last:?}");
    let particle = decoded(value(&page, "poses")[1]);
    assert_eq!(particle[7..9], [(0.125_f64).sin() as f32, (0.125_f64).cos() as f32]);
    let redrawn = viewer.drawn("ball", [Shape::cuboid([1.0; 3])]).to_html().unwrap();
    assert_eq!(value(&redrawn, "kind"), ["cuboid", "sphere"]);
}

#[test]
fn the_library_is_the_one_described() {
    // SHA-256 would need a crate; length and the 64-bit FNV-1a hash notice every accident.
    let library = include_bytes!("vendor/three.min.js");
    let hash = library.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    let described = include_str!("vendor/README.md");
    assert!(described.contains(&format!("{} bytes", library.len())));
    assert!(described.contains(&format!("FNV-1a 64: {hash:016x}")), "{hash:016x}");
    assert!(!String::from_utf8_lossy(library).contains("</script"));
}

#[test]
fn a_file_in_a_new_folder() {
    let folder = std::env::temp_dir().join(format!("guen-study-html-{}", std::process::id()));
    let path = folder.join("deep/page.html");
    let recording = recorded(3);
    let viewer = Viewer::new("v", &recording).curve("c", |t, _| t);
    viewer.write(&path).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), viewer.to_html().unwrap());
    assert!(matches!(viewer.write(&folder), Err(StudyError::Io { .. })));
    std::fs::remove_dir_all(folder).unwrap();
}
