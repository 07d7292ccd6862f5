//! The HTML file: its parts in order, with the motion as data.

use super::data::{Json, escaped};
use super::phases::{Mark, Words};
use super::shape::{Pose, difference};
use super::track::{Shown, Track, bounds, range};
use super::turn::norm;
use super::{Fault, Ground, Link, LinkKind, MovingBody, MovingPoint, Panel, Shape, Viewer, notes, still};
use crate::error::StudyError;

/// Points of a surface in each direction.
pub(super) const MESH: usize = 65;

/// The drawing library, as it is described in `vendor/README.md`.
const LIBRARY: &str = include_str!("vendor/three.min.js");

/// The page's own style and program, in the order in which they are needed.
const STYLE: &str = include_str!("page/style.css");
const BODY: &str = include_str!("page/body.html");
const PROGRAM: [&str; 21] = [
    include_str!("page/data.js"),
    include_str!("page/runs.js"),
    include_str!("page/motion.js"),
    include_str!("page/clock.js"),
    include_str!("page/colours.js"),
    include_str!("page/solids.js"),
    include_str!("page/ground.js"),
    include_str!("page/quality.js"),
    include_str!("page/stage.js"),
    include_str!("page/curves.js"),
    include_str!("page/span.js"),
    include_str!("page/plot.js"),
    include_str!("page/phases.js"),
    include_str!("page/panel.js"),
    include_str!("page/player.js"),
    include_str!("page/frames.js"),
    include_str!("page/bodies.js"),
    include_str!("page/save.js"),
    include_str!("page/link.js"),
    include_str!("page/keys.js"),
    include_str!("page/start.js"),
];

/// The browser is asked to refuse what the page does not do: it loads nothing from anywhere.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// The style without its indentation.
fn style() -> String {
    STYLE.lines().flat_map(|line| [line.trim_start(), "\n"]).collect()
}

/// The program without indentation and lines of comments: a fifth of it is that.
fn program() -> String {
    let is_comment = |line: &&str| ["//", "/**", "* ", "*/"].iter().any(|mark| line.starts_with(mark));
    let lines = PROGRAM.iter().flat_map(|text| text.lines()).map(str::trim_start);
    lines.filter(|line| !line.is_empty() && !is_comment(line)).flat_map(|line| [line, "\n"]).collect()
}

/// Bytes of a page without a motion.
pub(super) fn own_bytes() -> usize {
    LIBRARY.len() + style().len() + BODY.len() + program().len()
}

/// The page of a description that was checked.
pub(super) fn html<const N: usize>(viewer: &Viewer<'_, N>) -> String {
    let title = escaped(&viewer.title);
    let space = Space::of(viewer);
    let notes = notes::of(viewer, &space);
    let (motion, parts) = motion(viewer, &space, &notes);
    let parts = parts.iter().enumerate().flat_map(|(k, part)| {
        [
            "<script type=\"text/plain\" id=\"part-".to_owned(),
            format!("{k}\">"),
            part.clone(),
            "</script>\n".to_owned(),
        ]
    });
    let parts: String = parts.collect();
    [
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n",
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
        "<meta name=\"color-scheme\" content=\"light dark\">\n",
        "<link rel=\"icon\" href=\"data:,\">\n",
        "<meta http-equiv=\"Content-Security-Policy\" content=\"",
        POLICY,
        "\">\n<title>",
        &title,
        "</title>\n<style>\n",
        &style(),
        "</style>\n</head>\n<body>\n",
        &still::html(viewer, &space, &notes),
        BODY,
        "<script type=\"application/json\" id=\"motion\">",
        &motion,
        "</script>\n",
        &parts,
        "<script>\n",
        LIBRARY,
        "</script>\n<script>\n\"use strict\";\n(() => {\n",
        &program(),
        "})();\n</script>\n</body>\n</html>\n",
    ]
    .concat()
}

/// A fault that keeps a description from becoming a page.
pub(super) fn check<const N: usize>(viewer: &Viewer<'_, N>) -> Result<(), StudyError> {
    let title = || viewer.title.clone();
    let curves = viewer.panels.iter().map(|panel| panel.curves.len()).sum::<usize>();
    let things = viewer.bodies.len() + viewer.paths.len() + viewer.links.len() + curves;
    if viewer.samples.len() == 0 || things == 0 {
        return Err(StudyError::NothingToDraw { title: title() });
    }
    if let Some(time) = viewer.samples.disorder {
        return Err(StudyError::Times { title: title(), time });
    }
    match viewer.fault.clone() {
        None => Ok(()),
        Some(Fault::NotDrawable { what, time }) => {
            Err(StudyError::NotDrawable { title: title(), what, time })
        }
        Some(Fault::UnknownBody { name }) => Err(StudyError::UnknownBody { title: title(), name }),
        Some(Fault::UnknownContact { name, known }) => {
            Err(StudyError::UnknownContact { title: title(), name, known })
        }
        Some(Fault::NothingToDraw { title }) => Err(StudyError::NothingToDraw { title }),
        Some(Fault::Times { title, time }) => Err(StudyError::Times { title, time }),
        Some(Fault::TooLarge { bytes }) => {
            Err(StudyError::TooLarge { title: title(), bytes, limit: viewer.limit })
        }
    }
}

