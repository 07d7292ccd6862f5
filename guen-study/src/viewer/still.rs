//! Pictures for readers without scripts: the scene at its start, in its middle and at its end, as the page first sees it, and
//! the panels as plots. `outline` draws what is in the scene; the texts of a picture are its time and its names.

use super::data::escaped;
use super::outline::{self, Eye, SIZE};
use super::page::Space;
use super::track::Track;
use super::{Curve, Panel, Viewer};
use crate::plot::{self, Plot};

/// The most bytes of all pictures, and the part of the largest size of the page that they may take.
const MOST_BYTES: usize = 200_000;
const MOST_PART: usize = 20;

/// The size of a panel, in pixels; one whose legend needs more is twice as high.
const PANEL: [u32; 2] = [640, 260];

/// Points of all curves of a panel, and the fewest and the most of one.
const PANEL_POINTS: usize = 3000;
const CURVE_POINTS: [usize; 2] = [60, 600];

/// Things that are named below the scene; more would be a list that nobody reads.
const MOST_NAMES: usize = 24;

/// Parts of the time at which the scene is shown, and the most points of all paths, from the best choice to the smallest.
const CHOICES: [(&[f64], usize); 4] =
    [(&[0.0, 0.5, 1.0], 3000), (&[0.0, 1.0], 1500), (&[0.0], 1500), (&[0.0], 200)];

/// Room for what is around the pictures, and for the number of panels that have none.
const TAIL_BYTES: usize = 200;

/// The head of the part that is shown where no script runs: it hides what would do nothing.
const HEAD: &str = "<noscript>\n<style>\nhtml, body { height: auto; }\nbody { display: block; }\nbody > :not(noscript) { display: none; }\n</style>\n";

/// The pictures, as an element that scripts keep from being shown.
pub(super) fn html<const N: usize>(viewer: &Viewer<'_, N>, space: &Space, notes: &[String]) -> String {
    let most = MOST_BYTES.min(viewer.limit / MOST_PART);
    let mut told =
        format!("<h1>{}</h1>\n<p>Without scripts this page shows pictures", escaped(&viewer.title));
    told += if viewer.paths.is_empty() {
        ". "
    } else {
        "; paths are strong up to their time and faint beyond it. "
    };
    told += &escaped(&notes.join(" "));
    told += "</p>\n";
    let mut body = told;
    let scene = CHOICES.iter().map(|(parts, points)| scene(viewer, space, parts, *points));
    let dark = plot::dark_style("screen and ");
    let mut room = most.saturating_sub(HEAD.len() + dark.len() + body.len() + TAIL_BYTES);
    // Half of the room for the scene, if there are curves, too.
    let half = if viewer.panels.is_empty() { room } else { room / 2 };
    let mut scene = scene.skip_while(|text| text.len() > half);
    let scene = scene.next().unwrap_or_else(|| "<p>The scene is too large for a picture.</p>\n".to_owned());
    room = room.saturating_sub(scene.len());
    body += &scene;
    let mut left_out = 0_usize;
    for panel in viewer.panels.iter().filter(|panel| !panel.curves.is_empty()) {
        match panel_picture(viewer, panel).filter(|text| text.len() <= room) {
            Some(text) => {
                room -= text.len();
                body += &text;
            }
            None => left_out += 1,
        }
    }
    if left_out > 0 {
        body += &format!("<p>{left_out} more panels of curves are shown with scripts.</p>\n");
    }
    [HEAD, &dark, "<div class=\"still\">\n", &body, "</div>\n</noscript>\n"].concat()
}

/// A time as the captions write it.
fn told_time<const N: usize>(viewer: &Viewer<'_, N>, time: f64) -> String {
    let unit = viewer.view.time_unit.as_deref().unwrap_or("s");
    escaped(&format!("t = {} {unit}", crate::table::significant(viewer.samples.start + time, 5)))
}

