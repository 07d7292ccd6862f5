//! The HTML file: its parts in order, with the motion as data.

use super::data::{Json, escaped};
use super::turn::Turn;
use super::{Fault, Ground, MovingBody, Viewer, is_drawable};
use crate::error::StudyError;

/// Points of a surface in each direction.
pub(super) const MESH: usize = 65;

/// The drawing library, as it is described in `vendor/README.md`.
const LIBRARY: &str = include_str!("vendor/three.min.js");

/// The page's own style and program, in the order in which they are needed.
const STYLE: &str = include_str!("page/style.css");
const BODY: &str = include_str!("page/body.html");
const PROGRAM: [&str; 7] = [
    include_str!("page/motion.js"),
    include_str!("page/solids.js"),
    include_str!("page/ground.js"),
    include_str!("page/stage.js"),
    include_str!("page/curves.js"),
    include_str!("page/player.js"),
    include_str!("page/start.js"),
];

/// The browser is asked to refuse what the page does not do: it loads nothing from anywhere.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

pub(super) fn html<const N: usize>(viewer: &Viewer<'_, N>) -> Result<String, StudyError> {
    check(viewer)?;
    let title = escaped(&viewer.title);
    let motion = motion(viewer);
    Ok([
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n",
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n",
        "<meta name=\"color-scheme\" content=\"light dark\">\n",
        "<link rel=\"icon\" href=\"data:,\">\n",
        "<meta http-equiv=\"Content-Security-Policy\" content=\"",
        POLICY,
        "\">\n<title>",
        &title,
        "</title>\n<style>\n",
        STYLE,
        "</style>\n</head>\n<body>\n",
        BODY,
        "<script type=\"application/json\" id=\"motion\">",
        &motion,
        "</script>\n<script>\n",
        LIBRARY,
        "</script>\n<script>\n\"use strict\";\n(() => {\n",
        &PROGRAM.concat(),
        "})();\n</script>\n</body>\n</html>\n",
    ]
    .concat())
}

fn check<const N: usize>(viewer: &Viewer<'_, N>) -> Result<(), StudyError> {
    let title = || viewer.title.clone();
    let curves = viewer.panels.iter().map(|panel| panel.curves.len()).sum::<usize>();
    let things = viewer.bodies.len() + viewer.paths.len() + viewer.links.len() + curves;
    if viewer.samples.len() < 2 || things == 0 {
        return Err(StudyError::NothingToDraw { title: title() });
    }
    let times = || viewer.samples.iter().map(|(t, _)| *t);
    if let Some(time) = times().find(|t| !is_drawable(&[*t])) {
        return Err(StudyError::Times { title: title(), time });
    }
    if let Some((_, time)) = times().zip(times().skip(1)).find(|(before, after)| after <= before) {
        return Err(StudyError::Times { title: title(), time });
    }
    match viewer.fault.clone() {
        None => Ok(()),
        Some(Fault::NotDrawable { what, time }) => {
            Err(StudyError::NotDrawable { title: title(), what, time })
        }
        Some(Fault::UnknownBody { name }) => Err(StudyError::UnknownBody { title: title(), name }),
    }
}

/// Everything that the page shows, as JSON; `page/motion.js` reads it.
fn motion<const N: usize>(viewer: &Viewer<'_, N>) -> String {
    let mut json = Json::default();
    let start = viewer.samples[0].0;
    json.object(|json| {
        json.text("title", &viewer.title);
        json.number("start", start);
        json.samples("times", viewer.samples.iter().map(|(t, _)| t - start));
        json.number("largestTurn", viewer.bodies.iter().map(largest_turn).fold(0.0, f64::max));
        json.objects("bodies", &viewer.bodies, |json, body| {
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
            json.samples("poses", poses(body));
        });
        json.objects("paths", &viewer.paths, |json, path| {
            json.text("name", &path.name);
            json.samples("points", path.points.iter().flatten().copied());
        });
        json.objects("links", &viewer.links, |json, link| {
            json.text("name", &link.name);
            json.text("kind", if link.is_arrow { "arrow" } else { "rod" });
            json.number("radius", link.radius);
            json.samples("ends", link.ends.iter().flatten().flatten().copied());
        });
        json.objects("panels", &viewer.panels, |json, panel| {
            json.text("name", &panel.name);
            json.objects("curves", &panel.curves, |json, curve| {
                json.text("name", &curve.name);
                json.samples("values", curve.values.iter().copied());
            });
        });
        json.objects("grounds", &viewer.grounds, |json, ground| match ground {
            Ground::Plane { point, normal } => {
                json.text("kind", "plane");
                json.numbers("point", point);
                json.numbers("normal", normal);
            }
            Ground::Surface { x, y, heights } => {
                json.text("kind", "surface");
                json.numbers("x", x);
                json.numbers("y", y);
                json.number("mesh", MESH as f64);
                json.samples("heights", heights.iter().copied());
            }
        });
        json.number("bare", f64::from(u8::from(viewer.view.bare)));
        json.numbers("up", &viewer.view.up.unwrap_or([0.0, 0.0, 1.0]));
        if let Some(from) = viewer.view.from {
            json.numbers("from", &from);
        }
        if let Some(name) = &viewer.view.follow {
            json.text("follow", name);
        }
    });
    json.into_text()
}

/// Returns for each sample the place and the quaternion `x, y, z, w`, as the drawing library orders it.
fn poses(body: &MovingBody) -> impl Iterator<Item = f64> {
    body.poses.iter().flat_map(|pose| {
        let ([x, y, z], [w, i, j, k]) = (pose.place, pose.turn.normalized().0);
        [x, y, z, i, j, k, w]
    })
}

/// The largest angle between successive samples, as far as they tell.
fn largest_turn(body: &MovingBody) -> f64 {
    let turns = body.poses.iter().map(|pose| pose.turn.normalized());
    let next = turns.clone().skip(1);
    turns.zip(next).map(|(a, b): (Turn, Turn)| 2.0 * a.nearness(b).min(1.0).acos()).fold(0.0, f64::max)
}
