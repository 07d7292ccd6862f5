//! What a name stands for, guessed from how its definition is written: good enough for signatures, where nothing
//! better is known because the declaration has faults.

use std::collections::BTreeMap;

use crate::syntax::{Definition, Expression, ExpressionKind, Name};

/// A kind of value.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Scalar,
    Rotation,
    Vector,
}

impl Kind {
    /// The kind of a sum or product of both: scalars change nothing, and a rotation turns a vector.
    pub(super) fn or(self, other: Kind) -> Kind {
        self.max(other)
    }
}

/// The kinds of the names so far.
#[derive(Default)]
pub(super) struct Kinds {
    names: BTreeMap<String, Kind>,
}

impl Kinds {
    /// Notes a definition, and tells its kind.
    pub(super) fn define(&mut self, definition: &Definition) -> Kind {
        let kind = self.of(&definition.value);
        self.names.insert(definition.name.text.clone(), kind);
        kind
    }

    /// Notes a body: what is of interest are its fields.
    pub(super) fn body(&mut self, name: &Name) {
        self.names.insert(name.text.clone(), Kind::Scalar);
    }

    /// The kind of an expression.
    pub(super) fn of(&self, e: &Expression) -> Kind {
        match &e.kind {
            ExpressionKind::Missing | ExpressionKind::Number(_) | ExpressionKind::Power { .. } => {
                Kind::Scalar
            }
            ExpressionKind::Name(name) => self.names.get(&name.text).copied().unwrap_or(Kind::Scalar),
            ExpressionKind::Call { function, arguments, .. } => match function.text.as_str() {
                "vec" | "cross" | "unit" | "angular_velocity" | "angular_velocity_body" => Kind::Vector,
                "rot" | "rot_x" | "rot_y" | "rot_z" | "quaternion" | "transpose" => Kind::Rotation,
                "dot" => arguments.first().map_or(Kind::Scalar, |argument| self.of(argument)),
                _ => Kind::Scalar,
            },
            ExpressionKind::Field { base, name } => match name.text.as_str() {
                "center" | "angular_velocity" => Kind::Vector,
                "orientation" => Kind::Rotation,
                // The axes of a rotation are vectors, the components of a vector scalars.
                _ if self.of(base) == Kind::Rotation => Kind::Vector,
                _ => Kind::Scalar,
            },
            ExpressionKind::Method { name, .. } if name.text == "velocity_at" => Kind::Vector,
            ExpressionKind::Method { .. } => Kind::Scalar,
            ExpressionKind::Negation(operand) => self.of(operand),
            ExpressionKind::Sum { first, rest } => {
                rest.iter().fold(self.of(first), |kind, term| kind.or(self.of(&term.value)))
            }
            ExpressionKind::Product { first, rest } => {
                rest.iter().fold(self.of(first), |kind, factor| kind.or(self.of(&factor.value)))
            }
        }
    }
}