/// The scene at parts of its time, with the names of what is in it; nothing if nothing is.
fn scene<const N: usize>(viewer: &Viewer<'_, N>, space: &Space, parts: &[f64], points: usize) -> String {
    if viewer.bodies.is_empty() && viewer.paths.is_empty() && viewer.links.is_empty() {
        return String::new();
    }
    let times = &viewer.samples.times;
    let end = times.last().copied().unwrap_or(0.0);
    let eye = Eye::of(viewer, space);
    let paths = outline::thinned(viewer, points / viewer.paths.len().max(1));
    let mut text = String::new();
    // A motion of one sample has one picture.
    for time in parts.iter().map(|part| part * end).take(if end > 0.0 { parts.len() } else { 1 }) {
        let svg = outline::drawn(viewer, space, &eye, &paths, time);
        let [width, height] = SIZE;
        let told = told_time(viewer, time);
        text += &format!(
            "<figure><figcaption>{told}</figcaption>\n<svg viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" \
             aria-label=\"the motion in space at {told}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n{svg}</svg></figure>\n"
        );
    }
    text + &names(viewer)
}

/// The colours of what is in the scene.
fn names<const N: usize>(viewer: &Viewer<'_, N>) -> String {
    let bodies = viewer.bodies.iter().enumerate().filter(|(_, body)| !body.shapes.is_empty());
    let bodies = bodies.map(|(i, body)| (viewer.body_ink(i, body.shapes[0].colour), &body.name));
    let links = viewer.links.iter().enumerate().map(|(i, link)| (viewer.link_ink(i), &link.name));
    let paths = viewer.paths.iter().enumerate().map(|(i, path)| (viewer.path_ink(i), &path.name));
    let all: Vec<_> = bodies.chain(links).chain(paths).collect();
    let mut text = String::from("<p class=\"names\">");
    for (ink, name) in all.iter().take(MOST_NAMES) {
        text += &format!(
            "<span><svg width=\"12\" height=\"12\" aria-hidden=\"true\"><rect width=\"12\" height=\"12\" fill=\"{ink}\"/></svg> <bdi>{}</bdi></span>\n",
            escaped(name)
        );
    }
    if all.len() > MOST_NAMES {
        text += &format!("and {} more", all.len() - MOST_NAMES);
    }
    text + "</p>\n"
}

/// A panel as a plot; nothing if it cannot be drawn.
fn panel_picture<const N: usize>(viewer: &Viewer<'_, N>, panel: &Panel) -> Option<String> {
    let [fewest, most] = CURVE_POINTS;
    let points = (PANEL_POINTS / panel.curves.len()).clamp(fewest, most);
    let unit = viewer.view.time_unit.as_deref().unwrap_or("s");
    let plot = Plot::new(&panel.name).axes(format!("t in {unit}"), "");
    let plot =
        panel.curves.iter().fold(plot, |plot, curve| plot.line(&curve.name, thinned(viewer, curve, points)));
    let plot = plot.moments("mark", viewer.marks.iter().map(|mark| mark.time));
    let [width, height] = PANEL;
    // One sample is a point of each curve.
    let plot = plot.mark_points(viewer.samples.len() == 1);
    let svg = [height, 2 * height, 4 * height]
        .into_iter()
        .find_map(|height| plot.clone().size(width, height).to_inline_svg().ok())?;
    Some(format!("<figure>{svg}</figure>\n"))
}

/// Points of a curve, at most so many, its extrema among them.
fn thinned<const N: usize>(viewer: &Viewer<'_, N>, curve: &Curve, most: usize) -> Vec<(f64, f64)> {
    let own = &viewer.samples.times;
    let times = curve.values.times.as_deref().unwrap_or(own);
    let less;
    let (times, values) = if curve.values.values.len() > most {
        less = Track::thinned(times, &curve.values.values, most);
        (less.times.as_deref().unwrap_or_default(), &less.values)
    } else {
        (times, &curve.values.values)
    };
    times.iter().map(|t| viewer.samples.start + t).zip(values.iter().copied()).collect()
}
