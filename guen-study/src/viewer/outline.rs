//! The scene as flat outlines: bodies, links, paths and planes as the page's eye sees them, in perspective, the nearest last.

use std::fmt::Write;

use super::page::Space;
use super::shape::{Kind, Pose, difference};
use super::track::{Shown, Track, Turning, between, bounds};
use super::turn::{Turn, norm};
use super::{Ground, LinkKind, Shape, Viewer};
use crate::plot;

/// The size of a picture of the scene, in pixels.
pub(super) const SIZE: [f64; 2] = [640.0, 400.0];

/// Half of the angle that the picture spans from top to bottom, in radians: the page's 38 degrees.
const HALF_ANGLE: f64 = 19.0 * std::f64::consts::PI / 180.0;

/// Corners of a circle.
const CORNERS: usize = 24;

/// The first view: from the motion to the eye, where up is `z`.
const FIRST: [f64; 3] = [-0.75, -1.25, 0.8];

/// The eye that sees the picture.
pub(super) struct Eye {
    place: [f64; 3],
    right: [f64; 3],
    above: [f64; 3],
    ahead: [f64; 3],
    up: [f64; 3],
    center: [f64; 3],
    radius: f64,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn along(from: [f64; 3], direction: [f64; 3], way: f64) -> [f64; 3] {
    std::array::from_fn(|i| from[i] + way * direction[i])
}

fn unit(vector: [f64; 3]) -> [f64; 3] {
    let length = norm(vector);
    vector.map(|e| e / length)
}

impl Eye {
    /// The eye of the page's first view, from which everything is seen.
    pub(super) fn of<const N: usize>(viewer: &Viewer<'_, N>, space: &Space) -> Self {
        fn places<T: Shown>(track: &Track<T>) -> impl Iterator<Item = [f64; 3]> {
            track.values.iter().flat_map(Shown::places)
        }
        let bodies = viewer.bodies.iter().flat_map(|body| places(&body.poses));
        let paths = viewer.paths.iter().flat_map(|path| places(&path.points));
        let links = viewer.links.iter().flat_map(|link| space.drawn(link).1.flatten());
        let (least, most) = bounds(bodies.chain(paths).chain(links));
        let center = std::array::from_fn(|i| least[i] + (most[i] - least[i]) / 2.0);
        let reach = viewer.bodies.iter().flat_map(|body| &body.shapes).map(Shape::reach).fold(0.0, f64::max);
        let radius = (norm(difference(most, least)) / 2.0 + reach).max(1e-9);
        let up = unit(viewer.view.up.unwrap_or([0.0, 0.0, 1.0]));
        let from = unit(viewer.view.from.unwrap_or_else(|| Turn::from_z(up).applied(FIRST)));
        let ahead = from.map(|e| -e);
        let mut right = cross(ahead, up);
        if norm(right) < 1e-6 {
            // From right above or below: as the page has it, with `x` to the right.
            right = Turn::from_z(up).applied([1.0, 0.0, 0.0]);
        }
        let right = unit(right);
        let away = radius * 0.84 / HALF_ANGLE.sin();
        let place = along(center, from, away);
        Self { place, right, above: cross(right, ahead), ahead, up, center, radius }
    }

    /// The point of the picture where a place is, in pixels, and the pixels of a length of one there; nothing if it is not before the eye.
    fn sees(&self, place: [f64; 3]) -> Option<([f64; 2], f64)> {
        let from = difference(place, self.place);
        let depth = dot(from, self.ahead);
        // Nearer than this the picture would be filled by one point.
        if depth < 0.02 * self.radius {
            return None;
        }
        let [width, height] = SIZE;
        let scale = height / 2.0 / HALF_ANGLE.tan() / depth;
        Some((
            [width / 2.0 + scale * dot(from, self.right), height / 2.0 - scale * dot(from, self.above)],
            scale,
        ))
    }

