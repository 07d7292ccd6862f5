//! A recorded run as one HTML file that plays it: bodies in space, their paths, and curves beside them.
//!
//! `shape` says what a body looks like and where it is, `equivalent` draws declared bodies by their inertia, `data` writes
//! numbers, `page` puts the file together from `page/` and from the drawing library in `vendor/`.

mod data;
mod equivalent;
mod page;
mod shape;
#[cfg(test)]
mod tests;
mod turn;

use std::path::Path;

use guen_runtime::{Bodies, Monitored};

use crate::error::StudyError;
use crate::file::replace_file;
use crate::recording::Recording;

pub use shape::{Pose, Shape};

/// The samples of a recording that are exported unless more are asked for: a minute at 60 pictures per second.
pub(crate) const MOST_SAMPLES: usize = 3600;

/// Bodies without a size of their own, as a part of the space that their centres take up.
const SMALL: f64 = 0.04;

/// A recorded run for a page that plays it, in a browser and without network.
///
/// Everything is evaluated at the samples of the recording while the page is described; the page interpolates between
/// them, places linearly and orientations along the shortest turn. So record densely enough, by
/// [`sample`](guen_runtime::steppers::Integration::sample) for instance: a wheel that turns by more than half a turn
/// between samples seems to turn otherwise, and the page says so where it is more than a quarter.
///
/// ```
/// use guen_runtime::{from_fn, steppers::Dop853};
/// use guen_study::{Pose, Recording, Shape, Viewer};
///
/// // A pendulum of length 1 m that hangs 1.5 m above the ground.
/// let pendulum = from_fn(|_t: f64, &[angle, rate]: &[f64; 2]| [rate, -9.81 * angle.sin()]);
/// let mut recording = Recording::new(&["angle", "rate"]);
/// let times: Vec<f64> = (0..=600).map(|k| f64::from(k) / 60.0).collect();
/// Dop853::new(1e-10, 1e-10).sample(&pendulum, 0.0, &[1.0, 0.0], &times, recording.visit()).unwrap();
///
/// let swing = |_t: f64, &[angle, _]: &[f64; 2]| Pose::at([0.0, 0.0, 1.5]).turned([0.0, 1.0, 0.0], -angle);
/// let bob = [0.0, 0.0, -1.0];
/// let path = std::env::temp_dir().join("guen-study-example").join("pendulum.html");
/// Viewer::new("Pendulum", &recording)
///     .body("pendulum", [Shape::rod([0.0; 3], bob, 0.01), Shape::sphere(0.08).at(bob)], swing)
///     .path("bob", |_t, &[angle, _]| [angle.sin(), 0.0, 1.5 - angle.cos()])
///     .panel("angle in rad")
///     .curve("angle", |_t, state| state[0])
///     .write(path)?;
/// # Ok::<(), guen_study::StudyError>(())
/// ```
///
/// # The page
///
/// Space bar or button plays and pauses; the slider, a click into a curve and the arrow keys set the time; the mouse or
/// one finger turns the view, the wheel or two fingers come nearer. `1 x` is the motion's own pace.
///
/// # Size
///
/// 0.6 MB of drawing library (three.js), and for each sample 37 bytes a body, 16 a path and 6 a curve. Of a recording with
/// more than 3600 samples as many are taken, evenly in time; [`thinned`](Viewer::thinned) chooses another number.
#[derive(Clone, Debug)]
#[must_use = "a viewer is a description: `write` or `to_html` makes the page"]
pub struct Viewer<'a, const N: usize> {
    title: String,
    samples: Vec<(f64, &'a [f64; N])>,
    bodies: Vec<MovingBody>,
    paths: Vec<MovingPoint>,
    links: Vec<Link>,
    panels: Vec<Panel>,
    grounds: Vec<Ground>,
    view: View,
    /// The first thing that cannot be drawn.
    fault: Option<Fault>,
}

#[derive(Clone, Debug)]
struct MovingBody {
    name: String,
    shapes: Vec<Shape>,
    poses: Vec<Pose>,
}

#[derive(Clone, Debug)]
struct MovingPoint {
    name: String,
    points: Vec<[f64; 3]>,
}

/// Something straight between two moving points.
#[derive(Clone, Debug)]
struct Link {
    name: String,
    is_arrow: bool,
    radius: f64,
    ends: Vec<[[f64; 3]; 2]>,
}

#[derive(Clone, Debug)]
struct Panel {
    name: String,
    curves: Vec<Curve>,
}

