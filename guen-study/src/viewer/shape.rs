//! Shapes of bodies, and their places.

use super::drawable::is_drawable;
use super::turn::{Turn, norm};

/// The place of a body at one moment and its orientation in the world's axes.
///
/// Turns follow each other from left to right as in a product of rotations, each about the axes that those before have
/// turned: `rot_z(psi)*rot_x(theta)` is `.turned([0, 0, 1], psi).turned([1, 0, 0], theta)`.
///
/// ```
/// use guen_study::Pose;
///
/// let (psi, theta) = (0.3, 1.2);
/// let pose = Pose::at([1.0, 2.0, 0.5]).turned([0.0, 0.0, 1.0], psi).turned([1.0, 0.0, 0.0], theta);
/// assert_ne!(pose, Pose::at([1.0, 2.0, 0.5]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub(super) place: [f64; 3],
    pub(super) turn: Turn,
}

impl Pose {
    /// Creates a pose at a place, with the body's axes along the world's.
    pub fn at(place: [f64; 3]) -> Self {
        Self { place, turn: Turn::NONE }
    }

    /// Creates a pose at a place, with the rotation matrix from body axes to the world's, row by row. A positive factor before the
    /// matrix is divided out.
    ///
    /// ```
    /// use guen_study::Pose;
    ///
    /// let quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    /// let pose = Pose::oriented([0.0; 3], &quarter);
    /// assert_eq!(pose, Pose::oriented([0.0; 3], &quarter.map(|row| row.map(|e| 8.0 * e))));
    /// ```
    pub fn oriented(place: [f64; 3], matrix: &[[f64; 3]; 3]) -> Self {
        Self { place, turn: Turn::from_matrix(matrix) }
    }

    /// Turns the shape by an angle about an axis in its own axes.
    pub fn turned(self, axis: [f64; 3], angle: f64) -> Self {
        Self { turn: self.turn.times(Turn::about(axis, angle)), ..self }
    }

    pub(super) fn is_drawable(&self) -> bool {
        is_drawable(&self.place) && self.turn.is_finite()
    }
}

/// A solid that a body is drawn as, or a part of it, in body axes. Lengths are those of the motion.
///
/// Solids of revolution stand about the body's `z`; [`about`](Shape::about) chooses another axis. They carry marks, so that
/// one sees them turn.
///
/// ```
/// use guen_study::Shape;
///
/// // A wheel about the body's y, and a chassis above its centre.
/// let wheel = Shape::disc(0.1, 0.04).about([0.0, 1.0, 0.0]);
/// let chassis = Shape::cuboid([0.2, 0.4, 0.6]).at([0.0, 0.0, 0.3]).coloured(0x0072b2);
/// # let _ = (wheel, chassis);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub(super) kind: Kind,
    pub(super) place: [f64; 3],
    pub(super) turn: Turn,
    /// Red, green and blue, one byte each.
    pub(super) colour: Option<u32>,
}

/// The solids that the page can draw, with their lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Radius of the middle line, thickness of the tube.
    Ring([f64; 2]),
    /// Radius and length.
    Cylinder([f64; 2]),
    /// Radius.
    Sphere([f64; 1]),
    /// Three edges.
    Cuboid([f64; 3]),
    /// Length, and radius of the shaft.
    Arrow([f64; 2]),
}

impl Kind {
    /// Returns the page's name for the shape, and its lengths.
    pub(super) fn parts(&self) -> (&'static str, &[f64]) {
        match self {
            Self::Ring(lengths) => ("ring", lengths),
            Self::Cylinder(lengths) => ("cylinder", lengths),
            Self::Sphere(lengths) => ("sphere", lengths),
            Self::Cuboid(lengths) => ("cuboid", lengths),
            Self::Arrow(lengths) => ("arrow", lengths),
        }
    }
}

impl Shape {
    fn of(kind: Kind) -> Self {
        Self { kind, place: [0.0; 3], turn: Turn::NONE, colour: None }
    }

    /// A hoop: radius of its middle line, and thickness of the tube.
    pub fn ring(radius: f64, thickness: f64) -> Self {
        Self::of(Kind::Ring([radius, thickness]))
    }

    /// A disc or wheel with a hub: radius and thickness.
    pub fn disc(radius: f64, thickness: f64) -> Self {
        Self::of(Kind::Cylinder([radius, thickness]))
    }

    /// A cylinder: radius and length.
    pub fn cylinder(radius: f64, length: f64) -> Self {
        Self::of(Kind::Cylinder([radius, length]))
    }

    /// A ball.
    pub fn sphere(radius: f64) -> Self {
        Self::of(Kind::Sphere([radius]))
    }

    /// A box with edges along the body's axes.
    pub fn cuboid(edges: [f64; 3]) -> Self {
        Self::of(Kind::Cuboid(edges))
    }

    /// A round bar between two points of the body.
    pub fn rod(from: [f64; 3], to: [f64; 3], radius: f64) -> Self {
        let (middle, along) = (mean(from, to), difference(to, from));
        Self { place: middle, turn: Turn::from_z(along), ..Self::cylinder(radius, norm(along)) }
    }

    /// An arrow between two points of the body.
    pub fn arrow(from: [f64; 3], to: [f64; 3], radius: f64) -> Self {
        let along = difference(to, from);
        Self { place: from, turn: Turn::from_z(along), ..Self::of(Kind::Arrow([norm(along), radius])) }
    }

    /// Moves the shape's centre to a point of the body; an arrow's foot.
    pub fn at(self, place: [f64; 3]) -> Self {
        Self { place, ..self }
    }

    /// Turns the shape's own `z` along a direction of the body.
    pub fn about(self, axis: [f64; 3]) -> Self {
        Self { turn: Turn::from_z(axis), ..self }
    }

    /// Turns the shape by an angle about a direction of the body, where it is.
    pub fn turned(self, axis: [f64; 3], angle: f64) -> Self {
        Self { turn: Turn::about(axis, angle).times(self.turn), ..self }
    }

    /// Colours the shape `0xRRGGBB`; otherwise bodies take colours in turn.
    pub fn coloured(self, colour: u32) -> Self {
        Self { colour: Some(colour & 0xff_ffff), ..self }
    }

    /// The distance from the body's place within which the shape is.
    pub(super) fn reach(&self) -> f64 {
        let own = match self.kind {
            Kind::Ring([radius, thickness]) => radius + thickness,
            Kind::Cylinder([radius, length]) => radius.hypot(length / 2.0),
            Kind::Sphere([radius]) => radius,
            Kind::Cuboid(edges) => norm(edges) / 2.0,
            Kind::Arrow([length, _]) => length,
        };
        own + norm(self.place)
    }

    pub(super) fn is_drawable(&self) -> bool {
        let (_, lengths) = self.kind.parts();
        is_drawable(lengths)
            && lengths.iter().all(|e| *e >= 0.0)
            && is_drawable(&self.place)
            && self.turn.is_finite()
    }
}

pub(super) fn mean(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (a[i] + b[i]) / 2.0)
}

pub(super) fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}