    fn depth(&self, place: [f64; 3]) -> f64 {
        dot(difference(place, self.place), self.ahead)
    }
}

/// The place in a rising list of times: the number of a sample, and the part of the way to the next.
fn locate(times: &[f64], time: f64) -> (usize, f64) {
    let last = times.len() - 1;
    let k = times.partition_point(|t| *t <= time).clamp(1, last.max(1)) - 1;
    let Some(next) = times.get(k + 1) else { return (k, 0.0) };
    (k, ((time - times[k]) / (next - times[k])).clamp(0.0, 1.0))
}

/// Shapes larger than this part of the motion are drawn first: others move on or before them.
const BACKGROUND_PART: f64 = 0.3;

/// Something to be drawn, where it is, how far from the eye, and how large.
struct Part {
    at: [f64; 3],
    depth: f64,
    reach: f64,
    /// The normal of the plane that it lies in.
    normal: [f64; 3],
    svg: String,
}

/// The paths, each with at most so many points.
pub(super) fn thinned<const N: usize>(viewer: &Viewer<'_, N>, points: usize) -> Vec<Track<[f64; 3]>> {
    let own = &viewer.samples.times;
    let times = |track: &Track<_>| track.times.clone().unwrap_or_else(|| own.clone());
    let thin = |track: &Track<[f64; 3]>| Track::thinned(&times(track), &track.values, points.max(8));
    viewer.paths.iter().map(|path| thin(&path.points)).collect()
}

/// The scene at a time, as elements of SVG.
pub(super) fn drawn<const N: usize>(
    viewer: &Viewer<'_, N>,
    space: &Space,
    eye: &Eye,
    paths: &[Track<[f64; 3]>],
    time: f64,
) -> String {
    let own = &viewer.samples.times;
    let [width, height] = SIZE;
    let mut svg = format!("<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n", plot::paper());
    grounds(viewer, space, eye, &mut svg);
    let mut tracks = String::new();
    for (i, whole) in paths.iter().enumerate() {
        let times = whole.times.as_deref().unwrap_or_default();
        let (k, part) = locate(times, time);
        let here = between(whole.values[k], whole.values[(k + 1).min(whole.values.len() - 1)], part);
        let ink = viewer.path_ink(i);
        // The past part of a path is drawn strongly, the future part faintly.
        let done = whole.values[..=k].iter().copied().chain([here]);
        let rest = [here].into_iter().chain(whole.values[k + 1..].iter().copied());
        polyline(eye, rest, &ink, 0.35, &mut tracks);
        polyline(eye, done, &ink, 1.0, &mut tracks);
    }
    let mut parts = Vec::new();
    for (i, body) in viewer.bodies.iter().enumerate() {
        let (k, part) = locate(body.poses.times.as_deref().unwrap_or(own), time);
        let (from, to) = (body.poses.values[k], body.poses.values[(k + 1).min(body.poses.values.len() - 1)]);
        let turn = Turning::new(from.turn, to.turn).at(part);
        let pose = Pose { place: between(from.place, to.place, part), turn };
        for shape in &body.shapes {
            let ink = viewer.body_ink(i, shape.colour);
            parts.extend(solid(eye, &pose, shape, &ink));
        }
    }
    for (i, link) in viewer.links.iter().enumerate() {
        let (k, part) = locate(link.ends.times.as_deref().unwrap_or(own), time);
        let (radius, ends) = space.drawn(link);
        let two: Vec<_> = ends.skip(k).take(2).collect();
        let (Some(first), Some(last)) = (two.first(), two.last()) else { continue };
        let [from, to] = [0, 1].map(|end| between(first[end], last[end], part));
        let ink = viewer.link_ink(i);
        parts.extend(if link.kind == LinkKind::Rod {
            bar(eye, from, to, radius, &ink)
        } else {
            arrow(eye, from, to, radius, &ink)
        });
    }
    parts.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    // A table is below what goes on it, and before what is below it: other shapes are on either side of a large one.
    let (large, small): (Vec<_>, Vec<_>) =
        parts.into_iter().partition(|part| part.reach > BACKGROUND_PART * eye.radius);
    let is_behind = |small: &Part| {
        large.iter().any(|table| {
            let side = |place: [f64; 3]| dot(difference(place, table.at), table.normal);
            side(small.at) * side(eye.place) < 0.0
        })
    };
    let (behind, before): (Vec<_>, Vec<_>) = small.into_iter().partition(is_behind);
    svg.extend(behind.into_iter().chain(large).map(|part| part.svg));
    svg += &tracks;
    svg.extend(before.into_iter().map(|part| part.svg));
    svg
}

fn pairs(points: impl Iterator<Item = [f64; 2]>) -> String {
    let mut text = String::new();
    for [x, y] in points {
        let _ = write!(text, "{}{x:.1},{y:.1}", if text.is_empty() { "" } else { " " });
    }
    text
}

fn polyline(eye: &Eye, places: impl Iterator<Item = [f64; 3]>, ink: &str, opacity: f64, svg: &mut String) {
    let seen: Vec<_> = places.filter_map(|place| eye.sees(place)).map(|(point, _)| point).collect();
    let points = pairs(seen.into_iter());
    let _ = writeln!(
        svg,
        "<polyline points=\"{points}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"1.6\" opacity=\"{opacity}\"/>"
    );
}

fn polygon(points: &[[f64; 2]], ink: &str) -> String {
    format!(
        "<polygon points=\"{}\" fill=\"{ink}\" stroke=\"{}\" stroke-width=\"0.6\"/>\n",
        pairs(points.iter().copied()),
        plot::paper()
    )
}

/// The smallest convex polygon around points (Andrew 1979): its corners in order.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let side =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut found: Vec<[f64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = found[..]
                && side(a, b, point) <= 0.0
            {
                found.pop();
            }
            found.push(point);
        }
        found.pop();
        found
    };
    let mut lower = chain(&mut points.iter().copied());
    lower.extend(chain(&mut points.iter().rev().copied()));
    lower
}