#[derive(Clone, Debug)]
struct Curve {
    name: String,
    values: Vec<f64>,
}

/// The ground that the bodies move on.
#[derive(Clone, Debug)]
enum Ground {
    Plane { point: [f64; 3], normal: [f64; 3] },
    Surface { x: [f64; 2], y: [f64; 2], heights: Vec<f64> },
}

#[derive(Clone, Debug, Default)]
struct View {
    up: Option<[f64; 3]>,
    from: Option<[f64; 3]>,
    follow: Option<String>,
    bare: bool,
}

/// A fault of the description; the page is refused with the first one.
#[derive(Clone, Debug)]
enum Fault {
    NotDrawable { what: String, time: f64 },
    UnknownBody { name: String },
}

/// Single precision and the squares of lengths have to hold it.
const FAR: f64 = 1e18;

fn is_drawable(values: &[f64]) -> bool {
    values.iter().all(|value| value.abs() <= FAR)
}

fn is_direction(vector: [f64; 3]) -> bool {
    is_drawable(&vector) && turn::norm(vector) > 0.0
}

impl<'a, const N: usize> Viewer<'a, N> {
    /// A page with a title for a recorded run, with nothing to see yet.
    pub fn new(title: impl Into<String>, recording: &'a Recording<N>) -> Self {
        Self::thinned(title, recording, MOST_SAMPLES)
    }

    /// Makes a page with at most so many samples of the recording, evenly in time; at least two.
    pub fn thinned(title: impl Into<String>, recording: &'a Recording<N>, samples: usize) -> Self {
        let mut chosen: Vec<_> = if recording.len() <= samples {
            recording.iter().collect()
        } else {
            recording.spread(samples.max(2)).collect()
        };
        // A run backwards in time is shown forwards.
        if let ([(first, _), ..], [.., (last, _)]) = (&chosen[..], &chosen[..])
            && last < first
        {
            chosen.reverse();
        }
        Self {
            title: title.into(),
            samples: chosen,
            bodies: Vec::new(),
            paths: Vec::new(),
            links: Vec::new(),
            panels: Vec::new(),
            grounds: Vec::new(),
            view: View::default(),
            fault: None,
        }
    }

    /// Values at all samples; the first one that cannot be drawn is remembered.
    fn sampled<T>(
        &mut self,
        what: &str,
        mut value: impl FnMut(f64, &[f64; N]) -> T,
        is_sound: impl Fn(&T) -> bool,
    ) -> Vec<T> {
        let values: Vec<T> = self.samples.iter().map(|(t, state)| value(*t, state)).collect();
        if let Some(k) = values.iter().position(|value| !is_sound(value)) {
            let time = self.samples[k].0;
            self.fault.get_or_insert_with(|| Fault::NotDrawable { what: what.to_owned(), time });
        }
        values
    }

