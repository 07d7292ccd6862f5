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

    /// The names that the item declares, in order.
    pub fn declared(&self) -> Vec<&Name> {
        match self {
            Item::Count(count) => vec![&count.name],
            Item::Constants(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Functions(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Inputs(section) | Item::Coordinates(section) => {
                section.entries.iter().map(|entry| &entry.name).collect()
            }
            Item::Let(definition) => vec![&definition.name],
            Item::Function(function) => vec![&function.name],
            Item::Parameters(section) | Item::Outputs(section) => {
                section.entries.iter().map(|entry| &entry.name).collect()
            }
            Item::Constraints(section) | Item::Holonomic(section) => {
                section.entries.iter().map(|entry| &entry.name).collect()
            }
            Item::States(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Bodies(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Switches(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Contacts(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Resets(section) => section.entries.iter().map(|entry| &entry.name).collect(),
            Item::Component(component) => vec![&component.name],
            Item::Use(instance) => vec![&instance.name],
            Item::Argument(argument) => vec![&argument.name],
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
    pub fn expressions(&self) -> Vec<&Expression> {
        match self {
            Item::Constants(section) => {
                let limits = section.entries.iter().filter_map(|entry| entry.limits.as_deref()).flatten();
                section.entries.iter().filter_map(|entry| entry.default.as_ref()).chain(limits).collect()
            }
            Item::Inputs(section) | Item::Coordinates(section) => section
                .entries
                .iter()
                .flat_map(|entry| entry.limits.iter().flat_map(|limits| limits.iter()))
                .collect(),
            Item::Let(definition) => vec![&definition.value],
            Item::Function(function) => vec![&function.value],
            Item::Parameters(section) | Item::Outputs(section) => {
                section.entries.iter().map(|entry| &entry.value).collect()
            }
            Item::Constraints(section) | Item::Holonomic(section) => {
                section.entries.iter().flat_map(|entry| [&entry.left, &entry.right]).collect()
            }
            Item::Particles(section) => {
                section.entries.iter().flat_map(|entry| [&entry.mass, &entry.position]).collect()
            }
            Item::Bodies(section) => section.entries.iter().flat_map(Body::expressions).collect(),
            Item::KineticEnergy(quantity)
            | Item::Gravity(quantity)
            | Item::ForceFunction(quantity)
            | Item::PotentialEnergy(quantity) => vec![&quantity.value],
            Item::States(section) => section.entries.iter().map(|entry| &entry.rate).collect(),
            Item::Forces(section) => {
                section.entries.iter().flat_map(|entry| [&entry.force, &entry.direction]).collect()
            }
            Item::Use(instance) => instance.arguments.iter().map(|argument| &argument.value).collect(),
            Item::Switches(section) => section.entries.iter().map(|entry| &entry.value).collect(),
            Item::Contacts(section) => {
                let clauses = section.entries.iter().flat_map(|entry| &entry.clauses);
                clauses.map(|clause| &clause.value).collect()
            }
            Item::Resets(section) => section.entries.iter().flat_map(Reset::expressions).collect(),
            Item::Argument(argument) => vec![&argument.given.value],
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
    pub fn contacts(&self) -> Vec<&Name> {
        match self {
            ModeStatement::States { contact, .. } => vec![contact],
            ModeStatement::Never { combination, .. } => {
                combination.iter().map(|(contact, _)| contact).collect()
            }
        }
    }

    /// The contacts that the statement speaks of, to be changed.
    pub fn contacts_mut(&mut self) -> Vec<&mut Name> {
        match self {
            ModeStatement::States { contact, .. } => vec![contact],
            ModeStatement::Never { combination, .. } => {
                combination.iter_mut().map(|(contact, _)| contact).collect()
            }
        }
    }
}

impl Item {
    /// The names that the item declares, in order, to be changed.
    pub fn declared_mut(&mut self) -> Vec<&mut Name> {
        match self {
            Item::Count(count) => vec![&mut count.name],
            Item::Constants(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Functions(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Inputs(section) | Item::Coordinates(section) => {
                section.entries.iter_mut().map(|entry| &mut entry.name).collect()
            }
            Item::Let(definition) => vec![&mut definition.name],
            Item::Function(function) => vec![&mut function.name],
            Item::Parameters(section) | Item::Outputs(section) => {
                section.entries.iter_mut().map(|entry| &mut entry.name).collect()
            }
            Item::Constraints(section) | Item::Holonomic(section) => {
                section.entries.iter_mut().map(|entry| &mut entry.name).collect()
            }
            Item::States(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Bodies(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Switches(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Contacts(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Resets(section) => section.entries.iter_mut().map(|entry| &mut entry.name).collect(),
            Item::Component(component) => vec![&mut component.name],
            Item::Use(instance) => vec![&mut instance.name],
            Item::Argument(argument) => vec![&mut argument.name],
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

    /// The expressions of the item, in order, to be changed; without those of scenes and of components.
    pub fn expressions_mut(&mut self) -> Vec<&mut Expression> {
        match self {
            Item::Constants(section) => {
                let parts = section.entries.iter_mut().map(|entry| (&mut entry.default, &mut entry.limits));
                parts
                    .flat_map(|(default, limits)| {
                        default.iter_mut().chain(limits.iter_mut().flat_map(|l| &mut **l))
                    })
                    .collect()
            }
            Item::Inputs(section) | Item::Coordinates(section) => section
                .entries
                .iter_mut()
                .flat_map(|entry| entry.limits.iter_mut().flat_map(|limits| limits.iter_mut()))
                .collect(),
            Item::Let(definition) => vec![&mut definition.value],
            Item::Function(function) => vec![&mut function.value],
            Item::Parameters(section) | Item::Outputs(section) => {
                section.entries.iter_mut().map(|entry| &mut entry.value).collect()
            }
            Item::Constraints(section) | Item::Holonomic(section) => {
                section.entries.iter_mut().flat_map(|entry| [&mut entry.left, &mut entry.right]).collect()
            }
            Item::Particles(section) => {
                section.entries.iter_mut().flat_map(|entry| [&mut entry.mass, &mut entry.position]).collect()
            }
            Item::Bodies(section) => section.entries.iter_mut().flat_map(Body::expressions_mut).collect(),
            Item::KineticEnergy(quantity)
            | Item::Gravity(quantity)
            | Item::ForceFunction(quantity)
            | Item::PotentialEnergy(quantity) => vec![&mut quantity.value],
            Item::States(section) => section.entries.iter_mut().map(|entry| &mut entry.rate).collect(),
            Item::Forces(section) => section
                .entries
                .iter_mut()
                .flat_map(|entry| [&mut entry.force, &mut entry.direction])
                .collect(),
            Item::Use(instance) => {
                instance.arguments.iter_mut().map(|argument| &mut argument.value).collect()
            }
            Item::Switches(section) => section.entries.iter_mut().map(|entry| &mut entry.value).collect(),
            Item::Contacts(section) => {
                let clauses = section.entries.iter_mut().flat_map(|entry| &mut entry.clauses);
                clauses.map(|clause| &mut clause.value).collect()
            }
            Item::Resets(section) => section.entries.iter_mut().flat_map(Reset::expressions_mut).collect(),
            Item::Argument(argument) => vec![&mut argument.given.value],
            Item::Count(_)
            | Item::Functions(_)
            | Item::Component(_)
            | Item::Modes(_)
            | Item::Provide(_)
            | Item::Scene(_) => Vec::new(),
        }
    }
}

impl Body {
    /// The expressions of its fields, in order.
    pub fn expressions(&self) -> Vec<&Expression> {
        let inertia: &[Expression] = match self.inertia.as_ref().map(|field| &field.value) {
            Some(Inertia::Diagonal(entries)) => &entries[..],
            Some(Inertia::Symmetric(entries)) => &entries[..],
            Some(Inertia::Missing) | None => &[],
        };
        let fields = [&self.mass, &self.center, &self.orientation];
        fields.into_iter().flatten().map(|field| &field.value).chain(inertia).collect()
    }
}
impl Body {
    /// The expressions of its fields, in order, to be changed.
    pub fn expressions_mut(&mut self) -> Vec<&mut Expression> {
        let inertia: &mut [Expression] = match self.inertia.as_mut().map(|field| &mut field.value) {
            Some(Inertia::Diagonal(entries)) => &mut entries[..],
            Some(Inertia::Symmetric(entries)) => &mut entries[..],
            Some(Inertia::Missing) | None => &mut [],
        };
        let fields = [&mut self.mass, &mut self.center, &mut self.orientation];
        fields.into_iter().flatten().map(|field| &mut field.value).chain(inertia).collect()
    }
}

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

    /// The operands and arguments, to be changed.
    pub fn children_mut(&mut self) -> Vec<&mut Expression> {
        match &mut self.kind {
            ExpressionKind::Missing | ExpressionKind::Number(_) | ExpressionKind::Name(_) => Vec::new(),
            ExpressionKind::Call { arguments, .. } => arguments.iter_mut().collect(),
            ExpressionKind::Field { base, .. } => vec![base],
            ExpressionKind::Method { base, arguments, .. } => {
                std::iter::once(&mut **base).chain(arguments).collect()
            }
            ExpressionKind::Negation(operand) => vec![operand],
            ExpressionKind::Sum { first, rest } => {
                std::iter::once(&mut **first).chain(rest.iter_mut().map(|t| &mut t.value)).collect()
            }
            ExpressionKind::Product { first, rest } => {
                std::iter::once(&mut **first).chain(rest.iter_mut().map(|f| &mut f.value)).collect()
            }
            ExpressionKind::Power { base, exponent } => vec![base, exponent],
            ExpressionKind::Comparison { left, right, .. } => vec![left, right],
            ExpressionKind::Fold(fold) => vec![&mut fold.body],
        }
    }
}