/// A shape of a body, if it is before the eye.
fn solid(eye: &Eye, pose: &Pose, shape: &Shape, ink: &str) -> Option<Part> {
    let world = |local: [f64; 3]| {
        let in_body = along(shape.place, shape.turn.applied(local), 1.0);
        along(pose.place, pose.turn.applied(in_body), 1.0)
    };
    let seen = |local: [f64; 3]| eye.sees(world(local)).map(|(point, _)| point);
    let circle = |radius: f64, z: f64| {
        let angle = |k: usize| k as f64 * std::f64::consts::TAU / CORNERS as f64;
        (0..CORNERS).map(move |k| [radius * angle(k).cos(), radius * angle(k).sin(), z])
    };
    let center = world([0.0; 3]);
    let (at, scale) = eye.sees(center)?;
    let mut depth = eye.depth(center);
    let paper = plot::paper();
    let svg = match shape.kind {
        Kind::Sphere([radius]) => format!(
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{:.1}\" fill=\"{ink}\" stroke=\"{paper}\" stroke-width=\"0.6\"/>\n",
            at[0],
            at[1],
            (scale * radius).max(1.5)
        ),
        Kind::Ring([radius, thickness]) => {
            let rim: Option<Vec<_>> = circle(radius, 0.0).map(seen).collect();
            format!(
                "<polygon points=\"{}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"{:.1}\"/>\n",
                pairs(rim?.into_iter()),
                (scale * thickness).max(1.2)
            )
        }
        Kind::Cylinder([radius, length]) => {
            let ends = [length / 2.0, -length / 2.0].map(|z| (z, eye.depth(world([0.0, 0.0, z]))));
            let all: Option<Vec<_>> = ends.iter().flat_map(|(z, _)| circle(radius, *z)).map(seen).collect();
            // The end that faces the eye, with a line from its centre to its rim.
            let facing = if ends[0].1 < ends[1].1 { ends[0].0 } else { ends[1].0 };
            let rim: Option<Vec<_>> = circle(radius, facing).map(seen).collect();
            let mark = pairs([seen([0.0, 0.0, facing])?, seen([radius, 0.0, facing])?].into_iter());
            format!(
                "{}<polygon points=\"{}\" fill=\"none\" stroke=\"{paper}\" stroke-width=\"0.8\"/>\n<polyline points=\"{mark}\" stroke=\"{paper}\" stroke-width=\"1.5\"/>\n",
                polygon(&hull(all?), ink),
                pairs(rim?.into_iter())
            )
        }
        Kind::Cuboid(edges) => {
            let half = edges.map(|e| e / 2.0);
            let mut faces = String::new();
            for axis in 0..3 {
                let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |side: f64, i: f64, j: f64| {
                    let mut place = [0.0; 3];
                    (place[axis], place[a], place[b]) = (side * half[axis], i * half[a], j * half[b]);
                    place
                };
                // Of two opposite faces, one looks at the eye at most.
                for side in [1.0, -1.0] {
                    let middle = world(corner(side, 0.0, 0.0));
                    let normal = difference(middle, center);
                    if dot(normal, difference(eye.place, middle)) > 0.0 {
                        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
                        let face: Option<Vec<_>> =
                            corners.map(|(i, j)| seen(corner(side, i, j))).into_iter().collect();
                        faces += &polygon(&face?, ink);
                    }
                }
            }
            faces
        }
        Kind::Arrow([length, radius]) => {
            let part = arrow(eye, center, world([0.0, 0.0, length]), radius, ink)?;
            depth = part.depth;
            part.svg
        }
    };
    let thin = match shape.kind {
        Kind::Cuboid([a, b, c]) if a < b.min(c) => [1.0, 0.0, 0.0],
        Kind::Cuboid([a, b, c]) if b < a.min(c) => [0.0, 1.0, 0.0],
        Kind::Sphere(_) | Kind::Arrow(_) => [0.0; 3],
        Kind::Cuboid(_) | Kind::Cylinder(_) | Kind::Ring(_) => [0.0, 0.0, 1.0],
    };
    Some(Part { at: center, depth, reach: shape.reach(), normal: difference(world(thin), center), svg })
}

