//! The kinds of value: scalars, vectors in space, rotations, and the names of bodies.

use guen_symbolic::{ExprId, FrameId};

use super::contact::ContactKind;

/// A vector in space, by its components in the world's axes.
pub(super) type Vector = [ExprId; 3];

/// A rotation from body axes to the world's.
#[derive(Clone)]
pub(super) struct Rotation {
    /// The matrix, row by row.
    pub(super) matrix: [Vector; 3],
    /// The angular velocity in the world's axes, linear in the velocities.
    pub(super) world_rate: Vector,
    /// The angular velocity in the body's axes.
    pub(super) body_rate: Vector,
    /// The frame that it leads to from the world.
    pub(super) frame: FrameId,
    /// The turns about fixed axes that the rotation is made of, if it is.
    pub(super) turns: Option<Vec<Turn>>,
}

/// A turn by an angle about a fixed unit axis.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    /// The axis.
    pub(super) axis: Vector,
    /// The angle.
    pub(super) angle: ExprId,
}

/// A rigid body as a value.
#[derive(Clone)]
pub(super) struct BodyValue {
    /// The name.
    pub(super) name: String,
    /// Position and velocity of the mass centre, if it has one.
    pub(super) center: Option<(Vector, Vector)>,
    /// The orientation, if it has one.
    pub(super) orientation: Option<Rotation>,
    /// The mass, if it has one.
    pub(super) mass: Option<ExprId>,
    /// The matrix entries `xx, yy, zz, xy, yz, zx` of its inertia, if it has one.
    pub(super) inertia: Option<[ExprId; 6]>,
}

/// A value of the language.
#[derive(Clone)]
pub(super) enum Value {
    /// A scalar.
    Scalar(ExprId),
    /// A vector.
    Vector(Vector),
    /// A rotation.
    Rotation(Box<Rotation>),
    /// A body.
    Body(Box<BodyValue>),
}

impl Value {
    /// The kind with its article, for messages.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Value::Scalar(_) => "a scalar",
            Value::Vector(_) => "a vector",
            Value::Rotation(_) => "a rotation",
            Value::Body(_) => "a body",
        }
    }

    /// Every expression that makes up the value.
    pub(super) fn expressions(&self) -> Vec<ExprId> {
        match self {
            Value::Scalar(e) => vec![*e],
            Value::Vector(v) => v.to_vec(),
            Value::Rotation(r) => r.matrix.iter().flatten().copied().collect(),
            Value::Body(body) => {
                let center = body.center.iter().flat_map(|(p, _)| p.iter().copied());
                let matrix = body.orientation.iter().flat_map(|r| r.matrix.iter().flatten().copied());
                center.chain(matrix).collect()
            }
        }
    }
}

/// A contact as outputs see it.
#[derive(Clone)]
pub(super) struct ContactValue {
    /// The gap, or the function of a latch; none for a grip.
    pub(super) gap: Option<ExprId>,
    /// The velocity along it; none without friction.
    pub(super) slip: Option<Value>,
    /// The force: a scalar of a smooth contact, a latch or a grip along a line; else the components along the gap and the slip.
    pub(super) reaction: Value,
    /// The forms of its rows, where they are constraints; the reaction has them in the place of the forces.
    pub(super) is_held: bool,
    /// The kind of the contact.
    pub(super) kind: ContactKind,
}
