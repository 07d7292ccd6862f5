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

/// Decodes base64 as the page's program does.
fn bytes_of(text: &str) -> Vec<u8> {
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
    bytes
}

/// Decodes samples in single precision.
fn decoded(text: &str) -> Vec<f32> {
    bytes_of(text).chunks_exact(4).map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
}

/// Decodes times.
fn doubles(text: &str) -> Vec<f64> {
    bytes_of(text).chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().unwrap())).collect()
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
    assert_eq!(doubles(value(&page, "times")[0]), recording.times());
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
    let empty = recorded(0);
    for page in [Viewer::new("v", &empty), Viewer::complete("v", &empty), Viewer::thinned("v", &empty, 9)] {
        let page = page.bodies(&Declared).curve("c", |t, _| t).path("p", |_, _| [0.0; 3]).to_html();
        assert!(matches!(page, Err(StudyError::NothingToDraw { .. })));
    }
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
fn one_sample_is_a_picture_at_its_time() {
    let mut recording = Recording::new(&["x", "v"]);
    recording.record(7.0, &[6.4e6, 2.0]);
    for page in [Viewer::new("v", &recording), Viewer::complete("v", &recording)] {
        let page = page
            .body("b", [Shape::sphere(0.5)], |_, s| Pose::at([s[0] + 0.25, 0.0, 0.5]))
            .curve("c", |_, s| s[1])
            .to_html()
            .unwrap();
        assert_eq!(doubles(value(&page, "times")[0]), [0.0]);
        assert_eq!(decoded(value(&page, "values")[0]), [2.0]);
        // Far from the origin the place is relative to one beside it.
        assert!(page.contains(r#""origin":[6400000.3"#), "{}", notes(&page));
        assert!((decoded(value(&page, "poses")[0])[0] + 0.05).abs() < 1e-6);
        assert!(page.contains("\"start\":7,") && notes(&page).contains("one sample"), "{}", notes(&page));
    }
    // Two samples are no matter of one.
    assert!(
        !notes(&Viewer::new("v", &recorded(2)).curve("c", |t, _| t).to_html().unwrap())
            .contains("one sample")
    );
}

/// The page's data after the key of further runs.
fn guests(page: &str) -> &str {
    page.split_once("\"guests\":[").unwrap().1.split_once("</script>").unwrap().0
}

#[test]
fn runs_have_one_clock_and_one_origin() {
    // Far from the origin, and the guest begins before the page's own run.
    let mut early = Recording::new(&["t"]);
    (0..=40).map(|k| -1.0 + 0.125 * f64::from(k)).for_each(|t| early.record(t, &[t]));
    let far = |t: f64| Pose::at([6.4e6 + t, 0.0, 0.0]);
    let guest = Viewer::new("early", &early).body("b", [Shape::sphere(0.1)], |t, _| far(t));
    let own = recorded(50);
    let page = Viewer::new("own", &own).body("b", [Shape::sphere(0.1)], |t, _| far(t)).ghost(guest).to_html();
    let page = page.unwrap();
    assert!(page.contains("\"start\":-1,"));
    let [own, early] = [0, 1].map(|k| doubles(value(&page, "times")[k]));
    assert_eq!((own[0], own[49], early[0], early[40]), (1.0, 7.125, 0.0, 5.0));
    // Where both are at the same time, both are at the same place.
    let x: Vec<Vec<f32>> = (0..2).map(|k| decoded(value(&page, "poses")[k])).collect();
    assert_eq!(x[0][0], x[1][7 * 8]);
    assert!(notes(&page).contains("own begins at t = 0 s. early ends at t = 4 s"), "{}", notes(&page));
    assert!(guests(&page).starts_with(r#"{"name":"early","kind":"ghost""#));
}

#[test]
fn guests_are_thinned_with_the_page_and_refused_with_their_names() {
    let mut long = Recording::new(&["t"]);
    (0..100_000).map(f64::from).for_each(|t| long.record(t, &[t]));
    let noise = |t: f64, _: &[f64; 1]| (t * t).sin();
    let own = recorded(5);
    let page = || Viewer::new("own", &own).curve("c", |t, _| t);
    let whole = Viewer::complete("long", &long).curve("c", noise);
    let small = page().ghost(whole).within_bytes(900_000).to_html().unwrap();
    assert!(small.len() <= 900_000 && notes(&small).contains("of 5 to 100000 samples"), "{}", notes(&small));

    let refused = |guest: Viewer<'_, 1>| page().beside(guest).to_html().unwrap_err().to_string();
    let told = refused(Viewer::new("long", &long).curve("c", |t, _| 1.0 / (t - 3.0)));
    assert!(told.contains("c of long") && told.contains('3'), "{told}");
    let empty = Recording::new(&["t"]);
    assert!(refused(Viewer::new("empty", &empty).curve("c", noise)).contains("empty"));
    let mut disordered = Recording::new(&["t"]);
    [0.0, 2.0, 1.0, 3.0].iter().for_each(|t| disordered.record(*t, &[*t]));
    assert!(refused(Viewer::new("disordered", &disordered).curve("c", noise)).contains("disordered"));
}

#[test]
fn a_run_backwards_is_shown_forwards() {
    let mut recording = Recording::new(&["x"]);
    for t in [3.0, 2.0, 1.0] {
        recording.record(t, &[10.0 * t]);
    }
    let page = Viewer::new("v", &recording).curve("c", |_, s| s[0]).to_html().unwrap();
    assert_eq!(doubles(value(&page, "times")[0]), [0.0, 1.0, 2.0]);
    assert_eq!(decoded(value(&page, "values")[0]), [10.0, 20.0, 30.0]);
    assert!(page.contains("\"start\":1,"));
}

/// The sentences that the page says about its data.
fn notes(page: &str) -> String {
    let (_, rest) = page.split_once("\"notes\":[").unwrap();
    rest.split_once(']').unwrap().0.to_owned()
}

#[test]
fn long_recordings_keep_every_extremum() {
    // A slow swing, and in it one pulse of a single sample that even choices miss.
    let mut recording = Recording::new(&["x"]);
    for k in 0..100_000 {
        let t = 1e-3 * f64::from(k);
        recording.record(t, &[t.sin() + if k == 54_321 { 3.0 } else { 0.0 }]);
    }
    let page = |viewer: Viewer<'_, 1>| {
        viewer.curve("c", |_, s| s[0]).path("p", |t, s| [t, s[0], 0.0]).to_html().unwrap()
    };
    let standard = page(Viewer::new("v", &recording));
    let values = decoded(value(&standard, "values")[0]);
    let times = doubles(value(&standard, "times")[2]);
    assert_eq!(values.len(), times.len());
    let pulse = times.iter().position(|t| *t == 54.321).unwrap();
    assert_eq!(values[pulse], ((54.321_f64).sin() + 3.0) as f32);
    // Every extremum of the data is there.
    let all: Vec<f64> = recording.column(0).collect();
    let is_extremum = |k: usize| (all[k] - all[k - 1]) * (all[k + 1] - all[k]) < 0.0;
    let extrema: Vec<usize> = (1..all.len() - 1).filter(|&k| is_extremum(k)).collect();
    assert!(extrema.len() > 30 && extrema.iter().all(|&k| times.contains(&recording.times()[k])));
    // Between the samples that are kept, lines are near the curve.
    for (t, x) in recording.curve(0) {
        let k = times.partition_point(|s| *s <= t).clamp(1, times.len() - 1) - 1;
        let part = (t - times[k]) / (times[k + 1] - times[k]);
        let shown = f64::from(values[k]) * (1.0 - part) + f64::from(values[k + 1]) * part;
        assert!((shown - x).abs() < 5.0 / 2000.0, "at {t}");
    }
    // The library and the program, and little beside them.
    let own = page::own_bytes();
    assert!(own < 680_000, "{own}");
    assert!(
        values.len() < 4000 && standard.len() < own + 100_000,
        "{} and {}",
        values.len(),
        standard.len() - own
    );
    let told = notes(&standard);
    assert!(told.contains("of 100000 samples") && told.contains("each of their minima and maxima"), "{told}");
    // Fewer on request; the first and the last are always there.
    let few = page(Viewer::thinned("v", &recording, 100));
    let times = doubles(value(&few, "times")[2]);
    assert!(times.len() <= 100 && (times[0], times[times.len() - 1]) == (0.0, recording.times()[99_999]));
    assert_eq!(doubles(value(&few, "times")[0]).len(), 100);
}

#[test]
fn what_keeps_all_samples_says_nothing() {
    let recording = recorded(MOST_SAMPLES as u32);
    let page = Viewer::new("v", &recording).curve("c", |_, s| s[0]).to_html().unwrap();
    assert_eq!((notes(&page).as_str(), value(&page, "times").len()), ("", 1));
    assert_eq!(decoded(value(&page, "values")[0]).len(), MOST_SAMPLES);
    // A recording that dropped samples itself is told.
    let mut short = Recording::new(&["x"]).with_limit(100);
    (0..1000).for_each(|k| short.record(f64::from(k), &[0.0]));
    let page = Viewer::new("v", &short).curve("c", |_, s| s[0]).to_html().unwrap();
    assert!(notes(&page).contains("of the 1000 samples of the run"), "{}", notes(&page));
}

#[test]
fn all_samples_on_request_in_parts() {
    let recording = recorded(1_000_000);
    let page = Viewer::complete("v", &recording).curve("c", |_, s| s[0]).to_html().unwrap();
    assert_eq!(notes(&page), "");
    assert!(page.contains(r#""values":{"bytes":4000000,"from":1,"to":2}"#));
    let (_, part) = page.split_once("id=\"part-1\">").unwrap();
    let values = decoded(part.split_once('<').unwrap().0);
    assert_eq!(values.len(), 1_000_000);
    assert!(recording.column(0).zip(&values).all(|(x, shown)| x as f32 == *shown));
    // A page that is too large for any browser is refused before its memory is taken.
    let huge = Viewer::complete("v", &recording).within_bytes(20_000_000);
    let refused = (0..9).fold(huge, |page, k| page.body(format!("b{k}"), [], |_, _| Pose::at([0.0; 3])));
    assert!(matches!(refused.to_html(), Err(StudyError::TooLarge { limit: 20_000_000, .. })));
}

#[test]
fn a_thousand_bodies_fit() {
    let recording = recorded(500);
    let page = (0..1000_u32).fold(Viewer::new("v", &recording), |page, k| {
        let phase = f64::from(k);
        page.body(format!("b{k}"), [Shape::sphere(0.1)], move |t, _| {
            Pose::at([phase, (t + phase).sin(), 0.0])
        })
    });
    let text = page.within_bytes(2_500_000).to_html().unwrap();
    assert!(text.len() <= 2_500_000 && text.len() > 1_500_000, "{}", text.len());
    assert!(notes(&text).contains("of 500 samples. Places are drawn within"), "{}", notes(&text));
    assert_eq!(value(&text, "poses").len(), 1000);
}

#[test]
fn far_from_the_origin_a_track_is_no_staircase() {
    let radius = 6.4e6;
    let mut recording = Recording::new(&["x"]);
    (0..200).for_each(|k| recording.record(f64::from(k), &[radius + 0.25 + 0.01 * f64::from(k)]));
    let page = Viewer::new("v", &recording)
        .path("p", |_, s| [s[0], 0.0, 0.0])
        .plane([radius, 0.0, 0.0], [0.0, 0.0, 1.0])
        .curve("c", |_, s| s[0])
        .to_html()
        .unwrap();
    let points = decoded(value(&page, "points")[0]);
    for (step, k) in points.windows(4).step_by(3).map(|four| f64::from(four[3] - four[0])).zip(0..) {
        assert!((step - 0.01).abs() < 1e-6, "{step} at {k}");
    }
    assert!(notes(&page).contains("Places are relative to (6400001, 0, 0)."), "{}", notes(&page));
    assert!(page.contains(r#""origin":[6400001,0,0]"#) && page.contains(r#""point":[-1,0,0]"#));
    let (_, base) = page.split_once("\"base\":").unwrap();
    let base: f64 = base.split_once(',').unwrap().0.parse().unwrap();
    let values = decoded(value(&page, "values")[0]);
    for (value, x) in values.iter().zip(recording.column(0)) {
        assert!((base + f64::from(*value) - x).abs() < 1e-6, "{value} for {x}");
    }
    // Near the origin nothing is moved.
    let near = Viewer::new("v", &recording).path("p", |t, _| [t + 100.0, 0.0, 0.0]).to_html().unwrap();
    assert!(!near.contains("\"origin\"") && !notes(&near).contains("relative"));
}

#[test]
fn forces_are_scaled_so_that_the_largest_is_seen() {
    let recording = recorded(50);
    let page = |unit: f64| {
        Viewer::new("v", &recording)
            .body("b", [Shape::sphere(0.5)], |_, s| Pose::at([s[0], 0.0, 0.0]))
            .force("f", move |_, s| [[s[0], 0.0, 0.0], [0.0, 0.0, unit * s[1]]])
            .to_html()
            .unwrap()
    };
    for unit in [1e-3, 1.0, 1e6] {
        let page = page(unit);
        let ends = decoded(value(&page, "ends")[0]);
        let longest = ends.chunks(6).map(|e| (e[5] - e[2]).abs()).fold(0.0, f32::max);
        // The bodies' places span 2, less what the samples miss, and the ball reaches 0.5 beyond.
        assert!((0.7..0.76).contains(&longest), "{longest}");
        let told = notes(&page);
        let (_, scale) = told.split_once("have the length ").unwrap();
        let scale: f64 = scale.split_once(' ').unwrap().0.parse().unwrap();
        assert!((scale * unit / f64::from(longest) - 1.0).abs() < 0.06, "{told}");
    }
    assert!(!notes(&page(0.0)).contains("Arrows"));
}

#[test]
fn states_and_outputs_are_curves_with_names_and_units() {
    let recording = recorded(50);
    let page = Viewer::new("v", &recording).states(&["m"]).to_html().unwrap();
    assert_eq!(value(&page, "name"), ["state in m", "x", "v", "v"]);
    let grouped = Viewer::new("v", &recording).states(&["m", "m"]).to_html().unwrap();
    assert_eq!(value(&grouped, "name"), ["state in m", "x", "v"]);
    let expected: Vec<f32> = recording.column(1).map(|v| v as f32).collect();
    assert_eq!(decoded(value(&grouped, "values")[1]), expected);
}

#[test]
fn samples_too_far_apart_are_told() {
    let recording = recorded(20);
    let told = |rate: f64| {
        let turning = |t: f64, _: &[f64; 2]| Pose::at([0.0; 3]).turned([1.0, 0.0, 0.0], rate * t);
        notes(&Viewer::new("v", &recording).body("b", [Shape::sphere(1.0)], turning).to_html().unwrap())
    };
    assert_eq!(told(4.0), "");
    assert!(told(20.0).contains("turns by 143° or more"), "{}", told(20.0));
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

/// Returns the part that a reader without scripts sees.
fn still(page: &str) -> &str {
    page.split_once("<noscript>").unwrap().1.split_once("</noscript>").unwrap().0
}

#[test]
fn without_scripts_there_are_pictures() {
    let recording = recorded(200);
    let viewer = Viewer::new("Still", &recording)
        .body("a <body>", [Shape::disc(0.2, 0.05), Shape::cuboid([0.1; 3])], |_, s| {
            Pose::at([s[0], s[1], 0.2])
        })
        .body("ball", [Shape::sphere(0.1).coloured(0x12_34_56)], |t, _| Pose::at([0.0, 0.0, 0.01 * t]))
        .path("way", |_, s| [s[0], s[1], 0.0])
        .rod("rod", 0.01, |_, s| [[0.0; 3], [s[0], s[1], 0.2]])
        .force("force", |_, s| [[0.0; 3], [s[0], 0.0, 5.0]])
        .panel("heights in m")
        .curve("x", |_, s| s[0])
        .curve("v", |_, s| s[1])
        .time_unit("h");
    let page = viewer.to_html().unwrap();
    let still = still(&page);
    // The start, the middle and the end, each with its time.
    for told in ["t = 0 h", "t = 12.438 h", "t = 24.875 h"] {
        assert!(still.contains(&format!("<figcaption>{told}</figcaption>")), "{told}");
    }
    // Three pictures and three plots' worth of elements: balls, boxes with faces, a head for each arrow, names.
    assert_eq!(still.matches("<circle").count(), 3);
    assert_eq!(still.matches("fill=\"#123456\"").count(), 3 + 1);
    assert!(still.contains("<bdi>a &lt;body&gt;</bdi>") && still.contains("<title>heights in m</title>"));
    assert!(!page.contains("<noscript>\n<noscript>") && page.matches("<noscript>").count() == 1);
    assert!(still.len() < 60_000, "{}", still.len());
    // The colours for the dark are there once, and not on paper.
    assert_eq!(
        (still.matches("screen and (prefers-color-scheme:dark)").count(), still.matches("<style>").count()),
        (1, 2)
    );
    assert!(!still.contains("NaN") && !still.contains("inf"));
    // A motion of one sample has one picture.
    let mut one = Recording::new(&["x"]);
    one.record(3.0, &[1.0]);
    let page = Viewer::new("One", &one).path("p", |_, _| [0.0; 3]).curve("c", |_, s| s[0]).to_html().unwrap();
    assert_eq!(self::still(&page).matches("<figcaption>t = 3 s</figcaption>").count(), 1);
}

#[test]
fn pictures_without_scripts_stay_small() {
    let recording = recorded(500);
    let crowd = (0..1000_u32).fold(Viewer::new("v", &recording), |page, k| {
        page.body(format!("b{k}"), [Shape::cuboid([0.1; 3])], move |_, s| Pose::at([f64::from(k), s[0], 0.0]))
    });
    let noise = |k: f64| move |t: f64, _: &[f64; 2]| (1e4 * (t + k) * (t + k)).sin();
    let crowd = (0..120_u32).fold(crowd, |page, k| page.panel("p").curve("c", noise(f64::from(k))));
    for limit in [64_000_000, 4_000_000, 2_000_000] {
        let page = crowd.clone().within_bytes(limit).to_html().unwrap();
        let still = still(&page);
        assert!(page.len() <= limit && still.len() <= 200_000.min(limit / 20), "{} of {limit}", still.len());
        assert!(still.contains("more panels of curves"));
    }
}

#[test]
fn pictures_are_seen_from_where_the_page_is() {
    let mut recording = Recording::new(&["x"]);
    recording.record(0.0, &[0.0]);
    recording.record(1.0, &[1.0]);
    // A point that goes along x, or up, seen along y: from left to right, or upwards.
    let points = |way: fn(f64) -> [f64; 3], from: [f64; 3]| -> Vec<f64> {
        let page =
            Viewer::new("v", &recording).path("p", move |t, _| way(t)).seen_from(from).without_ground();
        let page = page.to_html().unwrap();
        let (_, line) = still(&page).split_once("<polyline points=\"").unwrap();
        line.split_once('"').unwrap().0.split([',', ' ']).map(|number| number.parse().unwrap()).collect()
    };
    let near = |found: Vec<f64>, expected: [f64; 4]| {
        // At the start the rest of the path begins with where the point is, twice.
        let found = [&found[..2], &found[found.len() - 2..]].concat();
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.2), "{found:?}, not {expected:?}");
    };
    // Half a length fills 0.5 / (0.5 * 0.84 / sin 19 deg) / tan 19 deg of half the height.
    let half = 200.0 * 19.0_f64.to_radians().cos() / 0.84;
    near(points(|t| [t, 0.0, 0.0], [0.0, -1.0, 0.0]), [320.0 - half, 200.0, 320.0 + half, 200.0]);
    near(points(|t| [t, 0.0, 0.0], [0.0, 1.0, 0.0]), [320.0 + half, 200.0, 320.0 - half, 200.0]);
    near(points(|t| [0.0, 0.0, t], [0.0, -1.0, 0.0]), [320.0, 200.0 + half, 320.0, 200.0 - half]);
    near(points(|t| [0.0, t, 0.0], [0.0, 0.0, 1.0]), [320.0, 200.0 + half, 320.0, 200.0 - half]);
}

#[test]
fn what_is_below_a_table_is_behind_it() {
    let recording = recorded(1);
    let order = |height: f64, from: [f64; 3]| {
        let page = Viewer::new("v", &recording)
            .body("table", [Shape::disc(1.0, 0.05).coloured(0x13_57_99)], |_, _| Pose::at([0.0; 3]))
            .body("ball", [Shape::sphere(0.1).coloured(0x24_68_88)], move |_, _| {
                Pose::at([0.0, -0.1, height])
            })
            .seen_from(from)
            .to_html()
            .unwrap();
        let scene = still(&page).split_once("</figure>").unwrap().0.to_owned();
        scene.find("#135799").unwrap() < scene.find("#246888").unwrap()
    };
    assert!(order(0.2, [0.0, -1.0, 0.5]) && !order(-0.2, [0.0, -1.0, 0.5]));
    assert!(!order(0.2, [0.0, -1.0, -0.5]) && order(-0.2, [0.0, -1.0, -0.5]));
}

#[test]
fn marks_and_words_are_in_the_order_of_time_since_the_start() {
    let mut recording = Recording::new(&["x"]);
    (0..10).for_each(|k| recording.record(2.0 + f64::from(k), &[0.0]));
    let run = |name| {
        Viewer::new(name, &recording)
            .panel("p")
            .curve("c", |_, s| s[0])
            .words("belt", [(6.0, "slip"), (2.0, "stick")])
    };
    let page = run("one")
        .mark(6.5, "later")
        .mark(4.0, "<earlier>")
        .ghost(run("two").mark(3.0, "other"))
        .to_html()
        .unwrap();
    let marks = r#""marks":[{"time":2,"text":"\u003cearlier\u003e"},{"time":4.5,"text":"later"}]"#;
    assert!(page.contains(marks) && page.contains(r#""marks":[{"time":1,"text":"other"}]"#));
    let words = r#""words":[{"name":"belt","changes":[{"time":0,"text":"stick"},{"time":4,"text":"slip"}]}]"#;
    assert_eq!(page.matches(words).count(), 2);
    assert!(still(&page).contains("dashed lines at 2 marks"));
    assert!(
        matches!(run("one").mark(f64::NAN, "m").to_html(), Err(StudyError::NotDrawable { what, .. }) if what == "the mark `m`")
    );
}

#[test]
fn marks_count_in_the_size_of_a_page() {
    let recording = recorded(10);
    let page = |marks: u32| {
        (0..marks).fold(Viewer::new("v", &recording).curve("c", |_, s| s[0]), |page, k| {
            page.mark(f64::from(k), "x".repeat(100))
        })
    };
    let few = page(0).to_html().unwrap().len();
    assert!(page(5000).to_html().unwrap().len() > few + 500_000);
    assert!(matches!(page(5000).within_bytes(few + 100_000).to_html(), Err(StudyError::TooLarge { .. })));
}