/// Everything that the page shows, as JSON; `page/motion.js` reads it.
fn motion<const N: usize>(viewer: &Viewer<'_, N>, space: &Space, notes: &[String]) -> (String, Vec<String>) {
    let mut json = Json::default();
    let origin = space.origin.unwrap_or_default();
    let placed = |place: [f64; 3]| difference(place, origin);
    json.object(|json| {
        json.text("title", &viewer.title);
        let start = viewer.start();
        json.number("start", start);
        json.text("timeUnit", viewer.view.time_unit.as_deref().unwrap_or("s"));
        moments(json, &viewer.samples.steps, viewer.samples.start - start);
        json.objects("notes", notes, |json, note| json.text("text", note));
        if let Some(origin) = &space.origin {
            json.numbers("origin", origin);
        }
        let own = (&viewer.bodies[..], &viewer.paths[..], &viewer.links[..], &viewer.panels[..]);
        run(json, own, viewer.samples.start - start, space);
        occasions(json, (&viewer.marks, &viewer.words), start);
        json.text("run", viewer.own_name());
        json.objects("guests", &viewer.guests, |json, guest| {
            let later = guest.start - start;
            json.text("name", &guest.name);
            json.text("kind", if guest.is_ghost { "ghost" } else { "beside" });
            moments(json, &guest.steps, later);
            run(json, (&guest.bodies, &guest.paths, &guest.links, &guest.panels), later, space);
            occasions(json, (&guest.marks, &guest.words), start);
        });
        json.objects("grounds", &viewer.grounds, |json, ground| match ground {
            Ground::Plane { point, normal } => {
                json.text("kind", "plane");
                json.numbers("point", &placed(*point));
                json.numbers("normal", normal);
            }
            Ground::Surface { x, y, heights } => {
                json.text("kind", "surface");
                json.numbers("x", &x.map(|x| x - origin[0]));
                json.numbers("y", &y.map(|y| y - origin[1]));
                json.number("mesh", MESH as f64);
                json.samples("heights", heights.iter().map(|height| height - origin[2]));
            }
        });
        // The level ground at height zero is out of sight of what is far from it.
        json.number("bare", f64::from(u8::from(viewer.view.bare || space.origin.is_some())));
        json.numbers("up", &viewer.view.up.unwrap_or([0.0, 0.0, 1.0]));
        if let Some(from) = viewer.view.from {
            json.numbers("from", &from);
        }
        if let Some(name) = &viewer.view.follow {
            json.text("follow", name);
        }
    });
    json.into_texts()
}

/// Times since the page's first one, of a run that begins so much later.
fn moments(json: &mut Json, times: &[f64], later: f64) {
    json.doubles("times", &times.iter().map(|time| time + later).collect::<Vec<f64>>());
}

/// Writes what a run marks and says, at times since the page's first one.
fn occasions(json: &mut Json, (marks, words): (&[Mark], &[Words]), start: f64) {
    let write = |json: &mut Json, mark: &Mark| {
        json.number("time", mark.time - start);
        json.text("text", &mark.text);
    };
    let sorted = |marks: &[Mark]| {
        let mut marks = marks.to_vec();
        marks.sort_by(|a, b| a.time.total_cmp(&b.time));
        marks
    };
    json.objects("marks", &sorted(marks), write);
    json.objects("words", words, |json, words| {
        json.text("name", &words.name);
        json.objects("changes", &sorted(&words.changes), write);
    });
}

/// Writes all that a run shows that begins so much later than the page.
fn run(
    json: &mut Json,
    (bodies, paths, links, panels): (&[MovingBody], &[MovingPoint], &[Link], &[Panel]),
    later: f64,
    space: &Space,
) {
    let origin = space.origin.unwrap_or_default();
    let placed = |place: [f64; 3]| difference(place, origin);
    json.objects("bodies", bodies, |json, body| {
        json.text("name", &body.name);
        json.objects("shapes", &body.shapes, |json, shape| {
            let (kind, lengths) = shape.kind.parts();
            json.text("kind", kind);
            json.numbers("lengths", lengths);
            json.numbers("place", &shape.place);
            json.numbers("turn", &shape.turn.0);
            if let Some(colour) = shape.colour {
                json.number("colour", f64::from(colour));
            }
        });
        own_times(json, &body.poses, later);
        json.samples("poses", body.poses.values.iter().flat_map(|pose| reals(pose, placed)));
    });
    json.objects("paths", paths, |json, path| {
        json.text("name", &path.name);
        own_times(json, &path.points, later);
        json.samples("points", path.points.values.iter().flat_map(|point| placed(*point)));
    });
    json.objects("links", links, |json, link| {
        json.text("name", &link.name);
        json.text("kind", if link.kind == LinkKind::Rod { "rod" } else { "arrow" });
        let (radius, ends) = space.drawn(link);
        json.number("radius", radius);
        own_times(json, &link.ends, later);
        json.samples("ends", ends.flatten().flat_map(placed));
    });
    json.objects("panels", panels, |json, panel| {
        json.text("name", &panel.name);
        if panel.is_folded {
            json.number("folded", 1.0);
        }
        json.objects("curves", &panel.curves, |json, curve| {
            json.text("name", &curve.name);
            own_times(json, &curve.values, later);
            let base = base(&curve.values.values);
            if base != 0.0 {
                json.number("base", base);
            }
            json.samples("values", curve.values.values.iter().map(|value| value - base));
        });
    });
}

