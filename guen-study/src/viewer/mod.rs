//! A recorded run as one HTML file that plays it: bodies in space, their paths, and curves beside them.
//!
//! `shape` says what a body looks like and where it is, `equivalent` draws declared bodies by their inertia. `samples` makes
//! `track`s of a recording, of which `thin` chooses what is shown and `fit` makes the file as small as it has to be, `guests` are further recordings. `data`
//! writes numbers, `phases` has marks and words, `contacts` the forces of contacts, `things` the types of all that is shown, `view` the ground and the view, `notes` says what was left out, `still` draws pictures for readers without scripts by `outline`, `page` puts the file together from `page/` and from the drawing library in
//! `vendor/`.

mod contacts;
mod content;
mod data;
mod drawable;
mod equivalent;
mod fit;
mod guests;
mod notes;
mod outline;
mod page;
mod phases;
mod samples;
mod shape;
mod still;
#[cfg(test)]
mod tests;
mod thin;
mod things;
mod track;
mod turn;
mod view;

use std::path::Path;

use guen_runtime::{Bodies, Body};

use crate::error::StudyError;
use crate::file::replace_file;
use crate::plot;
use crate::recording::Recording;

use drawable::is_drawable;
use guests::Guest;
use phases::{Mark, Words};
use samples::Samples;
use things::{Curve, Fault, Link, LinkKind, MovingBody, MovingPoint, Panel};
use track::{Shown, Track};
use view::{Ground, View};

pub use contacts::ContactFrame;
pub use shape::{Pose, Shape};

/// Recordings with at most so many samples are shown as they are: a minute at 60 pictures per second.
pub(crate) const MOST_SAMPLES: usize = 3600;

/// The most samples of a body, path or curve that are kept of a longer recording.
const MOST_KEPT: usize = 1 << 16;

/// The size of a file, in bytes, unless another one is asked for.
const MOST_BYTES: usize = 64_000_000;

/// The size of a file with all samples, in bytes, unless another one is asked for: what browsers open.
const MOST_BYTES_COMPLETE: usize = 1_000_000_000;

/// Memory for the places of declared bodies at all samples, of so many bodies at a time as it allows.
const BODIES_AT_ONCE: usize = 1 << 29;

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
/// one finger turns the view, the wheel or two fingers come nearer. A motion of 1 to 600 s is played at its own pace, `1 x`; what is
/// shorter or longer takes 20 to 50 seconds.
///
/// # Which samples are shown
///
/// All of them, of a recording with at most 3600. Of a longer one, however long, each body, path and curve keeps those that the
/// eye needs:
///
/// - a body or path those without which it would be drawn elsewhere by more than 1/4000 of its way, or turned by more than
///   0.01 rad;
/// - a curve every minimum and maximum, and what lies between to 1/2000 of its range; if it has more than 65,536 of them, the
///   least and the greatest value of each of 16,384 equal parts of the time.
///
/// The page says how many of how many samples are shown, and how near they are. [`thinned`](Viewer::thinned) keeps fewer,
/// [`complete`](Viewer::complete) keeps all.
///
/// # Size
///
/// At most 64 MB, or what [`within_bytes`](Viewer::within_bytes) says: where the samples above need more, fewer are kept.
/// 0.6 MB of it are the drawing library (three.js). A sample takes 37 bytes for a body, 16 for a path and 6 for a curve, and 11
/// more for its time if the recording is a long one.
///
/// # Precision
///
/// Numbers are in single precision on the page, times in double. Where a motion is so far from the origin that single
/// precision would show, an origin in its middle is subtracted before rounding, and the page says which.
#[derive(Clone, Debug)]
#[must_use = "a viewer is a description: `write` or `to_html` makes the page"]
pub struct Viewer<'a, const N: usize> {
    title: String,
    /// The name of this run beside others; its title unless told.
    name: Option<String>,
    samples: Samples<'a, N>,
    /// The largest size of the file.
    limit: usize,
    bodies: Vec<MovingBody>,
    paths: Vec<MovingPoint>,
    links: Vec<Link>,
    panels: Vec<Panel>,
    marks: Vec<Mark>,
    words: Vec<Words>,
    guests: Vec<Guest>,
    grounds: Vec<Ground>,
    view: View,
    /// The first thing that cannot be drawn.
    fault: Option<Fault>,
}

impl<'a, const N: usize> Viewer<'a, N> {
    /// A page with a title for a recorded run, with nothing to see yet.
    pub fn new(title: impl Into<String>, recording: &'a Recording<N>) -> Self {
        let bounds = (MOST_SAMPLES, MOST_KEPT);
        Self::of(title.into(), Samples::new(recording, Some(bounds)), MOST_BYTES)
    }

    /// Makes a page with at most so many samples of each body, path and curve; at least four. The samples are those that the
    /// eye needs most, not the same for all.
    pub fn thinned(title: impl Into<String>, recording: &'a Recording<N>, samples: usize) -> Self {
        let bounds = (samples.max(4), samples.max(4));
        Self::of(title.into(), Samples::new(recording, Some(bounds)), MOST_BYTES)
    }

