//! The ground of a page, and how the motion is looked at.

use super::drawable::{is_direction, is_drawable};
use super::{Viewer, page};

/// The ground that the bodies move on.
#[derive(Clone, Debug)]
pub(super) enum Ground {
    Plane { point: [f64; 3], normal: [f64; 3] },
    Surface { x: [f64; 2], y: [f64; 2], heights: Vec<f64> },
}

#[derive(Clone, Debug, Default)]
pub(super) struct View {
    pub(super) up: Option<[f64; 3]>,
    pub(super) from: Option<[f64; 3]>,
    pub(super) follow: Option<String>,
    pub(super) bare: bool,
    pub(super) time_unit: Option<String>,
    pub(super) per_force: Option<f64>,
}

impl<const N: usize> Viewer<'_, N> {
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

    /// Sets the unit of time that the page writes, `s` unless told. Short times in seconds are written in `ms`, `µs` and so on.
    pub fn time_unit(mut self, unit: impl Into<String>) -> Self {
        self.view.time_unit = Some(unit.into());
        self
    }

    /// Sets the length of the arrow of a force of one. Unless told, the longest arrow is a quarter of the space that the motion takes up.
    ///
    /// ```
    /// use guen_study::{Pose, Recording, Shape, Viewer};
    ///
    /// let mut recording = Recording::new(&["x"]);
    /// (0..100).for_each(|k| recording.record(f64::from(k), &[f64::from(k)]));
    /// // A weight of 20 N on a long way: an arrow of half a metre.
    /// let page = Viewer::new("A weight", &recording)
    ///     .force("weight", |_, x| [[x[0], 0.0, 0.5], [0.0, 0.0, -20.0]])
    ///     .force_length(0.025);
    /// assert!(page.to_html()?.contains("have the length 0.025 for a force of 1"));
    /// # Ok::<(), guen_study::StudyError>(())
    /// ```
    pub fn force_length(mut self, length: f64) -> Self {
        self.view.per_force = Some(length);
        self.require(is_drawable(&[length]) && length > 0.0, || "the length of forces".to_owned());
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
}