    /// Remembers what is wrong from the start.
    fn require(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            let time = self.samples.first().map_or(0.0, |(t, _)| *t);
            self.fault.get_or_insert_with(|| Fault::NotDrawable { what: what(), time });
        }
    }

    fn unknown(&mut self, name: &str) {
        self.fault.get_or_insert_with(|| Fault::UnknownBody { name: name.to_owned() });
    }

    /// A body, drawn as these shapes, where the function says.
    pub fn body(
        mut self,
        name: impl Into<String>,
        shapes: impl IntoIterator<Item = Shape>,
        pose: impl FnMut(f64, &[f64; N]) -> Pose,
    ) -> Self {
        let name = name.into();
        let poses = self.sampled(&name, pose, Pose::is_drawable);
        let shapes: Vec<Shape> = shapes.into_iter().collect();
        self.check_shapes(&name, &shapes);
        self.bodies.push(MovingBody { name, shapes, poses });
        self
    }

    fn check_shapes(&mut self, name: &str, shapes: &[Shape]) {
        self.require(shapes.iter().all(Shape::is_drawable), || format!("a shape of {name}"));
    }

    /// The bodies and particles that the system declares, where its equations of motion have them.
    ///
    /// Each is drawn as the homogeneous ball, cylinder, disc, rod or box that has its mass and inertia: homogeneous bodies
    /// look like themselves, a chassis like a box of its proportions. [`drawn`](Viewer::drawn) puts other shapes in place.
    /// A body without a center is left out if another one has a place; if none has, as a top about its fixed point, all are
    /// at the origin.
    ///
    /// ```
    /// use guen_runtime::{Bodies, Body};
    /// use guen_study::{Recording, Viewer};
    ///
    /// /// A ball on a line: what the macro generates for a declared body.
    /// struct Ball;
    /// impl Bodies<f64, 1, 1> for Ball {
    ///     fn bodies(&self, _t: f64, &[x]: &[f64; 1]) -> [Body; 1] {
    ///         let inertia = Some([0.004, 0.004, 0.004, 0.0, 0.0, 0.0]);
    ///         [Body { name: "ball", mass: Some(1.0), inertia, center: Some([x, 0.0, 0.1]), orientation: None }]
    ///     }
    /// }
    /// let mut recording = Recording::new(&["x"]);
    /// for k in 0..100 {
    ///     recording.record(0.1 * f64::from(k), &[f64::from(k)]);
    /// }
    /// let page = Viewer::new("Ball", &recording).bodies(&Ball).to_html()?;
    /// assert!(page.contains(r#""name":"ball""#) && page.contains(r#""kind":"sphere","lengths":[0.1"#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn bodies<S, const B: usize>(mut self, system: &S) -> Self
    where
        S: Bodies<f64, N, B> + ?Sized,
    {
        let all: Vec<_> = self.samples.iter().map(|(t, state)| system.bodies(*t, state)).collect();
        let Some(first) = all.first() else { return self };
        let small = SMALL * extent(all.iter().flatten().filter_map(|body| body.center));
        let placed = first.iter().any(|body| body.center.is_some());
        for (i, body) in first.iter().enumerate() {
            if body.center.is_none() && (placed || body.orientation.is_none()) {
                continue;
            }
            let shape = equivalent::drawing(body, small);
            let mut moments = all.iter().map(|bodies| &bodies[i]);
            let pose = |_t: f64, _: &[f64; N]| {
                let body = moments.next().unwrap_or(&first[i]);
                let center = body.center.unwrap_or_default();
                match &body.orientation {
                    Some(matrix) => Pose::oriented(center, matrix),
                    None => Pose::at(center),
                }
            };
            self = self.body(body.name, [shape], pose);
        }
        self
    }

    /// Other shapes for the bodies with this name; none make them disappear. A name that no body has is an error when the
    /// page is made.
    pub fn drawn(mut self, name: &str, shapes: impl IntoIterator<Item = Shape>) -> Self {
        let shapes: Vec<Shape> = shapes.into_iter().collect();
        self.check_shapes(name, &shapes);
        let mut known = false;
        for body in self.bodies.iter_mut().filter(|body| body.name == name) {
            body.shapes.clone_from(&shapes);
            known = true;
        }
        if !known {
            self.unknown(name);
        }
        self
    }

    /// The track of a point, such as a contact: drawn up to the time that is shown, and faintly to its end.
    pub fn path(mut self, name: impl Into<String>, point: impl FnMut(f64, &[f64; N]) -> [f64; 3]) -> Self {
        let name = name.into();
        let points = self.sampled(&name, point, |point| is_drawable(point));
        self.paths.push(MovingPoint { name, points });
        self
    }

    /// A round bar between two moving points.
    pub fn rod(
        self,
        name: impl Into<String>,
        radius: f64,
        ends: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        self.link(name.into(), false, radius, ends)
    }

    /// An arrow from a moving point, such as a force at a contact: its foot, and the vector in lengths of the motion.
    pub fn arrow(
        self,
        name: impl Into<String>,
        radius: f64,
        mut foot_and_vector: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        self.link(name.into(), true, radius, move |t, state| {
            let [foot, vector] = foot_and_vector(t, state);
            [foot, std::array::from_fn(|i| foot[i] + vector[i])]
        })
    }

    fn link(
        mut self,
        name: String,
        is_arrow: bool,
        radius: f64,
        ends: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        let ends = self.sampled(&name, ends, |ends| is_drawable(ends.as_flattened()));
        self.require(is_drawable(&[radius]), || format!("the radius of {name}"));
        self.links.push(Link { name, is_arrow, radius, ends });
        self
    }

    /// A panel for the curves that follow, with a heading such as `angles in rad`.
    pub fn panel(mut self, name: impl Into<String>) -> Self {
        self.panels.push(Panel { name: name.into(), curves: Vec::new() });
        self
    }

    /// A curve over time in the last panel; in one of its own if there is none yet.
    pub fn curve(mut self, name: impl Into<String>, value: impl FnMut(f64, &[f64; N]) -> f64) -> Self {
        let name = name.into();
        let values = self.sampled(&name, value, |value| is_drawable(&[*value]));
        if self.panels.is_empty() {
            self = self.panel(name.clone());
        }
        if let Some(panel) = self.panels.last_mut() {
            panel.curves.push(Curve { name, values });
        }
        self
    }

    /// Panels with the energy, with its change since the start, and with the largest residual of the constraints on
    /// positions.
    pub fn monitored<S>(self, system: &S) -> Self
    where
        S: Monitored<f64, N> + ?Sized,
    {
        let start = self.samples.first().map_or(0.0, |(t, state)| system.energy(*t, state));
        self.panel("energy")
            .curve("h", |t, state| system.energy(t, state))
            .panel("energy since the start")
            .curve("h - h(0)", |t, state| system.energy(t, state) - start)
            .panel("residual of the constraints")
            .curve("largest", |t, state| system.residual(t, state))
    }

    /// A plane through a point, in place of the level ground at height zero.
    pub fn plane(mut self, point: [f64; 3], normal: [f64; 3]) -> Self {
        self.grounds.push(Ground::Plane { point, normal });
        self.require(is_drawable(&point) && is_direction(normal), || "the ground".to_owned());
        self
    }

    /// A surface `z = height(x, y)` over a rectangle, in place of the level ground.
    pub fn surface(mut self, x: [f64; 2], y: [f64; 2], height: impl Fn(f64, f64) -> f64) -> Self {
        let at = |[from, to]: [f64; 2], k: usize| from + (to - from) * k as f64 / (page::MESH - 1) as f64;
        let heights: Vec<f64> = (0..page::MESH * page::MESH)
            .map(|k| height(at(x, k % page::MESH), at(y, k / page::MESH)))
            .collect();
        self.require([&heights[..], &x, &y].into_iter().all(is_drawable), || "the ground".to_owned());
        self.grounds.push(Ground::Surface { x, y, heights });
        self
    }

    /// No ground at all: for mechanisms and bodies in free space.
    pub fn without_ground(mut self) -> Self {
        self.view.bare = true;
        self
    }

    /// Sets the direction that is up in the picture; `z` unless told. The level ground is normal to it.
    pub fn upward(mut self, direction: [f64; 3]) -> Self {
        self.view.up = Some(direction);
        self.require(is_direction(direction), || "a direction of the view".to_owned());
        self
    }

    /// Sets the direction from which the motion is seen at first: from the motion to the eye.
    pub fn seen_from(mut self, direction: [f64; 3]) -> Self {
        self.view.from = Some(direction);
        self.require(is_direction(direction), || "a direction of the view".to_owned());
        self
    }

    /// The body that the view follows when asked to; the first one unless told. The page starts so, and a button changes it.
    pub fn follow(mut self, name: impl Into<String>) -> Self {
        let name = name.into();
        if !self.bodies.iter().any(|body| body.name == name) {
            self.unknown(&name);
        }
        self.view.follow = Some(name);
        self
    }

    /// The page as text.
    ///
    /// # Errors
    ///
    /// [`NothingToDraw`](StudyError::NothingToDraw) for fewer than two samples, or without body, path, link or curve;
    /// [`Times`](StudyError::Times) if the times do not rise or fall throughout; [`NotDrawable`](StudyError::NotDrawable)
    /// with what it was and when, for a value that is not finite or beyond `1e18`, or an orientation that is none;
    /// [`UnknownBody`](StudyError::UnknownBody) for a name that no body has.
    pub fn to_html(&self) -> Result<String, StudyError> {
        page::html(self)
    }

    /// Writes the page to a file, whole or not at all: see [`replace_file`].
    ///
    /// # Errors
    ///
    /// Those of [`to_html`](Viewer::to_html), and [`StudyError::Io`] with the path.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        let text = self.to_html()?;
        replace_file(path, |out| out.write_all(text.as_bytes()))
    }
}

/// The longest side of the box that points take up; one if there is none.
fn extent(points: impl Iterator<Item = [f64; 3]>) -> f64 {
    let none = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let (least, most) = points.fold(none, |(least, most), p| {
        (std::array::from_fn(|i| f64::min(least[i], p[i])), std::array::from_fn(|i| f64::max(most[i], p[i])))
    });
    let longest = shape::difference(most, least).into_iter().fold(0.0, f64::max);
    if longest > 0.0 && longest.is_finite() { longest } else { 1.0 }
}