    /// Makes a page with every sample of the recording, as binary data that a browser reads in seconds: a million samples of
    /// a body have 37 MB. At most 1 GB, or what [`within_bytes`](Viewer::within_bytes) says right after this call.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// for k in 0..20_000 {
    ///     recording.record(f64::from(k), &[f64::from(k * k % 1999)]);
    /// }
    /// let all = Viewer::complete("All", &recording).curve("x", |_, x| x[0]).to_html()?;
    /// let few = Viewer::thinned("Few", &recording, 1000).curve("x", |_, x| x[0]).to_html()?;
    /// assert!(few.contains("of 20000 samples") && !all.contains("of 20000 samples"));
    /// assert!(all.len() > few.len() + 80_000);
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn complete(title: impl Into<String>, recording: &'a Recording<N>) -> Self {
        Self::of(title.into(), Samples::new(recording, None), MOST_BYTES_COMPLETE)
    }

    fn of(title: String, samples: Samples<'a, N>, limit: usize) -> Self {
        Self {
            title,
            name: None,
            samples,
            limit,
            bodies: Vec::new(),
            paths: Vec::new(),
            links: Vec::new(),
            panels: Vec::new(),
            marks: Vec::new(),
            words: Vec::new(),
            guests: Vec::new(),
            grounds: Vec::new(),
            view: View::default(),
            fault: None,
        }
    }

