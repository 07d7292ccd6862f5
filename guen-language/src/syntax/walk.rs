//! The names and expressions of an item, whatever its kind.

use super::{Body, EntryNode, Expression, ExpressionKind, Inertia, Item, ModeStatement, Name, Reset};

impl Item {
    /// The loops and choices around the entries of the item.
    pub fn nesting(&self) -> &[EntryNode] {
        match self {
            Item::Constants(section) => &section.nesting,
            Item::Functions(section) => &section.nesting,
            Item::Inputs(section) | Item::Coordinates(section) => &section.nesting,
            Item::Parameters(section) | Item::Outputs(section) => &section.nesting,
            Item::Constraints(section) | Item::Holonomic(section) => &section.nesting,
            Item::Particles(section) => &section.nesting,
            Item::States(section) => &section.nesting,
            Item::Bodies(section) => &section.nesting,
            Item::Forces(section) => &section.nesting,
            Item::Switches(section) => &section.nesting,
            Item::Contacts(section) => &section.nesting,
            Item::Resets(section) => &section.nesting,
            Item::Modes(section) => &section.nesting,
            Item::Scene(scene) => &scene.nesting,
            _ => &[],
        }
    }
}

/// Methods that look at the parts of items and expressions, or, with the word `mut`, that hand them out to be changed.
macro_rules! walk {
    ($declared:ident $expressions:ident $contacts:ident $children:ident $iter:ident $($mut:ident)?) => {
        impl Item {
            /// The names that the item declares, in order.
            pub fn $declared(&$($mut)? self) -> Vec<&$($mut)? Name> {
                macro_rules! names {
                    ($section:ident) => {
                        $section.entries.$iter().map(|entry| &$($mut)? entry.name).collect()
                    };
                }
                match self {
                    Item::Count(count) => vec![&$($mut)? count.name],
                    Item::Constants(section) => names!(section),
                    Item::Functions(section) => names!(section),
                    Item::Inputs(section) | Item::Coordinates(section) => names!(section),
                    Item::Let(definition) => vec![&$($mut)? definition.name],
                    Item::Function(function) => vec![&$($mut)? function.name],
                    Item::Parameters(section) | Item::Outputs(section) => names!(section),
                    Item::Constraints(section) | Item::Holonomic(section) => names!(section),
                    Item::States(section) => names!(section),
                    Item::Bodies(section) => names!(section),
                    Item::Switches(section) => names!(section),
                    Item::Contacts(section) => names!(section),
                    Item::Resets(section) => names!(section),
                    Item::Component(component) => vec![&$($mut)? component.name],
                    Item::Use(instance) => vec![&$($mut)? instance.name],
                    Item::Argument(argument) => vec![&$($mut)? argument.name],
                    Item::KineticEnergy(_)
                    | Item::Particles(_)
                    | Item::Gravity(_)
                    | Item::ForceFunction(_)
                    | Item::PotentialEnergy(_)
                    | Item::Forces(_)
                    | Item::Modes(_)
                    | Item::Provide(_)
                    | Item::Scene(_) => Vec::new(),
                }
            }

            /// The expressions of the item, in order; without those of scenes and of components.
            pub fn $expressions(&$($mut)? self) -> Vec<&$($mut)? Expression> {
                macro_rules! parts {
                    ($section:ident: $field:ident) => {
                        $section.entries.$iter().map(|entry| &$($mut)? entry.$field).collect()
                    };
                    ($section:ident: $first:ident $second:ident) => {
                        $section
                            .entries
                            .$iter()
                            .flat_map(|entry| [&$($mut)? entry.$first, &$($mut)? entry.$second])
                            .collect()
                    };
                }
                match self {
                    Item::Constants(section) => {
                        let parts = section.entries.$iter().flat_map(|entry| {
                            let limits = entry.limits.$iter().flat_map(|limits| limits.$iter());
                            entry.default.$iter().chain(limits)
                        });
                        parts.collect()
                    }
                    Item::Inputs(section) | Item::Coordinates(section) => {
                        let limits = section.entries.$iter().flat_map(|entry| entry.limits.$iter());
                        limits.flat_map(|limits| limits.$iter()).collect()
                    }
                    Item::Let(definition) => vec![&$($mut)? definition.value],
                    Item::Function(function) => vec![&$($mut)? function.value],
                    Item::Parameters(section) | Item::Outputs(section) => parts!(section: value),
                    Item::Constraints(section) | Item::Holonomic(section) => parts!(section: left right),
                    Item::Particles(section) => parts!(section: mass position),
                    Item::Bodies(section) => section.entries.$iter().flat_map(Body::$expressions).collect(),
                    Item::KineticEnergy(quantity)
                    | Item::Gravity(quantity)
                    | Item::ForceFunction(quantity)
                    | Item::PotentialEnergy(quantity) => vec![&$($mut)? quantity.value],
                    Item::States(section) => parts!(section: rate),
                    Item::Forces(section) => parts!(section: force direction),
                    Item::Use(instance) => {
                        instance.arguments.$iter().map(|argument| &$($mut)? argument.value).collect()
                    }
                    Item::Switches(section) => parts!(section: value),
                    Item::Contacts(section) => {
                        let clauses = section.entries.$iter().flat_map(|entry| entry.clauses.$iter());
                        clauses.map(|clause| &$($mut)? clause.value).collect()
                    }
                    Item::Resets(section) => section.entries.$iter().flat_map(Reset::$expressions).collect(),
                    Item::Argument(argument) => vec![&$($mut)? argument.given.value],
                    Item::Count(_)
                    | Item::Functions(_)
                    | Item::Component(_)
                    | Item::Modes(_)
                    | Item::Provide(_)
                    | Item::Scene(_) => Vec::new(),
                }
            }
        }

        impl ModeStatement {
            /// The contacts that the statement speaks of.
            pub fn $contacts(&$($mut)? self) -> Vec<&$($mut)? Name> {
                match self {
                    ModeStatement::States { contact, .. } => vec![contact],
                    ModeStatement::Never { combination, .. } => {
                        combination.$iter().map(|(contact, _)| contact).collect()
                    }
                }
            }
        }

        impl Body {
            /// The expressions of its fields, in order.
            pub fn $expressions(&$($mut)? self) -> Vec<&$($mut)? Expression> {
                let fields = [&$($mut)? self.mass, &$($mut)? self.center, &$($mut)? self.orientation];
                let inertia = self.inertia.$iter().flat_map(|field| match &$($mut)? field.value {
                    Inertia::Diagonal(entries) => entries.$iter(),
                    Inertia::Symmetric(entries) => entries.$iter(),
                    Inertia::Missing => [].$iter(),
                });
                fields.into_iter().flatten().map(|field| &$($mut)? field.value).chain(inertia).collect()
            }
        }

        impl Reset {
            /// The expressions, in order: the function, then each variable with its new value.
            pub fn $expressions(&$($mut)? self) -> Vec<&$($mut)? Expression> {
                let assignments =
                    self.assignments.$iter().flat_map(|given| [&$($mut)? given.variable, &$($mut)? given.value]);
                std::iter::once(&$($mut)? self.function).chain(assignments).collect()
            }
        }

        impl Expression {
            /// The expressions directly inside, from left to right.
            pub fn $children(&$($mut)? self) -> Vec<&$($mut)? Expression> {
                match &$($mut)? self.kind {
                    ExpressionKind::Missing | ExpressionKind::Number(_) | ExpressionKind::Name(_) => Vec::new(),
                    ExpressionKind::Call { arguments, .. } => arguments.$iter().collect(),
                    ExpressionKind::Field { base, .. } => vec![base],
                    ExpressionKind::Method { base, arguments, .. } => {
                        std::iter::once(&$($mut)? **base).chain(arguments).collect()
                    }
                    ExpressionKind::Negation(operand) => vec![operand],
                    ExpressionKind::Sum { first, rest } => {
                        let rest = rest.$iter().map(|t| &$($mut)? t.value);
                        std::iter::once(&$($mut)? **first).chain(rest).collect()
                    }
                    ExpressionKind::Product { first, rest } => {
                        let rest = rest.$iter().map(|f| &$($mut)? f.value);
                        std::iter::once(&$($mut)? **first).chain(rest).collect()
                    }
                    ExpressionKind::Comparison { left, right, .. } => vec![left, right],
                    ExpressionKind::Power { base, exponent } => vec![base, exponent],
                    ExpressionKind::Fold(fold) => vec![&$($mut)? fold.body],
                }
            }
        }
    };
}

walk!(declared expressions contacts children iter);
walk!(declared_mut expressions_mut contacts_mut children_mut iter_mut mut);

impl Expression {
    /// Calls one function with every name of a value in the expression, and another one with every name of a function.
    pub fn names_mut(&mut self, value: &mut dyn FnMut(&mut Name), function: &mut dyn FnMut(&mut Name)) {
        match &mut self.kind {
            ExpressionKind::Name(name) => value(name),
            ExpressionKind::Call { function: name, .. } => function(name),
            _ => {}
        }
        self.children_mut().into_iter().for_each(|child| child.names_mut(value, function));
    }
}
