//! The things that a page shows, and faults of their description.

use super::shape::{Pose, Shape};
use super::track::Track;

#[derive(Clone, Debug)]
pub(super) struct MovingBody {
    pub(super) name: String,
    pub(super) shapes: Vec<Shape>,
    pub(super) poses: Track<Pose>,
    /// The largest turn between successive samples of the recording.
    pub(super) largest_turn: f64,
}

#[derive(Clone, Debug)]
pub(super) struct MovingPoint {
    pub(super) name: String,
    pub(super) points: Track<[f64; 3]>,
}

/// Something straight between two moving points.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) name: String,
    pub(super) kind: LinkKind,
    pub(super) radius: f64,
    /// The ends; of a force its foot and the vector.
    pub(super) ends: Track<[[f64; 3]; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LinkKind {
    Rod,
    Arrow,
    /// An arrow that the page scales.
    Force,
}

#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) name: String,
    pub(super) is_folded: bool,
    pub(super) curves: Vec<Curve>,
}

#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) values: Track<f64>,
}

/// A fault of the description; the page is refused with the first one.
#[derive(Clone, Debug)]
pub(super) enum Fault {
    NotDrawable {
        what: String,
        time: f64,
    },
    UnknownBody {
        name: String,
    },
    UnknownContact {
        name: String,
        known: Vec<&'static str>,
    },
    TooLarge {
        bytes: usize,
    },
    /// A further run without a sample or a thing.
    NothingToDraw {
        title: String,
    },
    /// A further run whose times do not rise.
    Times {
        title: String,
        time: f64,
    },
}