/// The times of a track that has its own.
fn own_times<T>(json: &mut Json, track: &Track<T>, later: f64) {
    if let Some(times) = &track.times {
        moments(json, times, later);
    }
}

/// The place and the quaternion `x, y, z, w`, as the drawing library orders it.
fn reals(pose: &Pose, placed: impl Fn([f64; 3]) -> [f64; 3]) -> [f64; 7] {
    let ([x, y, z], [w, i, j, k]) = (placed(pose.place), pose.turn.normalized().0);
    [x, y, z, i, j, k, w]
}

/// Numbers as many times larger than what they differ by lose it in single precision, which has 1.7e7 parts.
const FAR_OFF: f64 = 1000.0;

/// The common part of a curve's values, if single precision would not hold their differences.
fn base(values: &[f64]) -> f64 {
    let (low, high) = range(values);
    let middle = low + (high - low) / 2.0;
    if middle.abs() > FAR_OFF * (high - low) && high > low { middle } else { 0.0 }
}

/// The arrow of the largest force as a part of the size of the motion, and the radius of such arrows as a part of the longest one.
const LONGEST_FORCE: f64 = 0.25;
const FORCE_RADIUS: f64 = 0.02;

/// The place and the size of a motion.
pub(super) struct Space {
    /// The place that is subtracted from all places, if single precision would not hold their differences.
    pub(super) origin: Option<[f64; 3]>,
    /// The length of an arrow for a force of one.
    pub(super) per_force: Option<f64>,
    /// The radius of such arrows.
    force_radius: f64,
}

impl Space {
    pub(super) fn of<const N: usize>(viewer: &Viewer<'_, N>) -> Self {
        fn places<T: Shown>(track: &Track<T>) -> impl Iterator<Item = [f64; 3]> {
            track.values.iter().flat_map(Shown::places)
        }
        let bodies = viewer.all_bodies().flat_map(|body| places(&body.poses));
        let paths = viewer.all_paths().flat_map(|path| places(&path.points));
        // The vector of a force is no place.
        let links = viewer.all_links().flat_map(|link| {
            let step = if link.kind == LinkKind::Force { 2 } else { 1 };
            places(&link.ends).step_by(step)
        });
        let (least, most) = bounds(bodies.chain(paths).chain(links));
        let size = norm(difference(most, least));
        let around = viewer.all_bodies().flat_map(|body| &body.shapes).map(Shape::reach).fold(0.0, f64::max);
        // Bodies at rest have no track; their size is that of their shapes.
        let held = if size > 0.0 { size } else { around };
        let is_far = (0..3).any(|i| least[i].abs().max(most[i].abs()) > FAR_OFF * held) && held > 0.0;
        // A number that can be read: to the power of ten below the size of the motion.
        let step = 10.0_f64.powf(held.log10().floor());
        let middle = |i: usize| ((least[i] + (most[i] - least[i]) / 2.0) / step).round() * step;
        let origin = (is_far && size.is_finite()).then(|| std::array::from_fn(middle));
        let size = if size.is_finite() { size } else { 0.0 } + 2.0 * around;
        let size = if size > 0.0 { size } else { 1.0 };
        let forces = viewer.all_links().filter(|link| link.kind == LinkKind::Force);
        let largest =
            forces.flat_map(|link| &link.ends.values).map(|[_, force]| norm(*force)).fold(0.0, f64::max);
        let per_force = viewer.view.per_force.or((largest > 0.0).then(|| LONGEST_FORCE * size / largest));
        let per_force = per_force.filter(|_| largest > 0.0);
        let force_radius = per_force.map_or(0.0, |scale| FORCE_RADIUS * scale * largest);
        Self { origin, per_force, force_radius }
    }

    /// A link's radius and the places of its ends.
    pub(super) fn drawn<'l>(&self, link: &'l Link) -> (f64, impl Iterator<Item = [[f64; 3]; 2]> + use<'l>) {
        let scale = self.per_force.unwrap_or(0.0);
        let is_force = link.kind == LinkKind::Force;
        let ends = link.ends.values.iter().map(move |&[from, to]| {
            let tip = std::array::from_fn(|i| from[i] + scale * to[i]);
            [from, if is_force { tip } else { to }]
        });
        (if is_force { self.force_radius } else { link.radius }, ends)
    }
}
