//! Kinds of values, guessed from how a definition is written: good enough for signatures, where nothing better is known
//! because the declaration has faults.

use std::collections::BTreeMap;

use crate::names;
use crate::syntax::{ClauseWord, Contact, Declaration, Expression, ExpressionKind, FunctionDefinition, Item};

/// A kind of value.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Scalar,
    Rotation,
    /// A vector in the plane: its third component vanishes.
    Plane,
    Vector,
}

impl Kind {
    /// The kind of a sum or product of both: scalars change nothing, and a rotation turns a vector.
    pub(super) fn or(self, other: Kind) -> Kind {
        self.max(other)
    }
}

/// The kinds of the declared names; of a body the kind of its centre.
pub(super) struct Kinds {
    names: BTreeMap<String, Kind>,
    /// Functions, each with what could be called where it is declared.
    functions: BTreeMap<String, FunctionDefinition>,
}

impl Kinds {
    pub(super) fn new(declaration: &Declaration) -> Self {
        let mut kinds = Kinds { names: BTreeMap::new(), functions: BTreeMap::new() };
        for item in &declaration.items {
            match item {
                Item::Let(definition) => kinds.define(&definition.name.text, &definition.value),
                Item::Function(function) => {
                    // One that is called before it is declared could call itself.
                    let calls = |name: &String| kinds.functions.contains_key(name);
                    if called(&function.value).iter().all(calls) {
                        kinds.functions.insert(function.name.text.clone(), function.clone());
                    }
                }
                Item::Parameters(section) | Item::Outputs(section) => {
                    section.entries.iter().for_each(|entry| kinds.define(&entry.name.text, &entry.value));
                }
                Item::Contacts(section) => section.entries.iter().for_each(|contact| kinds.contact(contact)),
                Item::Bodies(section) => {
                    for body in &section.entries {
                        if let Some(center) = &body.center {
                            kinds.define(&body.name.text, &center.value);
                        }
                    }
                }
                _ => {}
            }
        }
        kinds
    }

    /// The slip and the reaction of a contact, under the calls that ask for them.
    fn contact(&mut self, contact: &Contact) {
        let along = contact.clause(ClauseWord::Grip).or(contact.clause(ClauseWord::Slip));
        let slip = along.map_or(Kind::Scalar, |clause| self.of(&clause.value));
        let slip = if slip == Kind::Plane { Kind::Vector } else { slip };
        let has_slip = contact.clause(ClauseWord::Slip).is_some();
        let reaction = if has_slip { Kind::Vector } else { slip };
        self.names.insert(format!("slip({})", contact.name), slip);
        self.names.insert(format!("reaction({})", contact.name), reaction);
    }

    fn define(&mut self, name: &str, value: &Expression) {
        self.names.insert(name.to_owned(), self.of(value));
    }

    /// The kind of an expression.
    pub(super) fn of(&self, e: &Expression) -> Kind {
        match &e.kind {
            ExpressionKind::Missing
            | ExpressionKind::Number(_)
            | ExpressionKind::Comparison { .. }
            | ExpressionKind::Power { .. }
            | ExpressionKind::Fold(_) => Kind::Scalar,
            ExpressionKind::Name(name) => self.names.get(&name.text).copied().unwrap_or(Kind::Scalar),
            ExpressionKind::Call { function, arguments, .. } => match function.text.as_str() {
                "select" => arguments.get(1).map_or(Kind::Scalar, |argument| self.of(argument)),
                "vec" if arguments.len() == 2 => Kind::Plane,
                "unit" => arguments.first().map_or(Kind::Vector, |argument| self.of(argument)),
                "vec" | "cross" | "angular_velocity" | "angular_velocity_body" => Kind::Vector,
                "rot" | "rot_x" | "rot_y" | "rot_z" | "quaternion" | "transpose" => Kind::Rotation,
                "dot" => arguments.first().map_or(Kind::Scalar, |argument| self.of(argument)),
                name @ ("reaction" | "slip") if !self.functions.contains_key(name) => {
                    let of_contact =
                        arguments.first().map(|argument| format!("{name}({})", argument.source()));
                    of_contact.and_then(|key| self.names.get(&key).copied()).unwrap_or(Kind::Scalar)
                }
                name => self.functions.get(name).map_or(Kind::Scalar, |function| {
                    let mut inside = Kinds { names: self.names.clone(), functions: self.functions.clone() };
                    for (parameter, argument) in function.parameters.iter().zip(arguments) {
                        inside.names.insert(parameter.text.clone(), self.of(argument));
                    }
                    inside.of(&function.value)
                }),
            },
            ExpressionKind::Field { base, name } => match name.text.as_str() {
                "center" => self.of(base),
                "angular_velocity" => Kind::Vector,
                "orientation" => Kind::Rotation,
                // The axes of a rotation are vectors, the components of a vector scalars.
                _ if self.of(base) == Kind::Rotation => Kind::Vector,
                _ => Kind::Scalar,
            },
            ExpressionKind::Method { base, name, .. } if name.text == "velocity_at" => self.of(base),
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

/// The names of functions that the language does not have, of all calls in an expression.
fn called(e: &Expression) -> Vec<String> {
    let mut found: Vec<String> = e.children().into_iter().flat_map(called).collect();
    if let ExpressionKind::Call { function, .. } = &e.kind
        && !names::is_function(&function.text)
    {
        found.push(function.text.clone());
    }
    found
}