    /// Sets the largest size of the file, in place of 64 MB. Fewer samples are shown where it is small; a size that does not
    /// even hold the page without them is an error when the page is made.
    ///
    /// ```
    /// use guen_study::{Recording, StudyError, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// for k in 0..200_000 {
    ///     recording.record(f64::from(k), &[f64::from(k * 7 % 1999)]);
    /// }
    /// let page = Viewer::new("Small", &recording).curve("x", |_, x| x[0]).within_bytes(700_000);
    /// assert!(page.to_html()?.len() <= 700_000);
    /// assert!(matches!(page.within_bytes(1000).to_html(), Err(StudyError::TooLarge { .. })));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn within_bytes(mut self, bytes: usize) -> Self {
        self.limit = bytes;
        self
    }

    /// Whether values are of use: the page is refused for its times or for its size otherwise.
    fn is_evaluated<T: Shown>(&mut self) -> bool {
        if self.samples.len() == 0 || self.samples.disorder.is_some() {
            return false;
        }
        let more = self.samples.len().saturating_mul(4 * T::WIDTH).saturating_mul(4) / 3;
        let bytes = fit::data_bytes(self).saturating_add(more);
        let fits = self.samples.most.is_some() || self.samples.len() <= MOST_SAMPLES || bytes <= self.limit;
        if !fits {
            self.fault.get_or_insert(Fault::TooLarge { bytes });
        }
        fits
    }

    /// A track of values at all samples; the first one that cannot be drawn is remembered.
    fn sampled<T: Shown + Default + Clone>(
        &mut self,
        what: &str,
        mut value: impl FnMut(f64, &[f64; N]) -> T,
        is_sound: impl Fn(&T) -> bool,
    ) -> Track<T> {
        if !self.is_evaluated::<T>() {
            return Track::default();
        }
        let values: Vec<T> = self.samples.iter().map(|(t, state)| value(t, state)).collect();
        self.kept(what, values, is_sound)
    }

    fn kept<T: Shown>(&mut self, what: &str, values: Vec<T>, is_sound: impl Fn(&T) -> bool) -> Track<T> {
        self.samples.track(values, is_sound).unwrap_or_else(|time| {
            self.fault.get_or_insert_with(|| Fault::NotDrawable { what: what.to_owned(), time });
            Track::whole(Vec::new())
        })
    }

    /// Remembers what is wrong from the start.
    fn require(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            let time = self.samples.start;
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
        let values: Vec<Pose> = if self.is_evaluated::<Pose>() {
            let mut pose = pose;
            self.samples.iter().map(|(t, state)| pose(t, state)).collect()
        } else {
            Vec::new()
        };
        self.add_body(name.into(), shapes.into_iter().collect(), values);
        self
    }

    /// A body with its poses at all samples.
    fn add_body(&mut self, name: String, shapes: Vec<Shape>, poses: Vec<Pose>) {
        // Of a turn of more than a few degrees no digits are lost.
        let cosines = poses.windows(2).map(|pair| pair[0].turn.dot(pair[1].turn).abs());
        let largest_turn = 2.0 * cosines.fold(1.0, f64::min).acos();
        let poses = self.kept(&name, poses, Pose::is_drawable);
        self.check_shapes(&name, &shapes);
        self.bodies.push(MovingBody { name, shapes, poses, largest_turn });
        fit::relieve(self);
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
        let Some((t, state)) = self.samples.first() else { return self };
        let first = system.bodies(t, state);
        let all = || self.samples.iter().map(|(t, state)| system.bodies(t, state));
        let size = extent(all().flat_map(|bodies| bodies.into_iter().filter_map(|body| body.center)));
        let placed = first.iter().any(|body| body.center.is_some());
        let shown = |body: &Body| body.center.is_some() || !placed && body.orientation.is_some();
        let shown: Vec<usize> = (0..B).filter(|&i| shown(&first[i])).collect();
        let at_once = (BODIES_AT_ONCE / size_of::<Pose>() / self.samples.len().max(1)).max(1);
        for group in shown.chunks(at_once) {
            let evaluated = self.is_evaluated::<Pose>();
            let mut poses =
                vec![Vec::with_capacity(if evaluated { self.samples.len() } else { 0 }); group.len()];
            for (t, state) in self.samples.iter().take_while(|_| evaluated) {
                let bodies = system.bodies(t, state);
                for (poses, &i) in poses.iter_mut().zip(group) {
                    poses.push(pose_of(&bodies[i]));
                }
            }
            for (poses, &i) in poses.into_iter().zip(group) {
                let shape = equivalent::drawing(&first[i], SMALL * size);
                self.add_body(first[i].name.to_owned(), vec![shape], poses);
            }
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
        fit::relieve(&mut self);
        self
    }

    /// A round bar between two moving points.
    pub fn rod(
        self,
        name: impl Into<String>,
        radius: f64,
        ends: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        self.link(name.into(), LinkKind::Rod, radius, ends)
    }

    /// An arrow from a moving point, such as a force at a contact: its foot, and the vector in lengths of the motion.
    pub fn arrow(
        self,
        name: impl Into<String>,
        radius: f64,
        mut foot_and_vector: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        self.link(name.into(), LinkKind::Arrow, radius, move |t, state| {
            let [foot, vector] = foot_and_vector(t, state);
            [foot, std::array::from_fn(|i| foot[i] + vector[i])]
        })
    }

    fn link(
        mut self,
        name: String,
        kind: LinkKind,
        radius: f64,
        ends: impl FnMut(f64, &[f64; N]) -> [[f64; 3]; 2],
    ) -> Self {
        let ends = self.sampled(&name, ends, |ends| is_drawable(ends.as_flattened()));
        self.require(is_drawable(&[radius]), || format!("the radius of {name}"));
        self.links.push(Link { name, kind, radius, ends });
        fit::relieve(&mut self);
        self
    }

    /// A panel for the curves that follow, with a heading such as `angles in rad`.
    pub fn panel(mut self, name: impl Into<String>) -> Self {
        self.panels.push(Panel { name: name.into(), is_folded: false, curves: Vec::new() });
        self
    }

    /// Folds the last panel at first: whoever wants to see its curves unfolds it on the page.
    ///
    /// ```
    /// use guen_study::{Recording, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[1.0]));
    /// let page = Viewer::new("Seldom", &recording).panel("seldom looked at").folded().curve("x", |_, x| x[0]);
    /// assert!(page.to_html()?.contains(r#""name":"seldom looked at","folded":1"#));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn folded(mut self) -> Self {
        if let Some(panel) = self.panels.last_mut() {
            panel.is_folded = true;
        }
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
        fit::relieve(&mut self);
        self
    }

    /// The page as text.
    ///
    /// # Errors
    ///
    /// [`NothingToDraw`](StudyError::NothingToDraw) for a recording without a sample, or without body, path, link or curve;
    /// [`Times`](StudyError::Times) if the times do not rise or fall throughout; [`NotDrawable`](StudyError::NotDrawable)
    /// with what it was and when, for a value that is not finite or beyond `1e18`, or an orientation that is none;
    /// [`UnknownBody`](StudyError::UnknownBody) for a name that no body has; [`TooLarge`](StudyError::TooLarge) if the page
    /// does not fit the size that was asked for.
    pub fn to_html(&self) -> Result<String, StudyError> {
        fit::fitting(self)
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

/// Colours, by the numbers that the page's program gives to what is in the scene: bodies first, then links, then paths.
impl<const N: usize> Viewer<'_, N> {
    fn body_ink(&self, i: usize, own: Option<u32>) -> String {
        own.map_or_else(|| plot::ink(i), |colour| format!("#{colour:06X}"))
    }

    fn link_ink(&self, i: usize) -> String {
        plot::ink(self.bodies.len() + i)
    }

    fn path_ink(&self, i: usize) -> String {
        let before = self.bodies.len() + self.links.len();
        // Where the hues have just begun again, the first path would have the first body's.
        plot::ink(before + i + usize::from(before > 0 && before.is_multiple_of(plot::INKS)))
    }
}

fn pose_of(body: &Body) -> Pose {
    let center = body.center.unwrap_or_default();
    match &body.orientation {
        Some(matrix) => Pose::oriented(center, matrix),
        None => Pose::at(center),
    }
}

/// The longest side of the box that points take up; one if there is none.
fn extent(points: impl Iterator<Item = [f64; 3]>) -> f64 {
    let (least, most) = track::bounds(points);
    let longest = shape::difference(most, least).into_iter().fold(0.0, f64::max);
    if longest > 0.0 && longest.is_finite() { longest } else { 1.0 }
}