/// A straight bar.
fn bar(eye: &Eye, from: [f64; 3], to: [f64; 3], radius: f64, ink: &str) -> Option<Part> {
    let middle = between(from, to, 0.5);
    let (_, scale) = eye.sees(middle)?;
    let ends = pairs([eye.sees(from)?.0, eye.sees(to)?.0].into_iter());
    let width = (2.0 * scale * radius).max(1.2);
    let svg = format!("<polyline points=\"{ends}\" stroke=\"{ink}\" stroke-width=\"{width:.1}\"/>\n");
    Some(Part { at: middle, depth: eye.depth(middle), reach: 0.0, normal: [0.0; 3], svg })
}

/// An arrow: a bar, and a head that points where it leads in the picture.
fn arrow(eye: &Eye, from: [f64; 3], to: [f64; 3], radius: f64, ink: &str) -> Option<Part> {
    let (_, scale) = eye.sees(to)?;
    let ([x, y], [p, q]) = (eye.sees(from)?.0, eye.sees(to)?.0);
    let length = (p - x).hypot(q - y);
    let shaft = bar(eye, from, to, radius, ink)?;
    if length < 1.0 {
        return Some(shaft);
    }
    let width = (2.6 * scale * radius).max(3.0);
    let [ahead_x, ahead_y] = [(p - x) / length, (q - y) / length];
    let back = (2.5 * width).min(length);
    let [base_x, base_y] = [p - back * ahead_x, q - back * ahead_y];
    let head = [
        [p, q],
        [base_x - width * ahead_y, base_y + width * ahead_x],
        [base_x + width * ahead_y, base_y - width * ahead_x],
    ];
    Some(Part { svg: shaft.svg + &polygon(&head, ink), ..shaft })
}

/// 1, 2 or 5 times a power of ten, not above a length.
fn round_length(length: f64) -> f64 {
    let power = 10.0_f64.powf(length.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|step| *step <= length).unwrap_or(power)
}

/// Grids of the grounds; the level one if there is none and the motion stays above it, as on the page.
fn grounds<const N: usize>(viewer: &Viewer<'_, N>, space: &Space, eye: &Eye, svg: &mut String) {
    let mut grid = |places: &mut dyn Iterator<Item = [f64; 3]>| {
        let points: Vec<_> = places.filter_map(|place| eye.sees(place)).map(|(point, _)| point).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\"/>",
            pairs(points.into_iter()),
            plot::grid()
        );
    };
    let mut plane = |point: [f64; 3], normal: [f64; 3]| {
        let half = 1.2 * eye.radius;
        let square = round_length(half / 4.0);
        let count = (half / square).ceil();
        let turn = Turn::from_z(normal);
        let [i, j] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|axis| turn.applied(axis));
        let from = difference(eye.center, point);
        // Below the middle of the motion, on whole squares of the plane.
        let snapped = |axis: [f64; 3]| (dot(from, axis) / square).round() * square;
        let base = along(along(point, i, snapped(i)), j, snapped(j));
        let place = |a: f64, b: f64| along(along(base, i, a * square), j, b * square);
        let mut line = -count;
        while line <= count {
            grid(&mut [place(line, -count), place(line, count)].into_iter());
            grid(&mut [place(-count, line), place(count, line)].into_iter());
            line += 1.0;
        }
    };
    for ground in &viewer.grounds {
        if let Ground::Plane { point, normal } = ground {
            plane(*point, *normal);
        }
    }
    let places = viewer.bodies.iter().flat_map(|body| body.poses.values.iter().map(|pose| pose.place));
    let places = places.chain(viewer.paths.iter().flat_map(|path| path.points.values.iter().copied()));
    let lowest = places.map(|place| dot(place, eye.up)).fold(0.0, f64::min);
    if viewer.grounds.is_empty()
        && !viewer.view.bare
        && space.origin.is_none()
        && lowest >= -0.02 * eye.radius
    {
        plane([0.0; 3], eye.up);
    }
    for ground in &viewer.grounds {
        let Ground::Surface { x, y, heights } = ground else { continue };
        let mesh = super::page::MESH;
        let at = |[from, to]: [f64; 2], k: usize| from + (to - from) * k as f64 / (mesh - 1) as f64;
        let place = |i: usize, j: usize| [at(*x, i), at(*y, j), heights[j * mesh + i]];
        for line in (0..mesh).step_by(8) {
            grid(&mut (0..mesh).step_by(2).map(|k| place(line, k)));
            grid(&mut (0..mesh).step_by(2).map(|k| place(k, line)));
        }
    }
}
